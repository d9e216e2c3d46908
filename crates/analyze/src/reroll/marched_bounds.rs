//! Where the surfaces lie that loops are part of, if something endless stands beside them.

use rustc_hash::FxHashMap;
use sdfc_graph::{Bounds, Graph, Node, NodeId, ShapeId};

use crate::analytic::split::{self, has_end, unnamed};
use crate::certify::quality::shapes_below;
use crate::reroll::chain::{Chain, least};
use crate::reroll::rewrite::FEWEST;

/// Corners of a box around all that a scene is the union of but floors and the like: shapes without bounds that are too few
/// and too simple for a loop. `None` where there are no such; the scene's own bounds tell then.
pub(crate) fn within(graph: &mut Graph, bounds: &mut Bounds, root: ShapeId) -> Option<[NodeId; 2]> {
    let all = operands(graph, graph.shape(root).formula);
    let mut counts: FxHashMap<String, usize> = FxHashMap::default();
    for child in all.iter().filter_map(|&operand| sampled(graph, operand)) {
        *counts.entry(graph.shape(child).definition.clone()).or_default() += 1;
    }
    let mut rest = all.clone();
    rest.retain(|&operand| {
        let Some(child) = sampled(graph, operand) else { return true };
        let is_one_of_few = counts[&graph.shape(child).definition] < FEWEST;
        let is_simple = || shapes_below(graph, child).len() < FEWEST;
        let is_loop = !is_one_of_few || !is_simple();
        is_loop || has_end(graph, bounds, child)
    });
    if rest.len() == all.len() {
        return None;
    }
    let children = rest.iter().filter_map(|&operand| sampled(graph, operand)).collect();
    let formula = split::least(graph, rest)?;
    let shape = unnamed(graph, formula, children);
    Some(bounds.of(graph, shape))
}

/// What a formula is the least of.
fn operands(graph: &Graph, formula: NodeId) -> Vec<NodeId> {
    match least(graph, formula) {
        Chain::Least { operands, .. } => operands,
        Chain::Blend { .. } => vec![formula],
    }
}

fn sampled(graph: &Graph, operand: NodeId) -> Option<ShapeId> {
    if let Node::Sample(child, _) = graph.node(operand) { Some(child) } else { None }
}
