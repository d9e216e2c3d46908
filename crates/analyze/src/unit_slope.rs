//! Shapes whose field changes by 1 per unit of length along its gradient, wherever it has one.
//!
//! Exact distances do. So do their negations, minima and maxima, also at moved and rotated points:
//! each is one of them at every point, although it is not the distance everywhere.

use rustc_hash::FxHashSet;
use sdfc_graph::{Binary, Graph, Node, NodeId, ShapeId, Unary, reachable_where};

use crate::certify::maps::Maps;
use crate::certify::quality::{Qualities, is_fixed_shape};
use crate::shapes::shapes_below;

/// The shapes among `root` and those below it whose gradient is known to have length 1.
pub(crate) fn unit_slopes(
    graph: &mut Graph,
    qualities: &Qualities,
    root: ShapeId,
) -> FxHashSet<ShapeId> {
    let mut found = FxHashSet::default();
    for shape in shapes_below(graph, root) {
        let is_exact = qualities.get(shape).is_some_and(|quality| quality.sides.is_exact());
        if is_exact || selects(graph, shape, &found) {
            found.insert(shape);
        }
    }
    found
}

/// True if the formula does nothing but select among samples of these shapes at isometric maps of
/// its point, and their negations.
fn selects(graph: &mut Graph, shape: ShapeId, among: &FxHashSet<ShapeId>) -> bool {
    let (formula, level) = (graph.shape(shape).formula, graph.shape(shape).level);
    let mut maps = Maps::new(level);
    let nodes = reachable_where(graph, &[formula], |id| graph.as_sample(id).is_none());
    nodes.into_iter().all(|id| is_selection(graph, id, &mut maps, among))
}

fn is_selection(
    graph: &mut Graph,
    id: NodeId,
    maps: &mut Maps,
    among: &FxHashSet<ShapeId>,
) -> bool {
    match graph.node(id) {
        Node::Sample(child, at) => {
            among.contains(&child)
                && is_fixed_shape(graph, child, maps.level())
                && maps.is_isometry(graph, at)
        }
        Node::Unary(Unary::Neg, _) | Node::Binary(Binary::Min | Binary::Max, ..) => true,
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
        | Node::MaterialAt(..) => false,
    }
}
