//! Rules for minimum, maximum, clamps and selections, which are decided where ranges decide them.

use crate::graph::Graph;
use crate::node::{Binary, Node, NodeId, Ternary, Unary};

impl Graph {
    /// True if the ranges show that a is never above b.
    pub(super) fn never_above(&self, a: NodeId, b: NodeId) -> bool {
        self.range(a).hi <= self.range(b).lo
    }

    pub(super) fn simplified_abs(&mut self, a: NodeId) -> Option<NodeId> {
        let range = self.range(a);
        if range.lo >= 0.0 {
            return Some(a);
        }
        if range.hi <= 0.0 {
            return Some(self.neg(a));
        }
        let inner = self.as_neg(a)?;
        Some(self.abs(inner))
    }

    pub(super) fn simplified_min(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        if a == b || self.never_above(a, b) {
            return Some(a);
        }
        if self.never_above(b, a) {
            return Some(b);
        }
        self.choice_of_negatives(Binary::Max, a, b)
            .or_else(|| self.choice_of_constants(Binary::Min, a, b))
            .or_else(|| self.as_limits(Binary::Max, a, b))
    }

    pub(super) fn simplified_max(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        if a == b || self.never_above(b, a) {
            return Some(a);
        }
        if self.never_above(a, b) {
            return Some(b);
        }
        self.choice_of_negatives(Binary::Min, a, b)
            .or_else(|| self.choice_of_constants(Binary::Max, a, b))
            .or_else(|| self.as_limits(Binary::Min, a, b))
    }

    /// `min(-x, -y)` is `-max(x, y)`.
    fn choice_of_negatives(&mut self, opposite: Binary, a: NodeId, b: NodeId) -> Option<NodeId> {
        let (x, y) = (self.as_neg(a)?, self.as_neg(b)?);
        let choice = self.binary(opposite, x, y);
        Some(self.neg(choice))
    }

    /// `min(min(x, f), g)`, where f and g do not depend on the point.
    fn choice_of_constants(&mut self, op: Binary, a: NodeId, b: NodeId) -> Option<NodeId> {
        let (inner, g) = if self.is_low(b) { (a, b) } else { (b, a) };
        if !self.is_low(g) || self.is_low(inner) {
            return None;
        }
        let (x, y) = self.as_binary(op, inner)?;
        let (x, f) = if self.is_low(y) { (x, y) } else { (y, x) };
        if !self.is_low(f) {
            return None;
        }
        let least = self.binary(op, f, g);
        Some(self.binary(op, x, least))
    }

    /// `min(max(x, lo), hi)` and `max(min(x, hi), lo)` with ordered constants.
    fn as_limits(&mut self, inner_op: Binary, a: NodeId, b: NodeId) -> Option<NodeId> {
        let constant = |s: &Self, x, y| {
            if s.as_splat_number(y).is_some() {
                Some((x, y))
            } else {
                s.as_splat_number(x).map(|_| (y, x))
            }
        };
        let (inner, outer) = constant(self, a, b)?;
        let (x, y) = self.as_binary(inner_op, inner)?;
        let (x, bound) = constant(self, x, y)?;
        let (lo, hi) = if inner_op == Binary::Max { (bound, outer) } else { (outer, bound) };
        (self.as_splat_number(lo) <= self.as_splat_number(hi))
            .then(|| self.ternary(Ternary::Clamp, x, lo, hi))
    }

    pub(super) fn simplified_clamp(&mut self, x: NodeId, lo: NodeId, hi: NodeId) -> Option<NodeId> {
        if self.never_above(lo, x) {
            return Some(self.min(x, hi));
        }
        if self.never_above(x, hi) && self.never_above(lo, hi) {
            return Some(self.max(x, lo));
        }
        (self.is_uniform(lo, 0.0) && self.is_uniform(hi, 1.0))
            .then(|| self.unary(Unary::Saturate, x))
    }

    pub(super) fn simplified_saturate(&mut self, x: NodeId) -> Option<NodeId> {
        let range = self.range(x);
        if range.lo >= 0.0 {
            let one = self.one_like(x);
            return Some(self.min(x, one));
        }
        (range.hi <= 1.0).then(|| {
            let zero = self.zero_like(x);
            self.max(x, zero)
        })
    }

    pub(super) fn simplified_step(&mut self, edge: NodeId, x: NodeId) -> Option<NodeId> {
        if self.never_above(edge, x) {
            return Some(self.one_like(x));
        }
        (self.range(x).hi < self.range(edge).lo).then(|| self.zero_like(x))
    }

    pub(super) fn simplified_mix(&mut self, a: NodeId, b: NodeId, t: NodeId) -> Option<NodeId> {
        if a == b || self.is_uniform(t, 0.0) {
            return Some(a);
        }
        if self.is_uniform(t, 1.0) {
            return Some(b);
        }
        if self.is_uniform(a, 0.0) {
            return Some(self.mul(b, t));
        }
        let selection = self.as_splat(t).unwrap_or(t);
        if let Some([condition, yes, no]) = self.as_select(selection) {
            if self.is_uniform(yes, 1.0) && self.is_uniform(no, 0.0) {
                return Some(self.select(condition, b, a));
            }
            if self.is_uniform(yes, 0.0) && self.is_uniform(no, 1.0) {
                return Some(self.select(condition, a, b));
            }
        }
        None
    }

    pub(super) fn simplified_select(
        &mut self,
        condition: NodeId,
        yes: NodeId,
        no: NodeId,
    ) -> Option<NodeId> {
        if yes == no {
            return Some(yes);
        }
        if let Some(holds) = self.as_truth(condition) {
            return Some(if holds { yes } else { no });
        }
        if let Some(opposite) = self.as_unary(Unary::Not, condition) {
            return Some(self.select(opposite, no, yes));
        }
        if let Some([same, inner, _]) = self.as_select(yes)
            && same == condition
        {
            return Some(self.select(condition, inner, no));
        }
        if let Some([same, _, inner]) = self.as_select(no)
            && same == condition
        {
            return Some(self.select(condition, yes, inner));
        }
        if let Some((x, y)) = self.both_splat(yes, no) {
            let scalar = self.select(condition, x, y);
            return Some(self.splat(self.ty(yes), scalar));
        }
        self.select_of_truths(condition, yes, no)
            .or_else(|| self.select_of_compared(condition, yes, no))
    }

    /// `select(a < b, b, a)` is a maximum. The operands are ordered so that a tie gives what the
    /// selection gives.
    fn select_of_compared(&mut self, condition: NodeId, yes: NodeId, no: NodeId) -> Option<NodeId> {
        let Node::Binary(op, a, b) = self.node(condition) else { return None };
        let tied = match op {
            Binary::Le => [yes, no],
            Binary::Lt => [no, yes],
            Binary::Add
            | Binary::Sub
            | Binary::Mul
            | Binary::Div
            | Binary::Rem
            | Binary::Min
            | Binary::Max
            | Binary::Pow
            | Binary::Atan2
            | Binary::Step
            | Binary::Hash
            | Binary::Dot
            | Binary::Cross
            | Binary::Eq
            | Binary::Ne
            | Binary::And
            | Binary::Or
            | Binary::Alternative => return None,
        };
        let [first, second] = tied;
        if (yes, no) == (a, b) {
            Some(self.min(first, second))
        } else if (yes, no) == (b, a) {
            Some(self.max(first, second))
        } else {
            None
        }
    }
}
