//! Arithmetic on the ends of intervals, as nodes. Constants may be infinite here, which folding
//! leaves alone elsewhere.

use crate::graph::Graph;
use crate::node::{Binary, Node, NodeId};

/// An interval: its lower and its upper end, both scalar nodes.
pub(super) type Ends = [NodeId; 2];

impl Graph {
    /// All numbers.
    pub(super) fn all_ends(&mut self) -> Ends {
        [self.number(f64::NEG_INFINITY), self.number(f64::INFINITY)]
    }

    /// One component of a vector, looking through `Compose`, `Splat` and constants.
    pub(super) fn lane(&mut self, vector: NodeId, lane: usize) -> NodeId {
        match self.node(vector) {
            Node::Const(value) if value.ty().width() > 1 => self.number(value.lanes()[lane]),
            Node::Compose(_, parts) => parts[lane],
            Node::Splat(_, part) => part,
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => self.component(vector, lane as u8),
        }
    }

    /// True if the node is this constant.
    pub(super) fn is_number(&self, id: NodeId, value: f64) -> bool {
        self.as_number(id) == Some(value)
    }

    /// True if the node is an infinite constant.
    pub(super) fn is_infinite(&self, id: NodeId) -> bool {
        self.as_number(id).is_some_and(f64::is_infinite)
    }

    /// `a + b`; infinite if either is.
    pub(super) fn end_sum(&mut self, a: NodeId, b: NodeId) -> NodeId {
        if let (Some(x), Some(y)) = (self.as_number(a), self.as_number(b)) {
            self.number(x + y)
        } else if self.is_infinite(a) || self.is_number(b, 0.0) {
            a
        } else if self.is_infinite(b) || self.is_number(a, 0.0) {
            b
        } else {
            self.add(a, b)
        }
    }

    /// `-a`
    pub(super) fn end_negated(&mut self, a: NodeId) -> NodeId {
        match self.as_number(a) {
            Some(x) => self.number(-x),
            None => self.neg(a),
        }
    }

    /// `a - b`
    pub(super) fn end_difference(&mut self, a: NodeId, b: NodeId) -> NodeId {
        if self.as_number(b).is_none() && !self.is_infinite(a) && !self.is_number(a, 0.0) {
            return self.sub(a, b);
        }
        if let (Some(x), Some(y)) = (self.as_number(a), self.as_number(b)) {
            return self.number(x - y);
        }
        let b = self.end_negated(b);
        self.end_sum(a, b)
    }

    /// `a * b`; 0 if either is.
    pub(super) fn end_product(&mut self, a: NodeId, b: NodeId) -> NodeId {
        if self.is_number(a, 0.0) || self.is_number(b, 0.0) {
            return self.number(0.0);
        }
        if let (Some(x), Some(y)) = (self.as_number(a), self.as_number(b)) {
            self.number(x * y)
        } else if self.is_number(a, 1.0) {
            b
        } else if self.is_number(b, 1.0) {
            a
        } else {
            self.mul(a, b)
        }
    }

    /// `a / b` for a b that is not 0.
    pub(super) fn end_quotient(&mut self, a: NodeId, b: NodeId) -> NodeId {
        if let (Some(x), Some(y)) = (self.as_number(a), self.as_number(b)) {
            return self.number(x / y);
        }
        if self.is_number(a, 0.0) || self.is_number(b, 1.0) {
            return a;
        }
        match self.node(b) {
            Node::Binary(Binary::Div, one, by) if self.is_number(one, 1.0) => {
                self.end_product(a, by)
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => self.div(a, b),
        }
    }

    /// The intersection of two intervals.
    pub(super) fn common_ends(&mut self, [lo, hi]: Ends, [other_lo, other_hi]: Ends) -> Ends {
        [self.end_max(lo, other_lo), self.end_min(hi, other_hi)]
    }

    /// The lesser of two ends.
    pub(super) fn end_min(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.as_number(a), self.as_number(b)) {
            (Some(x), Some(y)) => [a, b][usize::from(y < x)],
            (Some(x), _) if x.is_infinite() => {
                if x < 0.0 {
                    a
                } else {
                    b
                }
            }
            (_, Some(y)) if y.is_infinite() => {
                if y < 0.0 {
                    b
                } else {
                    a
                }
            }
            (Some(_) | None, Some(_) | None) => self.min(a, b),
        }
    }

    /// The greater of two ends.
    pub(super) fn end_max(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.as_number(a), self.as_number(b)) {
            (Some(x), Some(y)) => [a, b][usize::from(x < y)],
            (Some(x), _) if x.is_infinite() => {
                if x > 0.0 {
                    a
                } else {
                    b
                }
            }
            (_, Some(y)) if y.is_infinite() => {
                if y > 0.0 {
                    b
                } else {
                    a
                }
            }
            (Some(_) | None, Some(_) | None) => self.max(a, b),
        }
    }
}
