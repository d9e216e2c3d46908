//! The intervals along a ray that lie inside a solid, and their unions, intersections and
//! complements.
//!
//! A ray is inside within any of a list of intervals, which may overlap. An interval whose enter
//! exceeds its exit is empty. Its complement is computed as (-∞, enter] and [exit, ∞), which
//! together are everything, as they must be.

use sdfc_graph::{Binary, FAR, Graph, NodeId};

/// Largest number of intervals of an intersection or a complement.
const MAX_INTERVALS: usize = 8;

/// The distances at which a ray enters and leaves.
pub(crate) type RayInterval = [NodeId; 2];

/// The intervals along a ray that lie inside a solid.
#[derive(Clone, Debug, Default)]
pub(crate) struct RayIntervals {
    /// The intervals, in no order.
    pub(crate) list: Vec<RayInterval>,
    /// The distance from the ray's origin up to which they are known; `None`: everywhere.
    pub(crate) reach: Option<NodeId>,
}

impl RayIntervals {
    /// True if there are few enough intervals to combine them further.
    pub(crate) fn is_short(&self) -> bool {
        self.list.len() <= MAX_INTERVALS
    }
}

/// The distance up to which two things are both known.
fn common_reach(graph: &mut Graph, a: Option<NodeId>, b: Option<NodeId>) -> Option<NodeId> {
    match (a, b) {
        (Some(a), Some(b)) => Some(graph.min(a, b)),
        (one, other) => one.or(other),
    }
}

/// The union of the intervals of some solids.
pub(crate) fn union(graph: &mut Graph, all: Vec<RayIntervals>) -> RayIntervals {
    let mut whole = RayIntervals::default();
    for RayIntervals { list, reach } in all {
        whole.list.extend(list);
        whole.reach = common_reach(graph, whole.reach, reach);
    }
    whole
}

/// The intersection of two solids' intervals; `None` if it takes too many.
pub(crate) fn intersection(
    graph: &mut Graph,
    a: &RayIntervals,
    b: &RayIntervals,
) -> Option<RayIntervals> {
    let list = pairwise(graph, &a.list, &b.list)?;
    Some(RayIntervals { list, reach: common_reach(graph, a.reach, b.reach) })
}

/// The intersections of each interval of `a` with each of `b`; `None` if there are too many.
fn pairwise(graph: &mut Graph, a: &[RayInterval], b: &[RayInterval]) -> Option<Vec<RayInterval>> {
    if a.len() * b.len() > MAX_INTERVALS {
        return None;
    }
    let mut common = Vec::with_capacity(a.len() * b.len());
    for &[enter, exit] in a {
        for &[other_enter, other_exit] in b {
            common.push([graph.max(enter, other_enter), graph.min(exit, other_exit)]);
        }
    }
    Some(common)
}

/// The intervals outside a solid; `None` if there are too many.
pub(crate) fn complement(graph: &mut Graph, solid: &RayIntervals) -> Option<RayIntervals> {
    let [before, after] = [-FAR, FAR].map(|end| graph.number(end));
    let mut outside = vec![[before, after]];
    for &[enter, exit] in &solid.list {
        outside = pairwise(graph, &outside, &[[before, enter], [exit, after]])?;
    }
    Some(RayIntervals { list: outside, reach: solid.reach })
}

/// Multiplies intervals by a factor.
pub(crate) fn scaled(
    graph: &mut Graph,
    intervals: &[RayInterval],
    factor: NodeId,
) -> Vec<RayInterval> {
    intervals.iter().map(|interval| interval.map(|end| graph.mul(end, factor))).collect()
}

/// The distance at which a ray is first inside: 0 if it starts inside, [`FAR`] if it never is.
pub(crate) fn first_hit(graph: &mut Graph, intervals: &[RayInterval]) -> NodeId {
    let [zero, far] = [0.0, FAR].map(|end| graph.number(end));
    let mut nearest = far;
    for &[enter, exit] in intervals {
        let start = graph.max(enter, zero);
        let is_inside = graph.binary(Binary::Le, start, exit);
        let hit = graph.select(is_inside, start, far);
        nearest = graph.min(nearest, hit);
    }
    nearest
}
