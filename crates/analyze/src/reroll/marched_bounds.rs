//! Bounds of the operands that can become loops, without unbounded shapes beside them.

use rustc_hash::FxHashMap;
use sdfc_graph::{Bounds, Graph, Node, NodeId, ShapeId};

use crate::reroll::chain::{Chain, min_chain};
use crate::reroll::loops::MIN_OPERANDS;
use crate::shapes::{is_bounded, minimum, shapes_below, unnamed_shape};

/// Corners of a box around a scene's operands, without floors and the like: unbounded shapes that
/// are too few and too simple for a loop. Returns `None` if there are none, so that the bounds of
/// the scene serve.
pub(crate) fn looped_bounds(
    graph: &mut Graph,
    bounds: &mut Bounds,
    root: ShapeId,
) -> Option<[NodeId; 2]> {
    let all = operands(graph, graph.shape(root).formula);
    let mut counts: FxHashMap<String, usize> = FxHashMap::default();
    for child in all.iter().filter_map(|&operand| sampled(graph, operand)) {
        *counts.entry(graph.shape(child).definition.clone()).or_default() += 1;
    }
    let mut rest = all.clone();
    rest.retain(|&operand| {
        let Some(child) = sampled(graph, operand) else { return true };
        let is_one_of_few = counts[&graph.shape(child).definition] < MIN_OPERANDS;
        let is_simple = || shapes_below(graph, child).len() < MIN_OPERANDS;
        let is_loop = !is_one_of_few || !is_simple();
        is_loop || is_bounded(graph, bounds, child)
    });
    if rest.len() == all.len() {
        return None;
    }
    let children = rest.iter().filter_map(|&operand| sampled(graph, operand)).collect();
    let formula = minimum(graph, rest)?;
    let shape = unnamed_shape(graph, formula, children);
    Some(bounds.of(graph, shape))
}

/// The operands of a minimum.
fn operands(graph: &Graph, formula: NodeId) -> Vec<NodeId> {
    match min_chain(graph, formula) {
        Chain::Min { operands, .. } => operands,
        Chain::Blend { .. } => vec![formula],
    }
}

/// The shape that an operand samples, if it is a sample.
fn sampled(graph: &Graph, operand: NodeId) -> Option<ShapeId> {
    if let Node::Sample(child, _) = graph.node(operand) { Some(child) } else { None }
}
