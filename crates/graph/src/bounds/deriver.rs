//! The state of a derivation, and the queries that rules answer.

use rustc_hash::FxHashMap;

use super::zone::Zone;
use crate::blend::Blends;
use crate::eval::scalarise::Lanes;
use crate::eval::{FrameValues, Interval, Number, direct};
use crate::expand::Expander;
use crate::graph::Graph;
use crate::node::{Dim, Node, NodeId, ShapeId, Stage};
use crate::walk::reachable_where;

/// Stack left below which the recursion grows the stack, and the size of the new part.
pub(super) const RED_ZONE: usize = 128 * 1024;
pub(super) const STACK_STEP: usize = 4 * 1024 * 1024;

/// A question about a formula: where is it not above a limit? Equal queries have equal answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Query {
    /// A scalar.
    pub(super) node: NodeId,
    /// A scalar that does not depend on the formula's point.
    pub(super) limit: NodeId,
    /// Level of the formula's point.
    pub(super) level: u16,
    /// Dimension of the formula's point.
    pub(super) dim: Dim,
    /// If true: where is the node not below the limit?
    pub(super) above: bool,
}

/// Results found so far.
#[derive(Debug, Default)]
pub(super) struct Memo {
    pub(super) shapes: FxHashMap<(ShapeId, NodeId), Zone>,
    pub(super) tightened: FxHashMap<ShapeId, Zone>,
    pub(super) queries: FxHashMap<Query, Zone>,
    pub(super) exact: FxHashMap<ShapeId, bool>,
    pub(super) ranges: FxHashMap<NodeId, Lanes<Interval>>,
    pub(super) expander: Expander,
    pub(super) blends: Blends,
}

/// A derivation in progress.
pub(super) struct Deriver<'b> {
    pub(super) graph: &'b mut Graph,
    pub(super) ranges: &'b FrameValues<Interval>,
    pub(super) memo: &'b mut Memo,
}

impl Deriver<'_> {
    /// The end itself, or `bound` if the end is not known per frame.
    pub(super) fn per_frame(&mut self, end: NodeId, bound: f64) -> NodeId {
        let undefined = self.graph.as_number(end).is_some_and(f64::is_nan);
        if undefined || self.graph.stage(end) == Stage::Point {
            self.graph.number(bound)
        } else {
            end
        }
    }

    pub(super) fn vector(&mut self, dim: Dim, parts: [NodeId; 3]) -> NodeId {
        let (ty, parts) = (dim.point_type(), &parts[..dim.point_type().width()]);
        let numbers: Option<Vec<f64>> =
            parts.iter().map(|&part| self.graph.as_number(part)).collect();
        match numbers {
            Some(numbers) => self.graph.constant(ty, &numbers),
            None => self.graph.compose(parts),
        }
    }

    /// The values that a scalar or truth value can have at any point.
    pub(super) fn range(&mut self, node: NodeId) -> Interval {
        if let Some(number) = self.graph.as_number(node) {
            return Interval::constant(number);
        }
        // The ends of a long chain share most of their terms.
        let mut known = std::mem::take(&mut self.memo.ranges);
        let graph = &*self.graph;
        let order = reachable_where(graph, &[node], |id| {
            !known.contains_key(&id) && !matches!(graph.node(id), Node::Sample(..) | Node::Loop(..))
        });
        let range = direct::evaluate(graph, &order, &mut known, |id| self.input(id));
        self.memo.ranges = known;
        range
    }

    /// True if a condition holds for all values of the params.
    pub(super) fn is_true(&mut self, condition: NodeId) -> bool {
        self.range(condition).lo() > 0.0
    }

    /// The lanes of a node that is no operation, at any point.
    pub(super) fn input(&self, id: NodeId) -> [Interval; 4] {
        if let Node::Frame(input, _) = self.graph.node(id) {
            [0, 1, 2, 3].map(|lane| self.ranges.lane(input, lane))
        } else {
            [Interval::ENTIRE; 4]
        }
    }
}
