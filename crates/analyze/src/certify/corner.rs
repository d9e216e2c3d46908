//! The distance to a box by its usual formula, `length(max(v, 0)) + min(max(v.x, v.y, v.z), 0)`.
//!
//! One of its terms is 0 wherever the other is not: the second one where a component of v is
//! positive, the first one elsewhere. So it changes by no more than v does, whereas the sum of the
//! constants of its terms is 2.

use sdfc_graph::{Binary, Graph, Node, NodeId, Stage, Unary, operands};

/// Largest number of terms of the sum: the two, and constants.
const MAX_TERMS: usize = 6;
/// Largest number of operands of the maximum: the components of a vector.
const MAX_COMPONENTS: usize = 4;

/// v of a sum of the two terms and of values that do not depend on the point.
pub(crate) fn corner_distance(graph: &mut Graph, node: NodeId) -> Option<NodeId> {
    let varying = varying_terms(graph, node)?;
    let [a, b] = varying[..] else { return None };
    of_terms(graph, a, b).or_else(|| of_terms(graph, b, a))
}

/// The terms of a sum that depend on the point.
fn varying_terms(graph: &Graph, sum: NodeId) -> Option<Vec<NodeId>> {
    let varies = |node: NodeId| graph.stage(node) == Stage::Point;
    let is_sum = |op, b| op == Binary::Add || op == Binary::Sub && !varies(b);
    let terms = operands(graph, sum, MAX_TERMS, is_sum)?;
    Some(terms.into_iter().filter(|&term| varies(term)).collect())
}

fn of_terms(graph: &mut Graph, outer: NodeId, inner: NodeId) -> Option<NodeId> {
    let Node::Unary(Unary::Length, raised) = graph.node(outer) else { return None };
    let v = with_zero(graph, Binary::Max, raised)?;
    let greatest = with_zero(graph, Binary::Min, inner)?;
    let width = graph.ty(v).width() as u8;
    let mut components: Vec<NodeId> = (0..width).map(|lane| graph.component(v, lane)).collect();
    let is_max = |op, _| op == Binary::Max;
    let mut compared = operands(graph, greatest, MAX_COMPONENTS, is_max)?;
    for nodes in [&mut components, &mut compared] {
        nodes.sort_unstable();
        nodes.dedup();
    }
    (components == compared).then_some(v)
}

/// x of `max(x, 0)` or `min(x, 0)`.
fn with_zero(graph: &Graph, op: Binary, node: NodeId) -> Option<NodeId> {
    let Node::Binary(own, a, b) = graph.node(node) else { return None };
    let is_zero = |id: NodeId| {
        let width = graph.ty(id).width();
        graph.as_const(id).is_some_and(|value| value.lanes()[..width].iter().all(|x| *x == 0.0))
    };
    match (own == op, is_zero(a), is_zero(b)) {
        (true, _, true) => Some(a),
        (true, true, false) => Some(b),
        (true, false, false) | (false, ..) => None,
    }
}
