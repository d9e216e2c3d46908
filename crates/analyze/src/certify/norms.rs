//! Norms of vectors of Lipschitz constants, as nodes of the graph.

use sdfc_graph::{Graph, Node, NodeId, Polynomial, Unary, reachable};

/// All nodes that the roots depend on, and the arguments of annotated functions among them.
/// Simplification may have removed an argument from the formula.
pub(super) fn with_annotated_arguments(graph: &Graph, roots: &[NodeId]) -> Vec<NodeId> {
    let mut roots = roots.to_vec();
    loop {
        let order = reachable(graph, &roots);
        let claims = order.iter().filter_map(|&node| graph.lipschitz_claim(node));
        let missing: Vec<NodeId> = claims
            .flat_map(|claim| claim.arguments.iter().copied())
            .filter(|argument| order.binary_search(argument).is_err())
            .collect();
        if missing.is_empty() {
            return order;
        }
        roots.extend(missing);
    }
}

/// The number of occurrences of the most frequent lane: `v.xxy` changes by up to sqrt(2) times as
/// much as `v`.
pub(super) fn max_repeats(lanes: &[u8]) -> f64 {
    let count = |lane: &u8| lanes.iter().filter(|other| *other == lane).count();
    lanes.iter().map(count).max().unwrap_or(1) as f64
}

/// True if a node is the constant 0.
pub(super) fn is_zero(graph: &Graph, node: NodeId) -> bool {
    graph.as_number(node) == Some(0.0)
}

/// The length of a vector if it does not depend on params, as that of a sine and a cosine.
fn fixed_length(graph: &Graph, parts: &[NodeId]) -> Option<f64> {
    let mut sum = Polynomial::zero();
    for &part in parts {
        // The sign does not matter, since the lanes are squared.
        let signed = if let Node::Unary(Unary::Abs, x) = graph.node(part) { x } else { part };
        let term = Polynomial::of(graph, signed)?;
        sum = sum.plus(&term.times(&term)?);
    }
    sum.constant().map(f64::sqrt)
}

/// The largest absolute value of the lanes.
pub(super) fn largest_lane(graph: &mut Graph, node: NodeId) -> NodeId {
    let width = graph.ty(node).width() as u8;
    let magnitude = graph.abs(node);
    let mut largest = graph.component(magnitude, 0);
    for lane in 1..width {
        let other = graph.component(magnitude, lane);
        largest = graph.max(largest, other);
    }
    largest
}

/// The square root of the sum of the squares.
pub(super) fn hypotenuse(graph: &mut Graph, parts: &[NodeId]) -> NodeId {
    let varying: Vec<NodeId> = parts.iter().copied().filter(|&x| !is_zero(graph, x)).collect();
    match varying[..] {
        [] => graph.number(0.0),
        [one] => one,
        _ => {
            if let Some(length) = fixed_length(graph, &varying) {
                return graph.number(length);
            }
            let mut sum = graph.number(0.0);
            for x in varying {
                let square = graph.mul(x, x);
                sum = graph.add(sum, square);
            }
            graph.unary(Unary::Sqrt, sum)
        }
    }
}
