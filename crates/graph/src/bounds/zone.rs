//! Boxes whose faces are nodes.

use super::ends::Ends;
use super::search::Region;
use crate::graph::Graph;
use crate::node::NodeId;

/// A box that contains a set of points. For 2D shapes the last axis is unbounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Zone {
    /// Lower and upper end by axis; the box is empty if `lo > hi` on any axis.
    pub(super) axes: [Ends; 3],
    /// True if no precision was lost, so that the box need not be tightened.
    pub(super) tight: bool,
}

impl Zone {
    /// All points.
    pub(super) fn everywhere(graph: &mut Graph) -> Self {
        Self { axes: [graph.all_ends(); 3], tight: true }
    }

    /// No point.
    pub(super) fn nowhere(graph: &mut Graph) -> Self {
        let [lo, hi] = graph.all_ends();
        Self { axes: [[hi, lo]; 3], tight: true }
    }

    /// The box between two corners; axes beyond their width are unbounded.
    pub(super) fn between(graph: &mut Graph, [lo, hi]: [NodeId; 2], width: usize) -> Self {
        let mut zone = Self::everywhere(graph);
        for (i, ends) in zone.axes.iter_mut().enumerate().take(width) {
            *ends = [graph.lane(lo, i), graph.lane(hi, i)];
        }
        zone
    }

    /// A box given in numbers.
    pub(super) fn of_numbers(graph: &mut Graph, region: Region) -> Self {
        let axes = region.map(|side| side.map(|end| graph.number(end)));
        Self { axes, tight: true }
    }

    /// The same box, marked as imprecise.
    pub(super) fn loose(self) -> Self {
        Self { tight: false, ..self }
    }

    /// The smallest box that contains both.
    pub(super) fn hull(self, graph: &mut Graph, other: Self) -> Self {
        self.with(other, |[lo, hi], [other_lo, other_hi]| {
            [graph.end_min(lo, other_lo), graph.end_max(hi, other_hi)]
        })
    }

    /// The intersection of both.
    pub(super) fn overlap(self, graph: &mut Graph, other: Self) -> Self {
        self.with(other, |ends, other| graph.common_ends(ends, other))
    }

    /// One of two boxes, by a condition that does not depend on the point.
    pub(super) fn select(self, graph: &mut Graph, condition: NodeId, other: Self) -> Self {
        self.with(other, |ends, other_ends| {
            let mut side = |i: usize| {
                let (yes, no) = (ends[i], other_ends[i]);
                if yes == no { yes } else { graph.select(condition, yes, no) }
            };
            [side(0), side(1)]
        })
    }

    /// The box with all faces moved outwards.
    pub(super) fn grown(self, graph: &mut Graph, by: NodeId) -> Self {
        let axes = self.axes.map(|[lo, hi]| [graph.end_difference(lo, by), graph.end_sum(hi, by)]);
        Self { axes, ..self }
    }

    fn with(self, other: Self, mut join: impl FnMut(Ends, Ends) -> Ends) -> Self {
        let axis = |i: usize| join(self.axes[i], other.axes[i]);
        Self { axes: [0, 1, 2].map(axis), tight: self.tight && other.tight }
    }
}
