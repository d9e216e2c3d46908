//! What a frame knows and its points use.

use crate::ids::IdSet;
use crate::walk::reachable_where;
use crate::{Graph, Node, NodeId, Stage};

/// The per-frame nodes that need a uniform slot, in ascending order: those that are roots or that a per-point
/// node uses. What they are computed from needs none.
///
/// A vector of per-frame parts is one slot. A `Splat` never has a slot: the number that fills it has, so what
/// reads the slots must look through a per-frame `Splat` to its argument. Truth values may be among the slots.
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

/// The node that holds the value of a per-frame node; none for one of another stage.
fn slot(graph: &Graph, id: NodeId) -> Option<NodeId> {
    if graph.stage(id) != Stage::Frame {
        return None;
    }
    Some(if let Node::Splat(_, filling) = graph.node(id) { filling } else { id })
}
