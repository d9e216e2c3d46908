//! Clauses that would give a shape without a Lipschitz constant one.

use sdfc_graph::eval::{Dual, FrameValues, Tape};
use sdfc_graph::{Dim, Expander, Graph, NodeId, Param, ShapeId};

use crate::certify::local_slope::{region, steepest_within};

/// Half the edge of the box that is suggested as bounds.
const REACH: f64 = 2.0;
/// Budget of the search with suggested bounds, in scalar operations.
const OPERATIONS: usize = 1 << 22;
/// Points along each axis at which slopes are sampled.
const SAMPLES: usize = 12;
/// A suggested constant divided by the largest sampled slope.
const MARGIN: f64 = 1.2;

/// Clauses to add to a declaration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SuggestedClauses {
    /// Half the edge of a cube around the origin, for the clause `bounds`.
    pub bounds: Option<f64>,
    /// The constant for the clause `lipschitz`, from samples.
    pub lipschitz: Option<f64>,
}

/// Clauses with which an uncertified shape would be certified, if its children are: bounds if
/// interval derivatives give a constant within them, else a constant from samples.
pub fn suggested_clauses(
    graph: &Graph,
    shape: ShapeId,
    params: &[Param],
) -> Option<SuggestedClauses> {
    let mut graph = graph.clone();
    let dim = graph.shape(shape).dim;
    let ends = [-REACH, REACH].map(|end| {
        let width = dim.point_type().width();
        graph.constant(dim.point_type(), &[end; 3][..width])
    });
    let stated = graph.shape(shape).contract.bounds;
    let missing = stated.is_none().then_some(REACH);
    if missing.is_some() {
        let mut budget = OPERATIONS;
        let slope = steepest_within(&mut graph, shape, ends, params, &mut budget);
        if slope.is_some_and(|slope| slope.is_uniform()) {
            return Some(SuggestedClauses { bounds: missing, lipschitz: None });
        }
    }
    let steepest = sampled_slope(&mut graph, shape, stated.unwrap_or(ends), dim, params)?;
    Some(SuggestedClauses { bounds: missing, lipschitz: Some(rounded_up(MARGIN * steepest)) })
}

/// The largest slope at a grid of points, with the params at their defaults.
fn sampled_slope(
    graph: &mut Graph,
    shape: ShapeId,
    bounds: [NodeId; 2],
    dim: Dim,
    params: &[Param],
) -> Option<f64> {
    if graph.shape(shape).level > 0 {
        return None;
    }
    let region = region(graph, bounds, &FrameValues::ranges(params))?;
    let point = graph.point(0, dim);
    let field = Expander::new().field(graph, shape, point).ok()?;
    let tape = Tape::new(graph, &[field]).ok()?;
    let mut field = tape.prepare::<Dual>(&FrameValues::defaults(params));
    let mut steepest: f64 = 0.0;
    for i in 0..SAMPLES.pow(3) {
        let steps = [i % SAMPLES, i / SAMPLES % SAMPLES, i / SAMPLES.pow(2)];
        let at = |axis: usize| {
            let [lo, hi] = region[axis];
            // Points off the middle, where symmetric fields have no slope.
            lo + (hi - lo) * (steps[axis] as f64 + 0.03) / (SAMPLES as f64 - 0.94)
        };
        let partials = field.scalar(Dual::point([at(0), at(1), at(2)])).partials;
        let length = partials.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length.is_finite() {
            steepest = steepest.max(length);
        }
    }
    (steepest > 0.0).then_some(steepest)
}

/// The number, rounded up to two digits.
pub fn rounded_up(x: f64) -> f64 {
    let digits = (1.0 - x.log10().floor()).clamp(-12.0, 12.0) as i32;
    let scale = 10f64.powi(digits);
    (x * scale).ceil() / scale
}
