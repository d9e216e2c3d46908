//! Cullable loops: loops that can skip iterations for a ray.
//!
//! If every operand of a chain is 1-Lipschitz, a ray hits the same surface without the operands
//! that stay above a margin all along it. For hard minima at the root the margin is 0. For a chain
//! of blends of width k it is [`WIDTHS`] k: operands of at least m k lower the chain's value to no
//! less than (m - 1) k, and the blends that follow damp the difference by at least `exp(-2.45)` for
//! each k that the value falls on its way to the surface. So for m = 4 the surface moves by less
//! than k / 500.
//!
//! The operations between a loop and the root change the margin: the surface of `loop - r` is where
//! the loop has the value r, and a blend of width k uses values of up to [`WIDTHS`] k.
//! `active_range` follows the values around the surface from the root down to the loops. Loops
//! below any other operation run all of their iterations.

use sdfc_graph::{CullableLoop, Graph, Node, NodeId, SkipCondition, reachable};

use crate::guards::has_loop;
use crate::reroll::active_range::{ActiveRange, BlendContext, active_ranges};

/// Largest number of cullable loops; others run all of their iterations.
const MAX_LOOPS: usize = 8;

/// The cullable loops that the roots depend on, those with the most iterations first. `lipschitz`
/// is a Lipschitz constant of their operands, if one is known.
pub(crate) fn cullable_loops(
    graph: &mut Graph,
    roots: &[NodeId],
    lipschitz: Option<f64>,
) -> Vec<CullableLoop> {
    let Some(lipschitz) = lipschitz else { return Vec::new() };
    let ranges = active_ranges(graph, roots);
    let mut found: Vec<(SkipCondition, Option<ActiveRange>, u32)> = Vec::new();
    for id in reachable(graph, roots) {
        let Node::Loop(loop_id, ..) = graph.node(id) else { continue };
        let body = graph.loop_at(loop_id);
        let (iterations, depth) = (body.max_iterations, body.depth);
        let Some(skip) = body.skip.filter(|_| depth == 0) else { continue };
        // Each operand of a hard minimum at the root has been divided by its own constant.
        let is_zero = graph.as_number(skip.margin) == Some(0.0);
        let is_lipschitz = |range: &ActiveRange| {
            (is_zero && range.context == BlendContext::Hard) || lipschitz <= 1.0 + 1e-9
        };
        let range = ranges.get(id).flatten().filter(is_lipschitz);
        match found.iter_mut().find(|known| known.0 == skip) {
            Some((_, known, _)) => {
                *known = range.zip(*known).and_then(|(a, b)| a.union(graph, b));
            }
            None if !has_loop(graph, skip.lower) => found.push((skip, range, iterations)),
            None => {}
        }
    }
    let known = |(skip, range, iterations): (SkipCondition, Option<ActiveRange>, u32)| {
        Some((skip, range?, iterations))
    };
    let mut found: Vec<_> = found.into_iter().filter_map(known).collect();
    found.sort_by_key(|&(_, _, iterations)| std::cmp::Reverse(iterations));
    found.truncate(MAX_LOOPS);
    let cullable = |(skip, range, iterations): (SkipCondition, ActiveRange, u32)| {
        let all = range.of_chain(graph, skip.margin);
        let blended = graph.sub(all.hi, range.hi);
        let scale = graph.number(range.scale);
        let [lower, upper] = [skip.lower, skip.upper].map(|bound| graph.mul(bound, scale));
        let (distance, lowest) = (graph.sub(lower, all.hi), graph.sub(lower, blended));
        let culling_bounds = graph.compose(&[distance, lowest, upper]);
        CullableLoop {
            skip,
            culling_bounds,
            iterations,
            is_union_operand: range.context <= BlendContext::Joined,
        }
    };
    found.into_iter().map(cullable).collect()
}
