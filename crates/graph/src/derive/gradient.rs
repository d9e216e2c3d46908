//! The gradient of a scalar: by one sweep, part by part, and the choice between them.

use super::{loops, parts, sweep};
use crate::dump::operation_count;
use crate::formulas::FormulaChoice;
use crate::graph::Graph;
use crate::node::{Binary, NodeId};
use crate::schedule::live_lanes;

/// The number of live lanes up to which fewer gain nothing: the rest of a picture's shader needs
/// about as many.
const FREE_LANES: usize = 32;

/// GPUs hand out registers in groups of this size.
const LANES_OF_GROUP: usize = 8;

/// The least number of lanes that a part of the formula must need alone to be differentiated by
/// itself. Small parts keep fewer values alive; large ones take fewer operations.
const PARTS: [usize; 2] = [16, 8];

/// How a gradient is derived, and what that keeps alive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GradientReport {
    /// True if it is summed up part by part, false if one reverse sweep computes it.
    pub in_parts: bool,
    /// The largest number of lanes alive at once.
    pub live_lanes: usize,
    /// The same for one reverse sweep.
    pub live_lanes_of_sweep: usize,
}

/// The gradient of a scalar root with respect to a point (or any other node), a vector of its type.
pub fn gradient(graph: &mut Graph, root: NodeId, point: NodeId) -> NodeId {
    let found = sweep::adjoints(graph, root, &[point]);
    match loops::merged(graph, &found)[..] {
        [gradient] => gradient,
        _ => sweep::zero(graph, graph.ty(point)),
    }
}

/// The same gradient as [`gradient`], by one sweep for each part of the formula. A part ends at
/// every scalar that alone needs at least `least` lanes of other values. `None` if there is no such
/// scalar, or if the parts share so much that the sweeps would take quadratic time.
///
/// It takes more operations than one sweep, and keeps far fewer values alive.
pub fn gradient_in_parts(
    graph: &mut Graph,
    root: NodeId,
    point: NodeId,
    least: usize,
) -> Option<NodeId> {
    let found = parts::gradient(graph, root, point, least)?;
    loops::merged(graph, &[found]).pop()
}

/// Returns the gradient of a scalar with respect to a point: of one reverse sweep and of sums over
/// parts, the one that keeps the fewest lanes alive, and of equals the one with the fewest
/// operations.
///
/// A value with two formulas has a gradient of each; the report is about that of shaders.
pub fn best_gradient(graph: &mut Graph, root: NodeId, point: NodeId) -> (NodeId, GradientReport) {
    let short = graph.with_formulas(root, FormulaChoice::Short);
    let bounded = graph.with_formulas(root, FormulaChoice::Bounded);
    let (found, report) = best_of(graph, short, point);
    if short == bounded {
        return (found, report);
    }
    let (other, _) = best_of(graph, bounded, point);
    (graph.binary(Binary::Alternative, found, other), report)
}

fn best_of(graph: &mut Graph, root: NodeId, point: NodeId) -> (NodeId, GradientReport) {
    let sweep = gradient(graph, root, point);
    let live_lanes_of_sweep = live_lanes(graph, &[sweep]);
    let mut report =
        GradientReport { in_parts: false, live_lanes: live_lanes_of_sweep, live_lanes_of_sweep };
    let mut best = sweep;
    if live_lanes_of_sweep <= FREE_LANES {
        return (best, report);
    }
    for least in PARTS {
        let Some(found) = gradient_in_parts(graph, root, point, least) else { continue };
        let live_lanes = live_lanes(graph, &[found]);
        let rank = |graph: &Graph, id: NodeId, lanes: usize| {
            let groups = lanes.max(FREE_LANES).div_ceil(LANES_OF_GROUP);
            (groups, operation_count(graph, &[id]))
        };
        if rank(graph, found, live_lanes) < rank(graph, best, report.live_lanes) {
            best = found;
            report = GradientReport { in_parts: true, live_lanes, ..report };
        }
    }
    (best, report)
}
