//! The light of the surroundings as functions of the graph.

use sdfc_graph::Unary;
use sdfc_graph::{Binary, Const, Dim, Environment, Graph, NodeId, Table, TableId, Ternary, Type};

use super::octahedron::Octahedron;
use super::prefilter::{LEVELS, SMOOTHEST};
use super::{Coefficients, Surroundings};

/// Makes the functions of surroundings that are turned about the y axis by an angle, and whose
/// light has a factor. Both are nodes of stage `Const` or `Frame`.
pub fn functions(
    graph: &mut Graph,
    surroundings: &Surroundings,
    turn: NodeId,
    strength: NodeId,
) -> Environment {
    let turned = turned(graph, turn);
    let light = radiance(graph, &surroundings.levels, turned);
    let radiance = graph.mul(light, strength);
    let light = irradiance(graph, &surroundings.irradiance, turned);
    Environment { radiance, irradiance: graph.mul(light, strength) }
}

/// The point of level 0, a direction, in the coordinates of the picture: turned back.
fn turned(graph: &mut Graph, turn: NodeId) -> NodeId {
    let direction = graph.point(0, Dim::Three);
    let [sine, cosine] = [Unary::Sin, Unary::Cos].map(|op| graph.unary(op, turn));
    let [x, y, z] = [0, 1, 2].map(|lane| graph.component(direction, lane));
    let products = [(x, cosine), (z, sine), (x, sine), (z, cosine)];
    let [xc, zs, xs, zc] = products.map(|(a, b)| graph.mul(a, b));
    let (x, z) = (graph.sub(xc, zs), graph.add(xs, zc));
    graph.compose(&[x, y, z])
}

/// What a mirror receives from a direction, by its roughness, the point of level 1.
fn radiance(graph: &mut Graph, levels: &[Octahedron], direction: NodeId) -> NodeId {
    let texels = levels.iter().flat_map(|level| &level.texels);
    let element = |texel: &[f32; 3]| Const::new(Type::Vec3, &texel.map(f64::from));
    let texels = Table { ty: Type::Vec3, elements: texels.map(element).collect() };
    let texels = graph.add_table(texels);
    let (mut first, mut rows) = (0, Vec::new());
    for level in levels {
        rows.push(Const::new(Type::Vec2, &[level.side as f64, first as f64]));
        first += level.texels.len();
    }
    let rows = graph.add_table(Table { ty: Type::Vec2, elements: rows });
    let position = position(graph, direction);
    let [level, between] = level(graph);
    let one = graph.number(1.0);
    let next = graph.add(level, one);
    let maps = [level, next].map(|level| {
        let row = graph.element_of(rows, level);
        interpolated(graph, texels, row, position)
    });
    graph.ternary(Ternary::Mix, maps[0], maps[1], between)
}

/// The last level that is not rougher than the mirror, and how far it is to the next:
/// `5 log10(roughness / 0.1)`, see [`super::roughness`].
fn level(graph: &mut Graph) -> [NodeId; 2] {
    let mirror = graph.point(1, Dim::Three);
    let roughness = graph.component(mirror, 0);
    let least = graph.number(SMOOTHEST);
    let roughness = graph.max(roughness, least);
    let last = (LEVELS - 1) as f64;
    let per_octave = graph.number(last * 2f64.log10());
    let octaves = graph.unary(Unary::Log2, roughness);
    let scaled = graph.mul(octaves, per_octave);
    let [zero, last, before] = [0.0, last, last - 1.0].map(|value| graph.number(value));
    let level = graph.add(scaled, last);
    let level = graph.ternary(Ternary::Clamp, level, zero, last);
    let whole = graph.unary(Unary::Floor, level);
    let whole = graph.min(whole, before);
    [whole, graph.sub(level, whole)]
}

/// The position of a direction in the square of an [`Octahedron`], from 0 to 1.
fn position(graph: &mut Graph, direction: NodeId) -> NodeId {
    let [zero, one, minus, half] = [0.0, 1.0, -1.0, 0.5].map(|value| graph.number(value));
    let ones = graph.constant(Type::Vec3, &[1.0; 3]);
    let sizes = graph.abs(direction);
    let sum = graph.dot(sizes, ones);
    let flat = graph.swizzle(direction, &[0, 2]);
    let at = graph.div(flat, sum);
    // The lower half is folded out.
    let swapped = graph.swizzle(at, &[1, 0]);
    let swapped = graph.abs(swapped);
    let distance = graph.sub(one, swapped);
    let signs = [0, 1].map(|lane| {
        let lane = graph.component(at, lane);
        let is_negative = graph.lt(lane, zero);
        graph.select(is_negative, minus, one)
    });
    let signs = graph.compose(&signs);
    let folded = graph.mul(distance, signs);
    let y = graph.component(direction, 1);
    let is_below = graph.lt(y, zero);
    let at = graph.select(is_below, folded, at);
    let scaled = graph.mul(at, half);
    graph.add(scaled, half)
}

