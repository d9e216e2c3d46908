//! Terms that derivative rules are built from.

use super::sweep::{Sweep, TINY, zero};
use crate::node::{Binary, NodeId, Unary};

impl Sweep<'_> {
    /// `adjoint * v / |v|`; 0 at 0. `length` is |v|.
    pub(super) fn direction(&mut self, adjoint: NodeId, length: NodeId, v: NodeId) -> NodeId {
        if self.graph.ty(v).width() == 1 {
            return self.signed_by(adjoint, v);
        }
        let inverse = self.inverse(length);
        let factor = self.graph.mul(adjoint, inverse);
        self.graph.mul(v, factor)
    }

    /// `1 / max(length, TINY)`
    pub(super) fn inverse(&mut self, length: NodeId) -> NodeId {
        let (tiny, one) = (self.graph.number(TINY), self.graph.number(1.0));
        let above = self.graph.max(length, tiny);
        self.graph.div(one, above)
    }

    /// `adjoint / (2 root)`; 0 where the root is 0.
    pub(super) fn half_over_root(&mut self, adjoint: NodeId, root: NodeId) -> NodeId {
        let tiny = self.number_like(root, TINY);
        let half = self.scaled(adjoint, 0.5);
        let above = self.graph.max(root, tiny);
        let part = self.graph.div(half, above);
        self.where_le(part, tiny, root)
    }

    pub(super) fn over_root_of_one_minus_square(&mut self, adjoint: NodeId, x: NodeId) -> NodeId {
        let square = self.graph.mul(x, x);
        let rest = self.one_minus(square);
        let tiny = self.number_like(x, TINY);
        let above = self.graph.max(rest, tiny);
        let root = self.graph.unary(Unary::Sqrt, above);
        self.graph.div(adjoint, root)
    }

    /// The adjoint where `x >= 0`, its negative elsewhere.
    pub(super) fn signed_by(&mut self, adjoint: NodeId, x: NodeId) -> NodeId {
        let zero = self.number_like(x, 0.0);
        if self.graph.ty(x).width() == 1 {
            let negative = self.graph.neg(adjoint);
            let condition = self.graph.le(zero, x);
            return self.graph.select(condition, adjoint, negative);
        }
        let mask = self.graph.binary(Binary::Step, zero, x);
        let twice = self.scaled(mask, 2.0);
        let sign = self.offset(twice, -1.0);
        self.graph.mul(adjoint, sign)
    }

    /// The contribution where `x <= y`, else 0; componentwise.
    pub(super) fn where_le(&mut self, part: NodeId, x: NodeId, y: NodeId) -> NodeId {
        if self.graph.ty(x).width() == 1 {
            let zero = self.zero_of(part);
            let condition = self.graph.le(x, y);
            return self.graph.select(condition, part, zero);
        }
        let mask = self.graph.binary(Binary::Step, x, y);
        self.graph.mul(part, mask)
    }

    /// 0 where `x <= y`, else the contribution; componentwise.
    pub(super) fn unless_le(&mut self, part: NodeId, x: NodeId, y: NodeId) -> NodeId {
        if self.graph.ty(x).width() == 1 {
            let zero = self.zero_of(part);
            let condition = self.graph.le(x, y);
            return self.graph.select(condition, zero, part);
        }
        let mask = self.graph.binary(Binary::Step, x, y);
        let opposite = self.one_minus(mask);
        self.graph.mul(part, opposite)
    }

    pub(super) fn times_function(
        &mut self,
        op: Unary,
        a: NodeId,
        adjoint: NodeId,
        factor: f64,
    ) -> NodeId {
        let slope = self.graph.unary(op, a);
        self.product(adjoint, slope, factor)
    }

    pub(super) fn product(&mut self, x: NodeId, y: NodeId, factor: f64) -> NodeId {
        let scaled = self.scaled(x, factor);
        self.graph.mul(scaled, y)
    }

    pub(super) fn scaled(&mut self, x: NodeId, factor: f64) -> NodeId {
        let factor = self.graph.number(factor);
        self.graph.mul(x, factor)
    }

    pub(super) fn offset(&mut self, x: NodeId, by: f64) -> NodeId {
        let by = self.graph.number(by);
        self.graph.add(x, by)
    }

    /// `1 - x`
    pub(super) fn one_minus(&mut self, x: NodeId) -> NodeId {
        let one = self.graph.number(1.0);
        self.graph.sub(one, x)
    }

    pub(super) fn sum_of_lanes(&mut self, v: NodeId) -> NodeId {
        let ones = self.number_like(v, 1.0);
        if self.graph.ty(v).width() == 1 { v } else { self.graph.dot(v, ones) }
    }

    pub(super) fn number_like(&mut self, id: NodeId, value: f64) -> NodeId {
        let ty = self.graph.ty(id);
        self.graph.constant(ty, &[value; 4])
    }

    pub(super) fn zero_of(&mut self, id: NodeId) -> NodeId {
        let ty = self.graph.ty(id);
        zero(self.graph, ty)
    }
}
