//! Rules for comparisons and truth values.

use super::is_truth;
use crate::graph::Graph;
use crate::node::{Binary, Node, NodeId, Unary};

impl Graph {
    /// The truth value, if the node is a constant truth value.
    pub(super) fn as_truth(&self, id: NodeId) -> Option<bool> {
        self.as_splat_number(id).filter(|_| is_truth(self.ty(id))).map(|value| value != 0.0)
    }

    pub(super) fn simplified_lt(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        if a == b || self.never_above(b, a) {
            return Some(self.boolean(false));
        }
        if self.range(a).hi < self.range(b).lo {
            return Some(self.boolean(true));
        }
        self.compared_difference(Binary::Lt, a, b)
    }

    pub(super) fn simplified_le(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        if a == b || self.never_above(a, b) {
            return Some(self.boolean(true));
        }
        if self.range(b).hi < self.range(a).lo {
            return Some(self.boolean(false));
        }
        self.compared_difference(Binary::Le, a, b)
    }

    /// `0 < x - y` is `y < x`; `x - y < 0` is `x < y`.
    fn compared_difference(&mut self, op: Binary, a: NodeId, b: NodeId) -> Option<NodeId> {
        if self.is_uniform(a, 0.0) {
            let (x, y) = self.as_binary(Binary::Sub, b)?;
            return Some(self.binary(op, y, x));
        }
        if self.is_uniform(b, 0.0) {
            let (x, y) = self.as_binary(Binary::Sub, a)?;
            return Some(self.binary(op, x, y));
        }
        None
    }

    pub(super) fn simplified_equality(
        &mut self,
        op: Binary,
        a: NodeId,
        b: NodeId,
    ) -> Option<NodeId> {
        if a == b {
            return Some(self.boolean(op == Binary::Eq));
        }
        if is_truth(self.ty(a)) {
            let (value, other) = match (self.as_truth(a), self.as_truth(b)) {
                (Some(value), _) => (value, b),
                (None, Some(value)) => (value, a),
                (None, None) => return self.in_order(op, a, b),
            };
            let same = value == (op == Binary::Eq);
            return Some(if same { other } else { self.unary(Unary::Not, other) });
        }
        let apart = self.range(a).hi < self.range(b).lo || self.range(b).hi < self.range(a).lo;
        if apart {
            return Some(self.boolean(op == Binary::Ne));
        }
        self.in_order(op, a, b)
    }

    pub(super) fn simplified_connective(
        &mut self,
        op: Binary,
        a: NodeId,
        b: NodeId,
    ) -> Option<NodeId> {
        if a == b {
            return Some(a);
        }
        // `true` is neutral to `and` and decides `or`.
        let neutral = op == Binary::And;
        match (self.as_truth(a), self.as_truth(b)) {
            (Some(value), _) => Some(if value == neutral { b } else { a }),
            (None, Some(value)) => Some(if value == neutral { a } else { b }),
            (None, None) => self.in_order(op, a, b),
        }
    }

    /// A commutative operation in canonical order; `None` if the given order is canonical.
    pub(super) fn in_order(&mut self, op: Binary, a: NodeId, b: NodeId) -> Option<NodeId> {
        let (first, second) = self.ordered(a, b);
        (first != a).then(|| self.intern(Node::Binary(op, first, second)))
    }

    pub(super) fn simplified_not(&mut self, a: NodeId) -> Option<NodeId> {
        if let Some(inner) = self.as_unary(Unary::Not, a) {
            return Some(inner);
        }
        let Node::Binary(op, x, y) = self.node(a) else { return None };
        match op {
            Binary::Lt => Some(self.le(y, x)),
            Binary::Le => Some(self.lt(y, x)),
            Binary::Eq => Some(self.binary(Binary::Ne, x, y)),
            Binary::Ne => Some(self.binary(Binary::Eq, x, y)),
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
            | Binary::And
            | Binary::Or
            | Binary::Alternative => None,
        }
    }

    /// A selection between truth values.
    pub(super) fn select_of_truths(
        &mut self,
        condition: NodeId,
        yes: NodeId,
        no: NodeId,
    ) -> Option<NodeId> {
        match (self.as_truth(yes), self.as_truth(no)) {
            (Some(true), Some(false)) => Some(condition),
            (Some(false), Some(true)) => Some(self.unary(Unary::Not, condition)),
            (Some(true), None) => Some(self.binary(Binary::Or, condition, no)),
            (None, Some(false)) => Some(self.binary(Binary::And, condition, yes)),
            (None, None)
            | (Some(false), None)
            | (None, Some(true))
            | (Some(true), Some(true))
            | (Some(false), Some(false)) => None,
        }
    }
}