/// The light of a map at a position. `row` has the map's side and the index of its first texel.
fn interpolated(graph: &mut Graph, texels: TableId, row: NodeId, position: NodeId) -> NodeId {
    let [side, first] = [0, 1].map(|lane| graph.component(row, lane));
    let [one, two] = [1.0, 2.0].map(|value| graph.number(value));
    let (steps, before) = (graph.sub(side, one), graph.sub(side, two));
    let at = graph.mul(position, steps);
    let whole = graph.unary(Unary::Floor, at);
    let whole = graph.min(whole, before);
    let rest = graph.sub(at, whole);
    let [column, line] = [0, 1].map(|lane| graph.component(whole, lane));
    let [along, down] = [0, 1].map(|lane| graph.component(rest, lane));
    let skipped = graph.mul(line, side);
    let above = graph.add(skipped, column);
    let above = graph.add(first, above);
    let below = graph.add(above, side);
    let lines = [above, below].map(|left| {
        let right = graph.add(left, one);
        let ends = [left, right].map(|index| graph.element_of(texels, index));
        graph.ternary(Ternary::Mix, ends[0], ends[1], along)
    });
    graph.ternary(Ternary::Mix, lines[0], lines[1], down)
}

/// The light that a matt white surface reflects: a polynomial of its normal of degree 2.
fn irradiance(graph: &mut Graph, coefficients: &Coefficients, normal: NodeId) -> NodeId {
    let [x, y, z] = [0, 1, 2].map(|lane| graph.component(normal, lane));
    let [xy, yz, xz, xx, yy, zz] = [(x, y), (y, z), (x, z), (x, x), (y, y), (z, z)]
        .map(|(a, b)| graph.binary(Binary::Mul, a, b));
    let difference = graph.sub(xx, yy);
    let [one, three] = [1.0, 3.0].map(|value| graph.number(value));
    let tripled = graph.mul(three, zz);
    let last = graph.sub(tripled, one);
    // In the order of `harmonics::basis`.
    let basis = [one, x, y, z, xy, yz, xz, difference, last];
    let mut sum = graph.constant(Type::Vec3, &[0.0; 3]);
    for (coefficient, value) in coefficients.iter().zip(basis) {
        let coefficient = graph.constant(Type::Vec3, coefficient);
        let term = graph.mul(coefficient, value);
        sum = graph.add(sum, term);
    }
    // Opposite a small bright light the polynomial is a little below 0.
    let zero = graph.number(0.0);
    graph.max(sum, zero)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use sdfc_graph::eval::{FrameValues, Tape};

    use super::super::harmonics::{irradiance as coefficients, irradiance_at};
    use super::super::prefilter::{levels, roughness};
    use super::*;

    fn surroundings() -> Surroundings {
        let light = |[x, y, z]: [f32; 3]| [1.0 + x, if y > 0.3 { 4.0 } else { 0.1 }, 2.0 - z * x];
        let sharp = Octahedron::of(129, light);
        let irradiance = coefficients(&sharp);
        Surroundings { levels: levels(sharp), irradiance }
    }

    fn directions() -> impl Iterator<Item = [f64; 3]> {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let axes = axes.into_iter().flat_map(|axis| [axis, axis.map(|lane: f64| -lane)]);
        axes.chain((0..500).map(|index| {
            let y = f64::from(index) / 250.0 - 0.999;
            let (radius, angle) = ((1.0 - y * y).sqrt(), 2.4 * f64::from(index));
            [radius * angle.cos(), y, radius * angle.sin()]
        }))
    }

    #[test]
    fn functions_are_the_maps_and_the_polynomial() {
        let (mut graph, surroundings) = (Graph::new(), surroundings());
        let (turn, strength) = (graph.number(0.5 * PI), graph.number(3.0));
        let found = functions(&mut graph, &surroundings, turn, strength);
        let frame = FrameValues::default();
        let radiance = Tape::for_rays(&graph, &[found.radiance]).unwrap();
        let irradiance = Tape::new(&graph, &[found.irradiance]).unwrap();
        let (mut radiance, mut irradiance) =
            (radiance.prepare::<f64>(&frame), irradiance.prepare::<f64>(&frame));
        let near = |a: f64, b: f64| (a - b).abs() < 2e-4 * (1.0 + b.abs());
        for [x, y, z] in directions() {
            // A quarter of a turn about y takes z to x, so x of the scene shows z of the picture.
            let shown = [-z, y, x].map(|lane| lane as f32);
            for (level, map) in surroundings.levels.iter().enumerate() {
                let mirror = f64::from(roughness(level));
                let found = radiance.eval_ray([x, y, z], [mirror; 3])[0];
                let expected = map.light(shown).map(|lane| 3.0 * f64::from(lane));
                assert!((0..3).all(|i| near(found[i], expected[i])), "{level} {x} {y} {z}");
            }
            let sharp = surroundings.levels[0].light(shown).map(|lane| 3.0 * f64::from(lane));
            let smooth = radiance.eval_ray([x, y, z], [0.0; 3])[0];
            assert!((0..3).all(|i| near(smooth[i], sharp[i])), "{x} {y} {z}");
            let found = irradiance.eval([x, y, z])[0];
            let expected = irradiance_at(&surroundings.irradiance, shown).map(|lane| 3.0 * lane);
            assert!((0..3).all(|i| near(found[i], expected[i].max(0.0))), "{x} {y} {z}");
        }
    }
}
