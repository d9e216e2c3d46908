//! What rough mirrors receive: the surroundings, blurred by the lobe of each roughness.
//!
//! A mirror is seen along its normal here, as if every eye looked straight at it: B. Karis, Real
//! shading in Unreal Engine 4 (SIGGRAPH 2013). The slopes of its facets follow Trowbridge and Reitz
//! (GGX), as in the shader. Each texel is a sum over the same directions of the lobe. A direction
//! stands for a part of the lobe, and reads a map that is as coarse as this part: J. Křivánek, M.
//! Colbert, Real-time shading with filtered importance sampling (EGSR 2008).

use std::f32::consts::PI;

use super::octahedron::{Octahedron, Vector};

/// The number of maps: the surroundings, and five blurred ones.
pub const LEVELS: usize = 6;
/// The largest sides of the maps. The lobes are 1.5, 4, 9, 24, 60 and 180 degrees wide, and a
/// quarter of a turn is half as many texels as a side.
const SIDES: [usize; LEVELS] = [513, 129, 65, 33, 17, 17];
/// The numbers of directions of the lobes. Wide lobes have few texels, and see much at once.
const DIRECTIONS: [u32; LEVELS] = [1, 64, 64, 256, 256, 256];
/// The number of halved maps that lobes read.
const HALVED: usize = 7;

/// The roughness of a level: 0.1, then 10^(1/5) times as much for each, up to 1. So each
/// lobe is 2.5 times as wide as the one before.
pub fn roughness(level: usize) -> f32 {
    10f32.powf(level as f32 / (LEVELS - 1) as f32 - 1.0)
}

/// The roughness of the first level. Smoother materials do not occur in the shader.
pub const SMOOTHEST: f64 = 0.1;

/// The maps of all levels, the sharp one first.
pub fn levels(sharp: Octahedron) -> Vec<Octahedron> {
    let mut coarser = vec![sharp];
    while let Some(last) = coarser.last().filter(|last| last.side > 3 && coarser.len() < HALVED) {
        coarser.push(last.halved());
    }
    let blurred = (1..LEVELS).map(|level| blurred(&coarser, level));
    let blurred: Vec<Octahedron> = blurred.collect();
    coarser.truncate(1);
    coarser.extend(blurred);
    coarser
}

/// The side of the sharp map of a panorama with a number of columns: the largest of [`SIDES`] that
/// is not finer than the panorama at its middle.
pub fn sharp_side(columns: usize) -> usize {
    (columns / 2).next_power_of_two().clamp(SIDES[4] - 1, SIDES[0] - 1) + 1
}

/// A direction of a lobe around z.
struct LobeDirection {
    direction: Vector,
    weight: f32,
    /// Index of the map that it reads.
    map: usize,
}

/// What mirrors of a level receive.
fn blurred(maps: &[Octahedron], level: usize) -> Octahedron {
    let sharp = maps[0].side;
    let lobe = lobe(level, sharp, maps.len());
    let total: f32 = lobe.iter().map(|it| it.weight).sum();
    Octahedron::of(SIDES[level].min(sharp), |normal| {
        let [right, up] = tangents(normal);
        let mut sum = [0.0; 3];
        for LobeDirection { direction: [x, y, z], weight, map } in &lobe {
            let to = [0, 1, 2].map(|lane| x * right[lane] + y * up[lane] + z * normal[lane]);
            let light = maps[*map].light(to);
            for (sum, lane) in sum.iter_mut().zip(light) {
                *sum += weight * lane;
            }
        }
        sum.map(|sum| sum / total)
    })
}

