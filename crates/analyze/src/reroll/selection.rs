//! Selections by the nearest operand, such as the colour of a union.
//!
//! The material of a union is that of its nearest operand, the first of equals. Its formula is a
//! tree: where the distance is `min(a, b)`, the material is `select(a <= b, x, y)`, and `a` and `x`
//! may be such pairs again. Where both operands of a minimum have the same material, the selection
//! is folded away, and the minimum is left.

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_graph::{Binary, Graph, IdSet, Node, NodeId, Ternary};

/// Nodes whose values belong to the nearest of some operands.
#[derive(Debug)]
pub(super) struct Selection {
    /// The arguments of the minimum of all operands.
    pub(super) distances: [NodeId; 2],
    /// The nodes, such as the colour and the roughness of a union.
    pub(super) heads: Vec<NodeId>,
    /// The distances of the operands. Of equal ones the first counts.
    pub(super) operands: Vec<NodeId>,
    /// For each head, its value where an operand is the nearest.
    pub(super) values: Vec<Vec<NodeId>>,
}

/// The largest selections among some nodes.
pub(super) fn selections(graph: &Graph, nodes: &[NodeId]) -> Vec<Selection> {
    let mut heads: FxHashMap<[NodeId; 2], Vec<NodeId>> = FxHashMap::default();
    let mut order = Vec::new();
    for &id in nodes {
        if let Some(Choice { distances, .. }) = choice(graph, id) {
            let same = heads.entry(distances).or_default();
            if same.is_empty() {
                order.push(distances);
            }
            same.push(id);
        }
    }
    let inner = inner_pairs(graph, &order);
    order.retain(|distances| !inner.contains(distances));
    let of = |distances| Some(selection(graph, distances, heads.remove(&distances)?));
    order.into_iter().filter_map(of).collect()
}

/// A selection by two distances: the first value if the first distance is at most the second one.
struct Choice {
    distances: [NodeId; 2],
    values: [NodeId; 2],
}

fn choice(graph: &Graph, id: NodeId) -> Option<Choice> {
    let Node::Ternary(Ternary::Select, [condition, yes, no]) = graph.node(id) else { return None };
    let Node::Binary(Binary::Le, a, b) = graph.node(condition) else { return None };
    Some(Choice { distances: [a, b], values: [yes, no] })
}

/// The arguments of a minimum.
pub(super) fn minimum(graph: &Graph, id: NodeId) -> Option<[NodeId; 2]> {
    let Node::Binary(Binary::Min, a, b) = graph.node(id) else { return None };
    Some([a, b])
}

/// The arguments of all minima below the given distances: selections by them belong to larger ones.
fn inner_pairs(graph: &Graph, pairs: &[[NodeId; 2]]) -> FxHashSet<[NodeId; 2]> {
    let (mut found, mut seen) = (FxHashSet::default(), IdSet::default());
    let mut pending: Vec<NodeId> = pairs.concat();
    while let Some(id) = pending.pop() {
        if !seen.insert(id) {
            continue;
        }
        if let Some(pair) = minimum(graph, id) {
            found.insert(pair);
            pending.extend(pair);
        }
    }
    found
}

/// The operands below two distances, and the values of the heads for each of them.
fn selection(graph: &Graph, distances: [NodeId; 2], heads: Vec<NodeId>) -> Selection {
    let (mut operands, mut values) = (Vec::new(), vec![Vec::new(); heads.len()]);
    let mut seen = IdSet::default();
    let mut pending = Vec::new();
    push(graph, &mut pending, distances, &heads);
    while let Some((distance, selected)) = pending.pop() {
        // An operand that occurred before is never nearer than itself.
        if !seen.insert(distance) {
            continue;
        }
        if let Some(pair) = minimum(graph, distance) {
            push(graph, &mut pending, pair, &selected);
            continue;
        }
        operands.push(distance);
        for (list, value) in values.iter_mut().zip(selected) {
            list.push(value);
        }
    }
    Selection { distances, heads, operands, values }
}

/// Adds both arguments of a minimum, the first on top, with the values of each.
fn push(
    graph: &Graph,
    pending: &mut Vec<(NodeId, Vec<NodeId>)>,
    pair: [NodeId; 2],
    selected: &[NodeId],
) {
    let side = |side: usize| {
        let value = |&id: &NodeId| match choice(graph, id) {
            Some(choice) if choice.distances == pair => choice.values[side],
            _ => id,
        };
        (pair[side], selected.iter().map(value).collect())
    };
    pending.extend([side(1), side(0)]);
}
