//! Which loops may leave out rounds for a ray.
//!
//! Let every operand of a chain change by at most the distance that a point moves. A ray then meets the same surface without the operands
//! that stay above a margin all along it. Of hard minima at the root the margin is 0. Of a chain of blends of width k it is
//! [`WIDTHS`] k: operands of at least m k bring what the chain was before down to no less than (m - 1) k, and what differs there is damped by the
//! blends that follow by at least `exp(-2.45)` for each k that the value falls on its way to the surface, so that for m = 4 the
//! surface moves by less than k / 500.
//!
//! What stands between a loop and the root moves the margin: of `loop - r` the surface is where the loop is r, and a blend of
//! width k asks for values of up to [`WIDTHS`] k. `near` follows the values near which a surface may lie down to the loops; loops
//! below anything else are visited whole.

use sdfc_graph::{CullableLoop, Graph, Node, NodeId, SkipCondition, reachable};

use crate::reroll::active_range::{Near, Path, near};

/// Loops that rays visit in part; more are visited whole.
const MOST_LOOPS: usize = 8;

/// The loops that the roots are computed from and whose rounds can be left out, those of most rounds first. `steepest` is the most
/// that their operands change by where the point moves by 1, if that is known.
pub(crate) fn visits(
    graph: &mut Graph,
    roots: &[NodeId],
    steepest: Option<f64>,
) -> Vec<CullableLoop> {
    let Some(steepest) = steepest else { return Vec::new() };
    let needs = near(graph, roots);
    let mut found: Vec<(SkipCondition, Option<Near>, u32)> = Vec::new();
    for id in reachable(graph, roots) {
        let Node::Loop(repeated, ..) = graph.node(id) else { continue };
        let repeated = graph.loop_at(repeated);
        let (cap, depth) = (repeated.max_iterations, repeated.depth);
        let Some(inert) = repeated.skip.filter(|_| depth == 0) else { continue };
        // Of a hard minimum at the root each operand has been divided by its own constant.
        let is_zero = graph.as_number(inert.margin) == Some(0.0);
        let is_slow = |near: &Near| (is_zero && near.path == Path::Hard) || steepest <= 1.0 + 1e-9;
        let near = needs.get(id).flatten().filter(is_slow);
        match found.iter_mut().find(|known| known.0 == inert) {
            Some((_, known, _)) => {
                *known = near.zip(*known).and_then(|(a, b)| a.joined(graph, b));
            }
            None if is_flat(graph, inert.operand) => found.push((inert, near, cap)),
            None => {}
        }
    }
    let known =
        |(inert, near, rounds): (SkipCondition, Option<Near>, u32)| Some((inert, near?, rounds));
    let mut found: Vec<_> = found.into_iter().filter_map(known).collect();
    found.sort_by_key(|&(_, _, rounds)| std::cmp::Reverse(rounds));
    found.truncate(MOST_LOOPS);
    let visit = |(inert, near, rounds): (SkipCondition, Near, u32)| {
        let all = near.of_chain(graph, inert.margin);
        let blended = graph.sub(all.hi, near.hi);
        let scale = graph.number(near.scale);
        let operand = graph.mul(inert.operand, scale);
        let (reach, least) = (graph.sub(operand, all.hi), graph.sub(operand, blended));
        let ends = graph.compose(&[reach, least, operand]);
        CullableLoop {
            skip: inert,
            culling_bounds: ends,
            iterations: rounds,
            is_union_operand: near.path <= Path::Joined,
        }
    };
    found.into_iter().map(visit).collect()
}

/// Whether an operand holds no loop itself.
fn is_flat(graph: &Graph, operand: NodeId) -> bool {
    reachable(graph, &[operand]).into_iter().all(|id| !matches!(graph.node(id), Node::Loop(..)))
}
