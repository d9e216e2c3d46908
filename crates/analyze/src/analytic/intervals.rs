//! Where a ray is inside a solid: intervals of its length, and what unions, intersections and complements make of
//! them.
//!
//! A ray is inside in any of a list of intervals, which may overlap. One whose enter is above its exit holds nothing;
//! its complement, (-∞, enter] and [exit, ∞), is everything, as it must be.

use sdfc_graph::{Binary, FAR, Graph, NodeId};

/// Most intervals of an intersection or a complement.
const MOST: usize = 8;

/// Enter and exit, scalars.
pub(crate) type Span = [NodeId; 2];

/// Where a ray is inside a solid.
#[derive(Clone, Debug, Default)]
pub(crate) struct Known {
    pub(crate) spans: Vec<Span>,
    /// That is known so far from the ray's origin; `None`: everywhere.
    pub(crate) reach: Option<NodeId>,
}

impl Known {
    /// Whether it takes no more intervals than one may have of what is made of others.
    pub(crate) fn is_short(&self) -> bool {
        self.spans.len() <= MOST
    }
}

/// How far two things are known both.
fn nearer(graph: &mut Graph, a: Option<NodeId>, b: Option<NodeId>) -> Option<NodeId> {
    match (a, b) {
        (Some(a), Some(b)) => Some(graph.min(a, b)),
        (one, other) => one.or(other),
    }
}

/// Where a ray is inside any of some solids.
pub(crate) fn joined(graph: &mut Graph, all: Vec<Known>) -> Known {
    let mut whole = Known::default();
    for Known { spans, reach } in all {
        whole.spans.extend(spans);
        whole.reach = nearer(graph, whole.reach, reach);
    }
    whole
}

/// Where a ray is inside both; `None` where that takes too many intervals.
pub(crate) fn intersection(graph: &mut Graph, a: &Known, b: &Known) -> Option<Known> {
    let spans = both(graph, &a.spans, &b.spans)?;
    Some(Known { spans, reach: nearer(graph, a.reach, b.reach) })
}

fn both(graph: &mut Graph, a: &[Span], b: &[Span]) -> Option<Vec<Span>> {
    if a.len() * b.len() > MOST {
        return None;
    }
    let mut both = Vec::with_capacity(a.len() * b.len());
    for &[enter, exit] in a {
        for &[other_enter, other_exit] in b {
            both.push([graph.max(enter, other_enter), graph.min(exit, other_exit)]);
        }
    }
    Some(both)
}

/// Where a ray is not inside; `None` where that takes too many intervals.
pub(crate) fn complement(graph: &mut Graph, known: &Known) -> Option<Known> {
    let [before, after] = [-FAR, FAR].map(|end| graph.number(end));
    let mut outside = vec![[before, after]];
    for &[enter, exit] in &known.spans {
        outside = both(graph, &outside, &[[before, enter], [exit, after]])?;
    }
    Some(Known { spans: outside, reach: known.reach })
}

/// Intervals measured in units that are `factor` long.
pub(crate) fn scaled(graph: &mut Graph, spans: &[Span], factor: NodeId) -> Vec<Span> {
    spans.iter().map(|span| span.map(|end| graph.mul(end, factor))).collect()
}

/// Where a ray is inside for the first time, counted from its origin: 0 for one that starts inside, [`FAR`] for one
/// that never is.
pub(crate) fn first(graph: &mut Graph, spans: &[Span]) -> NodeId {
    let [zero, far] = [0.0, FAR].map(|end| graph.number(end));
    let mut nearest = far;
    for &[enter, exit] in spans {
        let start = graph.max(enter, zero);
        let is_inside = graph.binary(Binary::Le, start, exit);
        let met = graph.select(is_inside, start, far);
        nearest = graph.min(nearest, met);
    }
    nearest
}
