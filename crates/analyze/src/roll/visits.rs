//! Which loops may leave out rounds for a ray.
//!
//! Let every operand of a chain change by at most the distance that a point moves. A ray then meets the same surface without the operands
//! that stay above a margin all along it. Of hard minima the margin is 0. Of a chain of blends of width k it is
//! [`WIDTHS`] k: operands of at least m k bring what the chain was before down to no less than (m - 1) k, and what differs there is damped by the
//! blends that follow by at least `exp(-2.45)` for each k that the value falls on its way to the surface, so that for m = 4 the
//! surface moves by less than k / 500.

use sdfc_graph::{Graph, Inert, Node, NodeId, Visit, reachable};

/// Loops that rays visit in part; more are visited whole.
const MOST_LOOPS: usize = 8;
/// Blends' widths from which on an operand does not matter to a surface.
const WIDTHS: f64 = 4.0;

/// The loops that the roots are computed from and whose rounds can be left out, those of most rounds first. `steepest` is the most
/// that their operands change by where the point moves by 1, if that is known.
pub(crate) fn visits(graph: &mut Graph, roots: &[NodeId], steepest: Option<f64>) -> Vec<Visit> {
    let Some(steepest) = steepest else { return Vec::new() };
    let mut found: Vec<(Inert, u32)> = Vec::new();
    for id in reachable(graph, roots) {
        let Node::Loop(id, ..) = graph.node(id) else { continue };
        let repeated = graph.repeated(id);
        let Some(inert) = repeated.inert.filter(|_| repeated.depth == 0) else { continue };
        // Of a hard minimum each operand has been divided by its own constant.
        let is_slow = graph.as_number(inert.margin) == Some(0.0) || steepest <= 1.0 + 1e-9;
        if is_slow && !found.iter().any(|known| known.0 == inert) && is_flat(graph, inert.operand) {
            found.push((inert, repeated.cap));
        }
    }
    found.sort_by_key(|&(_, rounds)| std::cmp::Reverse(rounds));
    found.truncate(MOST_LOOPS);
    let visit = |(inert, rounds): (Inert, u32)| {
        let widths = graph.number(WIDTHS);
        let margin = graph.mul(inert.margin, widths);
        Visit { inert, reach: graph.sub(inert.operand, margin), rounds }
    };
    found.into_iter().map(visit).collect()
}

/// Whether an operand holds no loop itself.
fn is_flat(graph: &Graph, operand: NodeId) -> bool {
    reachable(graph, &[operand]).into_iter().all(|id| !matches!(graph.node(id), Node::Loop(..)))
}
