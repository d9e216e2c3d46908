//! The derivative rule of each operation: what a node passes on to its arguments.

use super::sweep::{Sweep, TINY};
use crate::node::{Binary, Node, NodeId, Ternary, Unary};

impl Sweep<'_> {
    /// Passes a node's adjoint on to its arguments.
    pub(super) fn propagate(&mut self, id: NodeId, adjoint: NodeId) {
        match self.graph.node(id) {
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Variable(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => {}
            Node::Loop(loop_, position, _) => self.propagate_loop(loop_, position, adjoint),
            Node::Unary(op, a) => {
                if self.live.contains(a) {
                    let part = self.unary(op, id, a, adjoint);
                    self.accumulate(a, part);
                }
            }
            Node::Binary(op, a, b) => self.binary(op, id, [a, b], adjoint),
            Node::Ternary(op, arguments) => self.ternary(op, arguments, adjoint),
            Node::Splat(_, a) => {
                let sum = self.sum_of_lanes(adjoint);
                self.accumulate(a, sum);
            }
            Node::Compose(ty, parts) => {
                for (lane, &part) in (0..).zip(&parts[..ty.width()]) {
                    let component = self.graph.component(adjoint, lane);
                    self.accumulate(part, component);
                }
            }
            Node::Swizzle(ty, a, lanes) => self.swizzle(a, &lanes[..ty.width()], adjoint),
            Node::Transform(columns, v) => self.transform(columns, v, adjoint),
        }
    }

    fn swizzle(&mut self, a: NodeId, lanes: &[u8], adjoint: NodeId) {
        let width = self.graph.ty(a).width();
        let source = |lane: usize| lanes.iter().position(|&from| usize::from(from) == lane);
        let back: Option<Vec<u8>> = (0..width).map(|lane| source(lane).map(|i| i as u8)).collect();
        if let Some(back) = back.filter(|_| lanes.len() == width) {
            let turned_back = self.graph.swizzle(adjoint, &back);
            return self.accumulate(a, turned_back);
        }
        for (i, &lane) in (0..).zip(lanes) {
            let component = self.graph.component(adjoint, i);
            self.accumulate_lane(a, lane, component);
        }
    }

    fn transform(&mut self, columns: [NodeId; 3], v: NodeId, adjoint: NodeId) {
        if self.live.contains(v) {
            let transposed = [0, 1, 2].map(|row| {
                let parts = columns.map(|column| self.graph.component(column, row));
                self.graph.compose(&parts)
            });
            let part = self.graph.transform(transposed, adjoint);
            self.accumulate(v, part);
        }
        for (lane, column) in (0..).zip(columns) {
            if self.live.contains(column) {
                let factor = self.graph.component(v, lane);
                let part = self.graph.mul(adjoint, factor);
                self.accumulate(column, part);
            }
        }
    }

    fn unary(&mut self, op: Unary, id: NodeId, a: NodeId, adjoint: NodeId) -> NodeId {
        match op {
            Unary::Neg => self.graph.neg(adjoint),
            Unary::Abs => self.signed_by(adjoint, a),
            Unary::Fract => adjoint,
            Unary::Sign | Unary::Floor | Unary::Ceil | Unary::Round | Unary::Trunc | Unary::Not => {
                self.zero_of(a)
            }
            Unary::Sqrt => self.half_over_root(adjoint, id),
            Unary::InverseSqrt => {
                let square = self.graph.mul(id, id);
                let cube = self.graph.mul(square, id);
                self.product(adjoint, cube, -0.5)
            }
            Unary::Exp => self.graph.mul(adjoint, id),
            Unary::Exp2 => self.product(adjoint, id, std::f64::consts::LN_2),
            Unary::Log => self.graph.div(adjoint, a),
            Unary::Log2 => {
                let slope = self.graph.div(adjoint, a);
                self.scaled(slope, std::f64::consts::LOG2_E)
            }
            Unary::Sin => self.times_function(Unary::Cos, a, adjoint, 1.0),
            Unary::Cos => self.times_function(Unary::Sin, a, adjoint, -1.0),
            Unary::Tan => {
                let square = self.graph.mul(id, id);
                let slope = self.offset(square, 1.0);
                self.graph.mul(adjoint, slope)
            }
            Unary::Asin => self.over_root_of_one_minus_square(adjoint, a),
            Unary::Acos => {
                let part = self.over_root_of_one_minus_square(adjoint, a);
                self.graph.neg(part)
            }
            Unary::Atan => {
                let square = self.graph.mul(a, a);
                let divisor = self.offset(square, 1.0);
                self.graph.div(adjoint, divisor)
            }
            Unary::Sinh => self.times_function(Unary::Cosh, a, adjoint, 1.0),
            Unary::Cosh => self.times_function(Unary::Sinh, a, adjoint, 1.0),
            Unary::Tanh => {
                let square = self.graph.mul(id, id);
                let slope = self.one_minus(square);
                self.graph.mul(adjoint, slope)
            }
            Unary::Saturate => {
                let (zero, one) = (self.number_like(a, 0.0), self.number_like(a, 1.0));
                let below = self.where_le(adjoint, a, one);
                self.where_le(below, zero, a)
            }
            Unary::Length => self.direction(adjoint, id, a),
            Unary::Normalize => {
                let along = self.graph.dot(id, adjoint);
                let radial = self.graph.mul(id, along);
                let across = self.graph.sub(adjoint, radial);
                let length = self.graph.length(a);
                let inverse = self.inverse(length);
                self.graph.mul(across, inverse)
            }
        }
    }

    fn binary(&mut self, op: Binary, id: NodeId, [a, b]: [NodeId; 2], adjoint: NodeId) {
        match op {
            Binary::Add => {
                self.accumulate(a, adjoint);
                self.accumulate(b, adjoint);
            }
            Binary::Sub => {
                self.accumulate(a, adjoint);
                self.accumulate_with(b, |s| s.graph.neg(adjoint));
            }
            Binary::Mul if a == b => self.accumulate_with(a, |s| s.product(adjoint, a, 2.0)),
            Binary::Mul => {
                self.accumulate_with(a, |s| s.graph.mul(adjoint, b));
                self.accumulate_with(b, |s| s.graph.mul(adjoint, a));
            }
            Binary::Div => {
                self.accumulate_with(a, |s| s.graph.div(adjoint, b));
                self.accumulate_with(b, |s| {
                    let slope = s.graph.div(id, b);
                    s.product(adjoint, slope, -1.0)
                });
            }
            Binary::Rem => {
                self.accumulate(a, adjoint);
                self.accumulate_with(b, |s| {
                    let quotient = s.graph.div(a, b);
                    let whole = s.graph.unary(Unary::Floor, quotient);
                    s.product(adjoint, whole, -1.0)
                });
            }
            Binary::Min => self.selection([a, b], [a, b], id, adjoint),
            Binary::Max => self.selection([a, b], [b, a], id, adjoint),
            Binary::Alternative => self.accumulate(b, adjoint),
            Binary::Pow => self.power(id, [a, b], adjoint),
            Binary::Atan2 => self.angle([a, b], adjoint),
            Binary::Dot if a == b => self.accumulate_with(a, |s| {
                let twice = s.scaled(adjoint, 2.0);
                s.graph.mul(a, twice)
            }),
            Binary::Dot => {
                self.accumulate_with(a, |s| s.graph.mul(b, adjoint));
                self.accumulate_with(b, |s| s.graph.mul(a, adjoint));
            }
            Binary::Cross => {
                self.accumulate_with(a, |s| s.graph.binary(Binary::Cross, b, adjoint));
                self.accumulate_with(b, |s| s.graph.binary(Binary::Cross, adjoint, a));
            }
            Binary::Step
            | Binary::Hash
            | Binary::Lt
            | Binary::Le
            | Binary::Eq
            | Binary::Ne
            | Binary::And
            | Binary::Or => {}
        }
    }

    fn ternary(&mut self, op: Ternary, [a, b, c]: [NodeId; 3], adjoint: NodeId) {
        match op {
            Ternary::Mix => {
                self.accumulate_with(a, |s| {
                    let weight = s.one_minus(c);
                    s.graph.mul(adjoint, weight)
                });
                self.accumulate_with(b, |s| s.graph.mul(adjoint, c));
                self.accumulate_with(c, |s| {
                    let difference = s.graph.sub(b, a);
                    s.graph.mul(adjoint, difference)
                });
            }
            Ternary::Clamp => {
                // min(max(x, lo), hi)
                let raised = self.graph.max(a, b);
                let kept = self.where_le(adjoint, raised, c);
                self.accumulate_with(a, |s| s.where_le(kept, b, a));
                self.accumulate_with(b, |s| s.unless_le(kept, b, a));
                self.accumulate_with(c, |s| s.unless_le(adjoint, raised, c));
            }
            Ternary::Smoothstep => self.smoothstep([a, b, c], adjoint),
            Ternary::Select => {
                self.accumulate_with(b, |s| {
                    let zero = s.zero_of(adjoint);
                    s.graph.select(a, adjoint, zero)
                });
                self.accumulate_with(c, |s| {
                    let zero = s.zero_of(adjoint);
                    s.graph.select(a, zero, adjoint)
                });
            }
        }
    }

    /// Passes the adjoint to the first argument where `lesser <= greater`, else to the second.
    fn selection(
        &mut self,
        [first, second]: [NodeId; 2],
        [lesser, greater]: [NodeId; 2],
        id: NodeId,
        adjoint: NodeId,
    ) {
        // Where the other argument is 0, a factor of the adjoint that equals the selected value is
        // 0 wherever this argument is not selected, so no mask is needed.
        let masked = self.has_factor(adjoint, id);
        let plain = |s: &Self, other: NodeId| masked && s.is_zero(other);
        if plain(self, second) {
            self.accumulate(first, adjoint);
        } else {
            self.accumulate_with(first, |s| s.where_le(adjoint, lesser, greater));
        }
        if plain(self, first) {
            self.accumulate(second, adjoint);
        } else {
            self.accumulate_with(second, |s| s.unless_le(adjoint, lesser, greater));
        }
    }

    fn has_factor(&self, product: NodeId, factor: NodeId) -> bool {
        let mut pending = vec![product];
        for _ in 0..8 {
            let Some(id) = pending.pop() else { return false };
            if id == factor {
                return true;
            }
            if let Node::Binary(Binary::Mul, a, b) = self.graph.node(id) {
                pending.extend([a, b]);
            }
        }
        false
    }

    /// `x^y`: the derivatives are `y x^y / x` and `x^y log x`, where x is kept away from 0.
    fn power(&mut self, id: NodeId, [x, y]: [NodeId; 2], adjoint: NodeId) {
        let tiny = self.number_like(x, TINY);
        self.accumulate_with(x, |s| {
            let above = s.graph.max(x, tiny);
            let ratio = s.graph.div(id, above);
            let slope = s.graph.mul(y, ratio);
            s.graph.mul(adjoint, slope)
        });
        self.accumulate_with(y, |s| {
            let above = s.graph.max(x, tiny);
            let log = s.graph.unary(Unary::Log, above);
            let slope = s.graph.mul(id, log);
            s.graph.mul(adjoint, slope)
        });
    }

    /// The derivative of the angle of `[x, y]`: `(x dy - y dx) / (x² + y²)`.
    fn angle(&mut self, [y, x]: [NodeId; 2], adjoint: NodeId) {
        let (xx, yy) = (self.graph.mul(x, x), self.graph.mul(y, y));
        let sum = self.graph.add(xx, yy);
        let floor = self.number_like(sum, TINY * TINY);
        let square = self.graph.max(sum, floor);
        let scale = self.graph.div(adjoint, square);
        self.accumulate_with(y, |s| s.graph.mul(x, scale));
        self.accumulate_with(x, |s| s.product(y, scale, -1.0));
    }

    /// With t = saturate((x - lo) / (hi - lo)): 6 t (1 - t) / (hi - lo), times t - 1 for lo and -t
    /// for hi.
    fn smoothstep(&mut self, [lo, hi, x]: [NodeId; 3], adjoint: NodeId) {
        let span = self.graph.sub(hi, lo);
        let above = self.graph.sub(x, lo);
        let ratio = self.graph.div(above, span);
        let t = self.graph.unary(Unary::Saturate, ratio);
        let rest = self.one_minus(t);
        let bump = self.product(t, rest, 6.0);
        let slope = self.graph.div(bump, span);
        let part = self.graph.mul(adjoint, slope);
        self.accumulate(x, part);
        self.accumulate_with(lo, |s| s.product(part, rest, -1.0));
        self.accumulate_with(hi, |s| s.product(part, t, -1.0));
    }
}
