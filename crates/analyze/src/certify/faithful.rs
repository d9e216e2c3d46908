//! Fields that follow the distance outside of the surface, so that a soft shadow can compare them
//! with the way along a ray.
//!
//! An exact distance does, and so does a minimum or a smooth minimum of such fields, which falls
//! behind by the depth of its blend alone. A difference does not: beside an opening, it is the
//! distance to the side of the tool that goes on outside of the solid. Nor does the limit of copies
//! that are not sampled, or a formula that is flatter than a distance.

use rustc_hash::FxHashSet;
use sdfc_graph::{Binary, Graph, Node, ShapeId, Stage, Ternary};

use crate::certify::affine::{linear_between_jumps, similarity};
use crate::certify::promise::Promise;
use crate::certify::quality::Qualities;

/// Returns true if a shape's field follows the distance outside of its surface.
pub(crate) fn is_faithful(graph: &mut Graph, qualities: &Qualities, shape: ShapeId) -> bool {
    let (mut seen, mut pending) = (FxHashSet::default(), vec![shape]);
    while let Some(shape) = pending.pop() {
        if !seen.insert(shape) || is_exact_outside(qualities, shape) {
            continue;
        }
        match samples_of_minimum(graph, shape) {
            Some(samples) => pending.extend(samples),
            None => return false,
        }
    }
    true
}

fn is_exact_outside(qualities: &Qualities, shape: ShapeId) -> bool {
    qualities.get(shape).is_some_and(|quality| quality.sides.outside == Promise::Exact)
}

/// The shapes of which a formula is a minimum, or a minimum with corrections; `None` for another
/// formula, and if a sample is not at a similar map of the point.
fn samples_of_minimum(graph: &mut Graph, shape: ShapeId) -> Option<Vec<ShapeId>> {
    let (formula, level) = (graph.shape(shape).formula, graph.shape(shape).level);
    let (mut samples, mut seen, mut pending) = (Vec::new(), FxHashSet::default(), vec![formula]);
    while let Some(node) = pending.pop() {
        if !seen.insert(node) {
            continue;
        }
        match graph.node(node) {
            Node::Sample(child, at) => {
                let linear = linear_between_jumps(graph, at, level)?;
                similarity(graph, &linear)?;
                samples.push(child);
            }
            Node::Binary(Binary::Min, a, b) => pending.extend([a, b]),
            // The other operand is a radius, a factor or the correction of a blend.
            Node::Binary(Binary::Add | Binary::Mul, a, b) => {
                pending.push(if graph.stage(a) < Stage::Point { b } else { a });
            }
            Node::Binary(Binary::Sub, a, _) => pending.push(a),
            Node::Ternary(Ternary::Select, [condition, yes, no])
                if graph.stage(condition) < Stage::Point =>
            {
                pending.extend([yes, no]);
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::MaterialAt(..) => return None,
        }
    }
    Some(samples)
}
