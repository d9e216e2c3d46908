//! Selection of the per-frame nodes that get a uniform slot.

use crate::graph::Graph;
use crate::ids::IdSet;
use crate::node::{Node, NodeId, Stage};
use crate::walk::reachable_where;

/// The per-frame nodes that need a uniform slot, in ascending order: roots, and nodes that a
/// per-point node uses. The nodes that these are computed from need none.
///
/// A vector composed of per-frame scalars takes one slot. A `Splat` never has a slot, but its
/// scalar has, so code that reads the slots must look through a per-frame `Splat` to its argument.
/// Truth values may be among the slots.
pub fn uniforms(graph: &Graph, roots: &[NodeId]) -> Vec<NodeId> {
    let per_point = |id: NodeId| graph.stage(id) == Stage::Point;
    let mut slots = IdSet::default();
    for id in reachable_where(graph, roots, per_point) {
        if per_point(id) {
            for slot in graph.arguments(id).filter_map(|used| slot(graph, used)) {
                slots.insert(slot);
            }
        }
    }
    for slot in roots.iter().filter_map(|&root| slot(graph, root)) {
        slots.insert(slot);
    }
    slots.to_vec()
}

/// The node whose slot holds the value of a per-frame node; `None` for a node of another stage.
fn slot(graph: &Graph, id: NodeId) -> Option<NodeId> {
    if graph.stage(id) != Stage::Frame {
        return None;
    }
    Some(if let Node::Splat(_, filling) = graph.node(id) { filling } else { id })
}
