//! The gradient, part by part.
//!
//! A reverse sweep over a whole formula returns to its values in the opposite order, so that all of
//! them stay alive until then. Here the formula is cut at scalars, such as the distances of shapes
//! and of their blends. Each part gets a sweep of its own, which ends at the cuts below. There the
//! derivative is known, since smaller parts come first. So values and derivatives are computed
//! together, in forward mode from cut to cut, and a cut leaves nothing alive but its value and its
//! derivative. Both come from the one rule per operation that the sweep has.

use super::cuts::{Cut, cuts};
use super::live::live_nodes;
use super::sweep::{Known, Sweep, zero};
use crate::graph::Graph;
use crate::ids::{IdMap, IdSet};
use crate::node::NodeId;
use crate::walk::{computed_where, visited};

/// The gradient of a scalar root with respect to a point, summed up at cuts; `None` if there are no
/// scalars that alone need at least `least` lanes of other values.
pub(super) fn gradient(
    graph: &mut Graph,
    root: NodeId,
    point: NodeId,
    least: usize,
) -> Option<NodeId> {
    let inputs: IdSet = [point].into_iter().collect();
    let order = computed_where(graph, &[root], |id| id != point);
    let live = live_nodes(graph, &order, &inputs);
    let mut cuts = cuts(graph, [root, point], &order, &live, least);
    if cuts.is_empty() {
        return None;
    }
    let mut limit = order.len().saturating_mul(MAX_VISITS);
    widen_frames(graph, [root, point], &live, &mut cuts, &mut limit)?;
    let mut sweep = Sweep::new(graph, live, inputs);
    for Cut { value, frame } in cuts {
        let derivative = part(&mut sweep, value, frame, &mut limit)?;
        sweep.known.insert(value, Known { frame, derivative });
    }
    part(&mut sweep, root, point, &mut limit)
}

/// How often the sweeps may visit a node, on average. Parts that share much would be swept in
/// quadratic time.
const MAX_VISITS: usize = 8;

/// The derivative of a scalar with respect to the frame of its part; `None` beyond the limit.
fn part(sweep: &mut Sweep<'_>, value: NodeId, frame: NodeId, limit: &mut usize) -> Option<NodeId> {
    let Sweep { graph, live, known, .. } = &*sweep;
    let frame_of = |id| known.get(id).map(|known| known.frame);
    let order = region(graph, live, [value, frame], frame_of);
    *limit = limit.checked_sub(order.len())?;
    sweep.inputs = [frame].into_iter().collect();
    sweep.run(value, order.into_iter().rev().filter(|&id| id != frame));
    let derivative = sweep.take(frame);
    Some(derivative.unwrap_or_else(|| zero(sweep.graph, sweep.graph.ty(frame))))
}

/// The nodes from a scalar down to its frame, ascending; below a cut, those from its frame on.
fn region(
    graph: &Graph,
    live: &IdSet,
    [value, frame]: [NodeId; 2],
    frame_of: impl Fn(NodeId) -> Option<NodeId>,
) -> Vec<NodeId> {
    visited(&[value], |id, pending| match frame_of(id) {
        _ if id == frame => {}
        Some(frame) if id != value => pending.push(frame),
        _ => pending.extend(graph.inputs(id).into_iter().filter(|&id| live.contains(id))),
    })
}

/// Gives a cut the frame of the part that contains it, if no other cut of that part has the same
/// frame. Its derivative then includes the maps between the two frames. So they are applied before
/// the derivative is weighted, and the conditions of the weights are not computed before it.
/// Returns `None` beyond the limit.
fn widen_frames(
    graph: &Graph,
    [root, point]: [NodeId; 2],
    live: &IdSet,
    cuts: &mut [Cut],
    limit: &mut usize,
) -> Option<()> {
    let frames: IdMap<NodeId> = cuts.iter().map(|cut| (cut.value, cut.frame)).collect();
    // For each cut the parts that it is in, and whether it shares its frame there.
    let mut found: IdMap<Place> = IdMap::default();
    let parts = cuts.iter().map(|cut| (cut.value, cut.frame)).chain([(root, point)]);
    for (value, frame) in parts {
        let nodes = region(graph, live, [value, frame], |id| frames.get(id));
        *limit = limit.checked_sub(nodes.len())?;
        let inner = nodes.into_iter().filter(|&id| id != value && id != frame);
        let inner: Vec<(NodeId, NodeId)> =
            inner.filter_map(|id| Some((id, frames.get(id)?))).collect();
        let mut counts: IdMap<usize> = IdMap::default();
        for &(_, own) in &inner {
            *counts.entry(own).get_or_insert_default() += 1;
        }
        for &(id, own) in &inner {
            let is_only = counts.get(own) == Some(1) && found.get(id).is_none();
            found.insert(id, Place { part: value, is_only });
        }
    }
    let mut widened: IdMap<NodeId> = [(root, point)].into_iter().collect();
    for cut in cuts.iter_mut().rev() {
        if let Some(Place { part, is_only: true }) = found.get(cut.value) {
            cut.frame = widened.get(part).unwrap_or(cut.frame);
        }
        widened.insert(cut.value, cut.frame);
    }
    Some(())
}

/// Where a cut is.
#[derive(Clone, Copy)]
struct Place {
    /// The part, by the scalar that it computes.
    part: NodeId,
    /// True if this is the only part with the cut, and no other cut there has its frame.
    is_only: bool,
}
