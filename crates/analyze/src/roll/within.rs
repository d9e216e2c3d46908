//! Where the surfaces lie that loops are part of, if something endless stands beside them.

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_graph::{
    Arg, Bounds, Contract, Dim, Graph, MaterialRule, Node, NodeId, Param, Shape, ShapeId,
};

use super::FEWEST;
use super::chain::{Chain, least};
use crate::clip::is_finite;
use crate::quality::shapes_below;

/// Corners of a box around all that a scene is the union of but floors and the like: shapes without bounds that are too few
/// and too simple for a loop. `None` where there are no such; the scene's own bounds tell then.
pub(crate) fn within(graph: &mut Graph, root: ShapeId, params: &[Param]) -> Option<[NodeId; 2]> {
    let mut bounds = Bounds::new(params);
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
        is_loop || !is_endless(graph, &mut bounds, child)
    });
    if rest.len() == all.len() {
        return None;
    }
    let children: FxHashSet<ShapeId> =
        rest.iter().filter_map(|&operand| sampled(graph, operand)).collect();
    let mut children: Vec<ShapeId> = children.into_iter().collect();
    children.sort_unstable();
    let depth = graph.shape(root).depth;
    let formula = rest.into_iter().reduce(|a, b| graph.min(a, b))?;
    let shape = graph.add_shape(Shape {
        definition: "what is in loops".to_owned(),
        dim: Dim::Three,
        level: 0,
        args: vec![Arg::Node(formula)],
        formula,
        contract: Contract::default(),
        hits: Vec::new(),
        material: MaterialRule::Shares(formula),
        children,
        depth,
        name: None,
    });
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

fn is_endless(graph: &mut Graph, bounds: &mut Bounds, shape: ShapeId) -> bool {
    let corners = bounds.of(graph, shape);
    let walls: Vec<NodeId> = corners
        .into_iter()
        .flat_map(|corner| (0..3).map(move |lane| (corner, lane)))
        .map(|(corner, lane)| graph.component(corner, lane))
        .collect();
    !walls.into_iter().all(|wall| is_finite(graph, wall))
}
