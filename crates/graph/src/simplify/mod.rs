//! Simplification in the builders: folding constants, and replacing an operation by a cheaper one
//! that is equal over the reals.
//!
//! Canonical forms, so that equal values share one node and constants gather:
//!
//! - `a + b` and `a * b`: the operand of the earlier stage stands on the right; within one stage,
//!   the older node stands on the left.
//! - `x - c` with a constant is an addition, unless no component of c is negative.
//! - Constant and per-frame terms of sums and factors of products are gathered: `(x + f) + g` is
//!   `x + (f + g)`, `x / f` is `x * (1 / f)`.
//! - Negation moves outwards, and into constants where it meets one.
//!
//! Rules never make a non-finite constant: such an operation stays as it is
//! ([`Graph::non_finite`]). Each rule looks at a fixed number of levels, so building is linear in
//! the number of operations.

mod arithmetic;
mod choice;
pub(crate) mod function;
mod logic;
mod vector;

use crate::eval::fold_where;
use crate::graph::Graph;
use crate::node::{Binary, Const, LoopVar, Node, NodeId, Stage, Ternary, Type, Unary};

impl Graph {
    /// The node for an operation: a constant, a simpler equivalent, or the operation itself.
    pub(crate) fn make(&mut self, node: Node) -> NodeId {
        if let Some(value) = self.folded(&node) {
            return self.intern(Node::Const(value));
        }
        let made = self.simplified(&node).unwrap_or_else(|| self.intern(node));
        if let Node::Unary(Unary::Neg, a) = node {
            self.carry_claim(a, made);
        }
        made
    }

    /// True if a node is an operation on constants without a finite result, such as `1 / 0`.
    pub fn non_finite(&self, id: NodeId) -> bool {
        self.stage(id) == Stage::Const && self.as_const(id).is_none()
    }

    fn folded(&self, node: &Node) -> Option<Const> {
        // Most nodes depend on an input, and stages are cheaper to read than nodes.
        if node.own_arguments().any(|argument| self.stage(argument) > Stage::Const) {
            return None;
        }
        // A node without arguments (a loop or its variable, for example) is no constant.
        node.own_arguments().next()?;
        fold_where(node, |argument| self.const_at(argument))
    }

    fn simplified(&mut self, node: &Node) -> Option<NodeId> {
        match *node {
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => None,
            Node::Unary(op, a) => self.simplified_unary(op, a),
            Node::Binary(op, a, b) => self.simplified_binary(op, a, b),
            Node::Ternary(op, arguments) => self.simplified_ternary(op, arguments),
            Node::Splat(..) => None,
            Node::Compose(ty, parts) => self.simplified_compose(&parts[..ty.width()]),
            Node::Swizzle(ty, a, lanes) => self.simplified_swizzle(a, &lanes[..ty.width()]),
            Node::Transform(columns, v) => self.simplified_transform(columns, v),
        }
    }

    fn simplified_unary(&mut self, op: Unary, a: NodeId) -> Option<NodeId> {
        if let Some(scalar) = self.as_splat(a)
            && is_componentwise(op)
        {
            let result = self.unary(op, scalar);
            return Some(self.splat(self.ty(a), result));
        }
        match op {
            Unary::Neg => self.simplified_neg(a),
            Unary::Abs => self.simplified_abs(a),
            Unary::Saturate => self.simplified_saturate(a),
            Unary::Length => self.simplified_length(a),
            Unary::Not => self.simplified_not(a),
            Unary::Sqrt => self.simplified_sqrt(a),
            Unary::Log | Unary::Log2 => self.simplified_log(op, a),
            Unary::Sin | Unary::Tan | Unary::Asin | Unary::Atan | Unary::Sinh | Unary::Tanh => {
                let inner = self.as_neg(a)?;
                let mirrored = self.unary(op, inner);
                Some(self.neg(mirrored))
            }
            Unary::Cos | Unary::Cosh => {
                let inner = self.as_neg(a)?;
                Some(self.unary(op, inner))
            }
            Unary::Floor | Unary::Ceil | Unary::Round | Unary::Trunc => {
                self.is_whole(a).then_some(a)
            }
            Unary::Sign
            | Unary::Fract
            | Unary::InverseSqrt
            | Unary::Exp
            | Unary::Exp2
            | Unary::Acos
            | Unary::Normalize => None,
        }
    }

    fn simplified_binary(&mut self, op: Binary, a: NodeId, b: NodeId) -> Option<NodeId> {
        if self.ty(a).width() > 1
            && is_lanewise(op)
            && let Some((x, y)) = self.both_splat(a, b)
        {
            let result = self.binary(op, x, y);
            return Some(self.splat(self.ty(a), result));
        }
        match op {
            Binary::Add => self.simplified_add(a, b),
            Binary::Sub => self.simplified_sub(a, b),
            Binary::Mul => self.simplified_mul(a, b),
            Binary::Div => self.simplified_div(a, b),
            Binary::Min => self.simplified_min(a, b),
            Binary::Max => self.simplified_max(a, b),
            Binary::Pow => self.simplified_pow(a, b),
            Binary::Step => self.simplified_step(a, b),
            Binary::Dot => self.simplified_dot(a, b),
            Binary::Cross => self.simplified_cross(a, b),
            Binary::Lt => self.simplified_lt(a, b),
            Binary::Le => self.simplified_le(a, b),
            Binary::Eq | Binary::Ne => self.simplified_equality(op, a, b),
            Binary::And | Binary::Or => self.simplified_connective(op, a, b),
            Binary::Alternative => (a == b).then_some(b),
            Binary::Rem | Binary::Atan2 | Binary::Hash => None,
        }
    }