/// The directions of a lobe. Facets are chosen with their density D; a mirrored direction has the
/// density D / 4 then, and counts by its cosine.
fn lobe(level: usize, side: usize, maps: usize) -> Vec<LobeDirection> {
    // GGX takes the roughness squared for alpha.
    let square = roughness(level).powi(4);
    let count = DIRECTIONS[level];
    // Mean solid angle of a texel of the sharp map.
    let texel = 4.0 * PI / ((side - 1) * (side - 1)) as f32;
    let direction = |index: u32| {
        let [u, v] = [(index as f32 + 0.5) / count as f32, radical_inverse(index)];
        let cosine_squared = (1.0 - u) / (1.0 + (square - 1.0) * u);
        // Twice the facet's angle, by the formulas for a double angle.
        let cosine = 2.0 * cosine_squared - 1.0;
        let sine = 2.0 * (cosine_squared * (1.0 - cosine_squared)).max(0.0).sqrt();
        let (y, x) = (2.0 * PI * v).sin_cos();
        let slope = (square - 1.0) * cosine_squared + 1.0;
        let density = square / (PI * slope * slope) / 4.0;
        let solid_angle = 1.0 / (count as f32 * density);
        let map = (0.5 * (solid_angle / texel).log2()).ceil().max(0.0) as usize;
        let direction = [sine * x, sine * y, cosine];
        LobeDirection { direction, weight: cosine, map: map.min(maps - 1) }
    };
    (0..count).map(direction).filter(|it| it.weight > 0.0).collect()
}

/// The bits of a number behind the binary point in reverse order (van der Corput), which fills the
/// interval from 0 to 1 evenly.
fn radical_inverse(index: u32) -> f32 {
    (index.reverse_bits() >> 8) as f32 / (1 << 24) as f32
}

/// Two unit vectors that are perpendicular to a normal and to each other. T. Duff et al., Building
/// an orthonormal basis, revisited (JCGT 6, 2017).
fn tangents([x, y, z]: Vector) -> [Vector; 2] {
    let sign = 1f32.copysign(z);
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    [[1.0 + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_stays_constant() {
        for level in levels(Octahedron::of(65, |_| [0.25, 1.0, 40.0])) {
            let near = |a: f32, b: f32| (a - b).abs() < 1e-4 * b;
            assert!(level.texels.iter().all(|it| near(it[0], 0.25) && near(it[2], 40.0)));
        }
    }

    #[test]
    fn levels_are_those_of_the_roughness() {
        assert!((f64::from(roughness(0)) - SMOOTHEST).abs() < 1e-7);
        assert!((roughness(LEVELS - 1) - 1.0).abs() < 1e-6);
        assert_eq!([2, 64, 1024, 1000].map(sharp_side), [17, 33, 513, 513]);
    }

    /// What a mirror receives, by a sum over all texels of a map: the light in each direction,
    /// weighted by D and by the cosine.
    fn summed(map: &Octahedron, roughness: f32, normal: Vector) -> f64 {
        let square = f64::from(roughness).powi(4);
        let (mut sum, mut total) = (0.0, 0.0);
        for (to, solid_angle, light) in map.weighted() {
            let cosine: f64 = (0..3).map(|lane| f64::from(to[lane] * normal[lane])).sum();
            if cosine <= 0.0 {
                continue;
            }
            let facet = (1.0 + cosine) / 2.0; // squared cosine of half the angle
            let weight = solid_angle * cosine / (facet * (square - 1.0) + 1.0).powi(2);
            sum += weight * f64::from(light[0]);
            total += weight;
        }
        sum / total
    }

    #[test]
    fn a_light_is_blurred_by_the_lobe() {
        let spot = |[x, y, z]: Vector| [if x + y > 1.2 && z > 0.0 { 9.0 } else { 0.5 }; 3];
        let sharp = Octahedron::of(257, spot);
        for (level, map) in levels(sharp.clone()).iter().enumerate().skip(1) {
            let apart = (map.texels.len() / 150).max(1);
            for (normal, _, found) in map.weighted().step_by(apart) {
                let expected = summed(&sharp, roughness(level), normal);
                let error = (f64::from(found[0]) - expected).abs();
                assert!(error < 0.03 * 9.0, "{level} {normal:?}: {} {expected}", found[0]);
            }
        }
    }
}
