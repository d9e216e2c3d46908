//! The box of a shape from samples, for what needs no proof, such as where a camera looks.

use sdfc_graph::eval::{Evaluator, FrameValues, Tape};
use sdfc_graph::{Dim, Expander, Graph, ShapeId};

/// Lowest and highest corner.
type Corners = [[f64; 3]; 2];

/// Half the edges of the smallest and of the largest cube around the origin that is sampled.
const REACHES: [f64; 2] = [2.0, 1024.0];
/// Points along each axis of a cube.
const SAMPLES: usize = 16;
/// The most scalar operations of a formula that is sampled: all cubes together take about fifty
/// thousand evaluations.
const MOST_OPERATIONS: usize = 1000;

/// A box around all samples inside a shape of level 0, at a frame. It is wider than them by the
/// distance between two samples. `None` if no sample is inside, if some are at the border of the
/// largest cube, or if the formula does not expand or takes more than 1,000 operations.
pub fn sampled_bounds(graph: &mut Graph, shape: ShapeId, frame: &FrameValues) -> Option<Corners> {
    let dim = graph.shape(shape).dim;
    if graph.shape(shape).level > 0 {
        return None;
    }
    let point = graph.point(0, dim);
    let field = Expander::new().field(graph, shape, point).ok()?;
    let tape = Tape::new(graph, &[field]).ok()?;
    if tape.operations() > MOST_OPERATIONS {
        return None;
    }
    let mut field = tape.prepare::<f64>(frame);
    let mut reach = REACHES[0];
    while reach <= REACHES[1] {
        let cube = [[-reach; 3], [reach; 3]];
        let found = around_samples(&mut field, cube, dim);
        let is_within = |[lo, hi]: &Corners| {
            lo.iter().all(|&end| end > -reach) && hi.iter().all(|&end| end < reach)
        };
        if let Some(found) = found.filter(is_within) {
            return around_samples(&mut field, found, dim);
        }
        reach *= 2.0;
    }
    None
}

/// A box around the samples of a box that are inside, wider by the distance between samples.
fn around_samples(field: &mut Evaluator<'_, f64>, within: Corners, dim: Dim) -> Option<Corners> {
    let axes = dim.point_type().width();
    let [lo, hi] = within;
    let spacing: [f64; 3] =
        std::array::from_fn(|axis| (hi[axis] - lo[axis]) / (SAMPLES - 1) as f64);
    let mut found: Option<Corners> = None;
    for index in 0..SAMPLES.pow(axes as u32) {
        let steps = [index % SAMPLES, index / SAMPLES % SAMPLES, index / SAMPLES.pow(2)];
        let p: [f64; 3] = std::array::from_fn(|axis| match axis < axes {
            true => lo[axis] + spacing[axis] * steps[axis] as f64,
            false => 0.0,
        });
        if field.scalar(p) < 0.0 {
            let [low, high] = found.get_or_insert([p, p]);
            for axis in 0..axes {
                low[axis] = low[axis].min(p[axis] - spacing[axis]);
                high[axis] = high[axis].max(p[axis] + spacing[axis]);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use sdfc_graph::{Contract, MaterialRule, NodeId, Shape};

    use super::*;

    fn bounds_of(formula: impl FnOnce(&mut Graph, NodeId) -> NodeId) -> Option<Corners> {
        let mut graph = Graph::new();
        let p = graph.point(0, Dim::Three);
        let formula = formula(&mut graph, p);
        let shape = graph.add_shape(Shape {
            definition: "shape".to_owned(),
            dim: Dim::Three,
            level: 0,
            args: Vec::new(),
            formula,
            contract: Contract::default(),
            intersect: Vec::new(),
            material: MaterialRule::Weighted(formula),
            children: Vec::new(),
            depth: 1,
            name: None,
        });
        sampled_bounds(&mut graph, shape, &FrameValues::default())
    }

    #[test]
    fn a_ball_is_found_within_a_spacing_or_two() {
        for radius in [0.5, 3.0, 200.0] {
            let found = bounds_of(|graph, p| {
                let (length, radius) = (graph.length(p), graph.number(radius));
                graph.sub(length, radius)
            });
            let [lo, hi] = found.expect("it has bounds");
            for end in lo.map(|end| -end).into_iter().chain(hi) {
                assert!((radius..1.5 * radius).contains(&end), "{radius}: {end}");
            }
        }
    }

    #[test]
    fn what_has_no_end_or_no_inside_has_none() {
        assert_eq!(bounds_of(|graph, p| graph.swizzle(p, &[1])), None);
        assert_eq!(bounds_of(|graph, p| graph.length(p)), None);
    }
}