    fn simplified_ternary(&mut self, op: Ternary, [a, b, c]: [NodeId; 3]) -> Option<NodeId> {
        match op {
            Ternary::Mix => self.simplified_mix(a, b, c),
            Ternary::Clamp => self.simplified_clamp(a, b, c),
            Ternary::Select => self.simplified_select(a, b, c),
            Ternary::Smoothstep => None,
        }
    }
}

/// Views of nodes that the rules match on.
impl Graph {
    /// True if the node does not depend on the point.
    fn is_low(&self, id: NodeId) -> bool {
        self.stage(id) < Stage::Point
    }

    fn is_uniform(&self, id: NodeId, value: f64) -> bool {
        self.as_splat_number(id) == Some(value)
    }

    fn is_whole(&self, id: NodeId) -> bool {
        match self.node(id) {
            Node::Unary(op, _) => {
                matches!(op, Unary::Floor | Unary::Ceil | Unary::Round | Unary::Trunc | Unary::Sign)
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => false,
            Node::Variable(_, var, _) => var == LoopVar::Index,
        }
    }

    fn as_unary(&self, op: Unary, id: NodeId) -> Option<NodeId> {
        if let Node::Unary(own, a) = self.node(id) { (own == op).then_some(a) } else { None }
    }

    fn as_neg(&self, id: NodeId) -> Option<NodeId> {
        self.as_unary(Unary::Neg, id)
    }

    fn as_binary(&self, op: Binary, id: NodeId) -> Option<(NodeId, NodeId)> {
        if let Node::Binary(own, a, b) = self.node(id) {
            (own == op).then_some((a, b))
        } else {
            None
        }
    }

    fn as_select(&self, id: NodeId) -> Option<[NodeId; 3]> {
        if let Node::Ternary(Ternary::Select, arguments) = self.node(id) {
            Some(arguments)
        } else {
            None
        }
    }

    /// The scalar that a `Splat` repeats.
    fn as_splat(&self, id: NodeId) -> Option<NodeId> {
        if let Node::Splat(_, a) = self.node(id) { Some(a) } else { None }
    }

    /// The scalar that all lanes equal, for a `Splat` or a constant; a scalar itself.
    fn as_equal_lanes(&mut self, id: NodeId) -> Option<NodeId> {
        if self.ty(id).width() == 1 {
            return Some(id);
        }
        let constant = self.as_splat_number(id).map(|value| self.number(value));
        constant.or_else(|| self.as_splat(id))
    }

    /// The scalars of two vectors with equal lanes, at least one of them not constant.
    fn both_splat(&mut self, a: NodeId, b: NodeId) -> Option<(NodeId, NodeId)> {
        self.as_splat(a).or(self.as_splat(b))?;
        self.as_equal_lanes(a).zip(self.as_equal_lanes(b))
    }

    /// `(x, f)` for a node `x + f`, where f does not depend on the point.
    fn as_offset(&mut self, id: NodeId) -> Option<(NodeId, NodeId)> {
        if let Some((x, f)) = self.as_binary(Binary::Add, id) {
            return self.is_low(f).then_some((x, f));
        }
        let (x, f) = self.as_binary(Binary::Sub, id).filter(|&(_, f)| self.is_low(f))?;
        Some((x, self.neg(f)))
    }

    /// `(x, f)` for a node `x * f`, where f does not depend on the point.
    fn as_scaled(&self, id: NodeId) -> Option<(NodeId, NodeId)> {
        self.as_binary(Binary::Mul, id).filter(|&(_, f)| self.is_low(f))
    }

    /// The negative of a node, if it takes no further operation per point.
    fn free_negative(&mut self, id: NodeId) -> Option<NodeId> {
        if self.is_low(id) {
            return self.as_const(id).map(|_| self.neg(id));
        }
        let free = self.as_neg(id).is_some()
            || self.as_binary(Binary::Sub, id).is_some()
            || self.as_offset(id).is_some()
            || self.as_scaled(id).is_some();
        free.then(|| self.neg(id))
    }

    fn zero_like(&mut self, id: NodeId) -> NodeId {
        let ty = self.ty(id);
        self.constant(ty, &[0.0; 4])
    }

    fn one_like(&mut self, id: NodeId) -> NodeId {
        let ty = self.ty(id);
        self.constant(ty, &[1.0; 4])
    }
}

/// True if the operation acts on each component separately.
fn is_componentwise(op: Unary) -> bool {
    match op {
        Unary::Length | Unary::Normalize => false,
        Unary::Neg
        | Unary::Abs
        | Unary::Sign
        | Unary::Floor
        | Unary::Ceil
        | Unary::Round
        | Unary::Trunc
        | Unary::Fract
        | Unary::Sqrt
        | Unary::InverseSqrt
        | Unary::Exp
        | Unary::Exp2
        | Unary::Log
        | Unary::Log2
        | Unary::Sin
        | Unary::Cos
        | Unary::Tan
        | Unary::Asin
        | Unary::Acos
        | Unary::Atan
        | Unary::Sinh
        | Unary::Cosh
        | Unary::Tanh
        | Unary::Saturate
        | Unary::Not => true,
    }
}

/// True if the operation acts on each pair of components separately.
fn is_lanewise(op: Binary) -> bool {
    match op {
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
        | Binary::Alternative => true,
        Binary::Dot
        | Binary::Cross
        | Binary::Lt
        | Binary::Le
        | Binary::Eq
        | Binary::Ne
        | Binary::And
        | Binary::Or => false,
    }
}

/// The lanes of a constant within its width.
fn lanes(value: &Const) -> Vec<f64> {
    value.lanes()[..value.ty().width()].to_vec()
}

fn is_truth(ty: Type) -> bool {
    ty == Type::Bool
}
