//! Bounds of each operation, given its arguments' bounds: one exhaustive match per arity.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::encloser::Encloser;
use super::values::{COARSE, Interval, LARGE, ROUNDING, TINY, Values};
use crate::eval::HASH_COUNT;
use crate::node::{Binary, NodeId, Ternary, Type, Unary};
use crate::simplify::function::{SoftExtreme, SoftKind};

/// Error of devices in sine, cosine and the inverse trigonometric functions for arguments of
/// ordinary size.
const ANGLE: f64 = 1.0 / 65_536.0;
/// Error of devices in `log(1 + exp(-x))`.
const SOFT: f64 = 1.0 / 262_144.0;
/// Slack, in periods, when looking for the maxima and minima of sine and cosine.
const PERIOD_SLACK: f64 = 1.0 / 16_384.0;
/// e to this power exceeds twice [`LARGE`].
const LARGEST_POWER: f64 = 36.0;

impl Encloser<'_> {
    pub(super) fn unary(&mut self, op: Unary, x: Values) -> Values {
        if let Values::Constant(value) = x {
            return Values::Constant(self.graph.unary(op, value));
        }
        match op {
            Unary::Neg => self.negative(x),
            Unary::Abs => self.magnitudes(x),
            Unary::Sign | Unary::Floor | Unary::Ceil | Unary::Round | Unary::Trunc => {
                let x = self.interval(x);
                self.monotone(op, x).into()
            }
            Unary::Saturate => {
                let x = self.interval(x);
                Interval { may_overflow: false, ..self.monotone(op, x) }.into()
            }
            Unary::Fract => self.per_lane([x], |s, [x]| s.fraction(x)),
            Unary::Sqrt => {
                let x = self.interval(x);
                let (lo, hi) = (self.above_zero(x.lo), self.above_zero(x.hi));
                let x = Interval { lo, hi, ..x };
                let root = self.monotone(op, x);
                let root = self.widen_relative(root, COARSE);
                self.overflow_monotone(root, &[x]).into()
            }
            Unary::InverseSqrt => {
                let x = self.interval(x);
                let (lo, hi) = (self.at_least(x.hi, TINY), self.at_least(x.lo, TINY));
                let result = self.monotone(op, Interval::new(lo, hi));
                let result = self.widen_relative(result, COARSE);
                let result = self.overflow_reciprocal(result, x);
                self.clamp_to_large(result).into()
            }
            Unary::Exp => self.power_of(op, x, LARGEST_POWER),
            Unary::Exp2 => self.power_of(op, x, LARGEST_POWER / std::f64::consts::LN_2),
            Unary::Log | Unary::Log2 => self.per_lane([x], |s, [x]| s.logarithm(op, x)),
            Unary::Sin => self.per_lane([x], |s, [x]| s.sine_wave(op, x, FRAC_PI_2, -FRAC_PI_2)),
            Unary::Cos => self.per_lane([x], |s, [x]| s.sine_wave(op, x, 0.0, PI)),
            Unary::Tan => self.per_lane([x], |s, [x]| s.tangent(x)),
            Unary::Asin => self.inverse_sine(op, x),
            Unary::Acos => {
                let x = self.negative(x);
                let rest = self.inverse_sine(Unary::Asin, x);
                let quarter = self.entire(self.ty(x)).lo;
                let quarter = self.number_like(quarter, FRAC_PI_2);
                self.sum(Values::Constant(quarter), rest)
            }
            Unary::Atan | Unary::Tanh => {
                let x = self.interval(x);
                let result = self.monotone(op, Interval { may_overflow: false, ..x });
                self.expand_by(result, ANGLE).into()
            }
            Unary::Sinh => self.hyperbolic(op, x),
            Unary::Cosh => {
                let x = self.magnitudes(x);
                self.hyperbolic(op, x)
            }
            Unary::Length => self.length(x),
            Unary::Normalize => self.direction(x),
            Unary::Not => {
                let Interval { lo, hi, .. } = self.interval(x);
                let ends = [hi, lo].map(|end| self.graph.unary(op, end));
                Interval::new(ends[0], ends[1]).into()
            }
        }
    }

    pub(super) fn binary(&mut self, op: Binary, x: Values, y: Values) -> Values {
        if let (Values::Constant(x), Values::Constant(y)) = (x, y) {
            return Values::Constant(self.graph.binary(op, x, y));
        }
        match op {
            Binary::Add => self.sum(x, y),
            Binary::Sub => self.difference(x, y),
            Binary::Mul => self.product(x, y),
            Binary::Div => self.quotient(x, y),
            Binary::Rem => self.remainder(x, y),
            Binary::Min | Binary::Max | Binary::And | Binary::Or => {
                let (x, y) = (self.interval(x), self.interval(y));
                self.monotone2(op, x, y).into()
            }
            Binary::Alternative => y,
            Binary::Pow => self.per_lane([x, y], |s, [x, y]| s.power(x, y)),
            Binary::Atan2 => self.per_lane([x, y], |s, [y, x]| s.angle(y, x)),
            Binary::Step => {
                let (edge, x) = (self.interval(x), self.interval(y));
                let edge = Interval { lo: edge.hi, hi: edge.lo, may_overflow: false };
                self.monotone2(op, edge, Interval { may_overflow: false, ..x }).into()
            }
            Binary::Hash => self.per_lane([x, y], |s, [state, x]| s.hash(state, x)),
            Binary::Dot => self.dot(x, y),
            Binary::Cross => self.cross(x, y),
            Binary::Lt | Binary::Le => {
                let (x, y) = (self.interval(x), self.interval(y));
                let certain = self.graph.binary(op, x.hi, y.lo);
                Interval::new(certain, self.graph.binary(op, x.lo, y.hi)).into()
            }
            Binary::Eq => self.equal(x, y),
            Binary::Ne => {
                let equal = self.equal(x, y);
                self.unary(Unary::Not, equal)
            }
        }
    }

    pub(super) fn ternary(&mut self, op: Ternary, [x, y, z]: [Values; 3]) -> Values {
        if let (Values::Constant(x), Values::Constant(y), Values::Constant(z)) = (x, y, z) {
            return Values::Constant(match op {
                Ternary::Select => self.graph.select(x, y, z),
                Ternary::Mix | Ternary::Clamp | Ternary::Smoothstep => {
                    self.graph.ternary(op, x, y, z)
                }
            });
        }
        match op {
            Ternary::Mix => self.mixture(x, y, z),
            Ternary::Clamp => {
                let raised = self.binary(Binary::Max, x, y);
                self.binary(Binary::Min, raised, z)
            }
            Ternary::Smoothstep => {
                let t = self.position_between(x, y, z);
                self.smoothstep_of(t)
            }
            Ternary::Select => {
                if let (Values::Constant(choice), Some([yes, no])) = (x, self.affine_all([y, z])) {
                    let of = |s: &mut Self, yes, no| s.graph.select(choice, yes, no);
                    let ends = [0, 1].map(|end| of(self, yes.ends[end], no.ends[end]));
                    let size = of(self, yes.magnitude, no.magnitude);
                    return Values::Affine(super::values::Affine { ends, magnitude: size });
                }
                let (truth, yes, no) = (self.interval(x), self.interval(y), self.interval(z));
                self.select(truth, yes, no).into()
            }
        }
    }

    fn fraction(&mut self, x: Values) -> Interval {
        let x = self.interval(x);
        let first = self.graph.unary(Unary::Floor, x.lo);
        let last = self.graph.unary(Unary::Floor, x.hi);
        let same = self.graph.binary(Binary::Eq, first, last);
        let moved = Interval::new(self.graph.sub(x.lo, first), self.graph.sub(x.hi, first));
        let unit = self.between(x.lo, 0.0, 1.0);
        self.select(Interval::new(same, same), moved, unit)
    }

    /// The argument is widened by the error of the device.
    fn power_of(&mut self, op: Unary, x: Values, largest: f64) -> Values {
        let x = self.interval(x);
        let x = Interval { lo: self.at_most(x.lo, largest), hi: self.at_most(x.hi, largest), ..x };
        let x = self.widen_relative(x, 4.0 * ROUNDING);
        let x = self.expand_by(x, 4.0 * ROUNDING);
        Interval { may_overflow: true, ..self.monotone(op, x) }.into()
    }

    fn logarithm(&mut self, op: Unary, x: Values) -> Interval {
        let x = self.interval(x);
        let ends = Interval { lo: self.at_least(x.lo, TINY), hi: self.at_least(x.hi, TINY), ..x };
        let result = self.monotone(op, ends);
        let result = self.widen_relative(result, COARSE);
        let result = self.expand_by(result, 4.0 * ROUNDING);
        let (tiny, least) = (self.graph.number(TINY), self.graph.number(-LARGE));
        let meets_zero = self.graph.le(x.lo, tiny);
        let result =
            Interval::overflowing(self.graph.select(meets_zero, least, result.lo), result.hi);
        self.overflow_monotone(result, &[Interval { lo: ends.lo, ..x }])
    }

    /// Bounds a soft maximum or minimum, which increases or decreases with both operands.
    pub(super) fn soft_extreme(&mut self, id: NodeId) -> Option<Values> {
        let SoftExtreme { kind, op, operands } = self.graph.as_soft_extreme(id)?;
        let [x, y] = operands.map(|operand| self.known.get(operand));
        let [x, y] = [x?, y?].map(|known| self.interval(known.value));
        let hard = if kind == SoftKind::Max { Binary::Max } else { Binary::Min };
        let [lo, hi] = [[x.lo, y.lo], [x.hi, y.hi]].map(|[a, b]| {
            let (hard, gap) = (self.graph.binary(hard, a, b), self.graph.soft_gap(op, a, b));
            match kind {
                SoftKind::Max => self.graph.add(hard, gap),
                SoftKind::Min | SoftKind::NegatedMin => self.graph.sub(hard, gap),
            }
        });
        let result = Interval::new(lo, hi).with(&[x, y]);
        let result = self.widen_relative(result, 2.0 * COARSE);
        let result = self.expand_by(result, SOFT);
        let result = self.overflow_monotone(result, &[x, y]);
        Some(if kind == SoftKind::NegatedMin {
            self.negative(result.into())
        } else {
            result.into()
        })
    }

    /// Bounds sine or cosine: a function of period 2π that falls from 1 at `crest` to -1 at
    /// `trough`.
    fn sine_wave(&mut self, op: Unary, x: Values, crest: f64, trough: f64) -> Interval {
        let x = self.interval(x);
        let size = self.magnitude(x);
        let slack = self.scaled(size, 4.0 * ROUNDING);
        let slack = self.offset(slack, PERIOD_SLACK);
        let periods = [x.lo, x.hi].map(|end| self.scaled(end, 1.0 / TAU));
        let periods = self.expand(Interval::new(periods[0], periods[1]), slack);
        let [crests, troughs] = [crest, trough].map(|phase| {
            let ends = [periods.lo, periods.hi].map(|end| self.offset(end, -phase / TAU));
            let last = self.graph.unary(Unary::Floor, ends[1]);
            self.graph.le(ends[0], last)
        });
        let ends = [x.lo, x.hi].map(|end| self.graph.unary(op, end));
        let margin = self.scaled(size, ROUNDING);
        let margin = self.offset(margin, ANGLE);
        let between = self.hull_of(&ends);
        let between = self.expand(between, margin);
        let between = self.clamp(between, -1.0, 1.0);
        let (least, most) = (self.graph.number(-1.0), self.graph.number(1.0));
        let lo = self.graph.select(troughs, least, between.lo);
        Interval::new(lo, self.graph.select(crests, most, between.hi))
    }

    fn tangent(&mut self, x: Values) -> Interval {
        let x = self.interval(x);
        let ends = [x.lo, x.hi].map(|end| {
            let half_turns = self.scaled(end, 1.0 / PI);
            self.offset(half_turns, 0.5)
        });
        let periods = self.expand_by(Interval::new(ends[0], ends[1]), PERIOD_SLACK);
        let [first, last] = [periods.lo, periods.hi].map(|end| self.graph.unary(Unary::Floor, end));
        let same = self.graph.binary(Binary::Eq, first, last);
        let result = self.monotone(Unary::Tan, Interval::overflowing(x.lo, x.hi));
        let result = self.widen_relative(result, ANGLE);
        let result = self.expand_by(result, ANGLE);
        let result = self.clamp_to_large(result);
        let entire = self.entire(Type::Scalar);
        self.select(Interval::new(same, same), result, entire)
    }

    fn inverse_sine(&mut self, op: Unary, x: Values) -> Values {
        let x = self.interval(x);
        let x = self.clamp(x, -1.0, 1.0);
        let result = self.monotone(op, x);
        // The functions are steep at the ends, where rounding of the argument matters most.
        self.expand_by(result, 64.0 * ANGLE).into()
    }

    fn hyperbolic(&mut self, op: Unary, x: Values) -> Values {
        let x = self.interval(x);
        let x = self.clamp(x, -LARGEST_POWER, LARGEST_POWER);
        let result = self.monotone(op, x);
        let result = self.widen_relative(result, ANGLE);
        Interval { may_overflow: true, ..self.expand_by(result, ANGLE) }.into()
    }

    /// `x^y`, monotonic in the base and in the exponent separately, so the extremes are at corners.
    /// Undefined for bases below 0.
    fn power(&mut self, x: Values, y: Values) -> Interval {
        let (x, y) = (self.interval(x), self.interval(y));
        let rises = self.graph.range(y.lo).lo > 0.0;
        let bases = [x.lo, x.hi]
            .map(|end| if rises { self.above_zero(end) } else { self.at_least(end, TINY) });
        let mut corners = Vec::new();
        for base in bases {
            corners.push(self.graph.binary(Binary::Pow, base, y.lo));
            if y.hi != y.lo {
                corners.push(self.graph.binary(Binary::Pow, base, y.hi));
            }
        }
        let result = self.hull_of(&corners);
        let result = self.clamp(result, 0.0, LARGE);
        let result = Interval { may_overflow: true, ..self.widen_relative(result, ANGLE) };
        let mut result =
            self.overflow_monotone(result, &[Interval { lo: bases[0], hi: bases[1], ..x }]);
        if !rises {
            result = self.overflow_reciprocal(result, x);
            // 0 to a positive power is 0, but a positive power of [`TINY`], which stands for 0, is
            // not.
            let (tiny, zero) = (self.graph.number(TINY), self.graph.number(0.0));
            let meets_zero = self.graph.le(x.lo, tiny);
            result.lo = self.graph.select(meets_zero, zero, result.lo);
        }
        result
    }

    /// `atan2(y, x)`: the angles of a box that contains neither the origin nor a point of the
    /// branch cut along negative x lie between the angles of its corners.
    fn angle(&mut self, y: Values, x: Values) -> Interval {
        let (y, x) = (self.interval(y), self.interval(x));
        let cut = self.meets_branch_cut(y, x);
        let mut corner = |y, x| self.graph.binary(Binary::Atan2, y, x);
        let corners =
            [corner(y.lo, x.lo), corner(y.lo, x.hi), corner(y.hi, x.lo), corner(y.hi, x.hi)];
        let result = self.hull_of(&corners);
        let result = self.expand_by(result, ANGLE);
        let turn = self.between(y.lo, -PI - ANGLE, PI + ANGLE);
        self.select(Interval::new(cut, cut), turn, result)
    }

    /// True if a box may contain the origin or a point of the negative x axis.
    pub(super) fn meets_branch_cut(&mut self, y: Interval, x: Interval) -> NodeId {
        let zero = self.graph.number(0.0);
        let low = self.graph.le(y.lo, zero);
        let high = self.graph.le(zero, y.hi);
        let left = self.graph.le(x.lo, zero);
        let both = self.graph.binary(Binary::And, low, high);
        self.graph.binary(Binary::And, both, left)
    }

    fn hash(&mut self, state: Values, x: Values) -> Interval {
        let (state, x) = (self.interval(state), self.interval(x));
        let first = self.graph.unary(Unary::Floor, x.lo);
        let last = self.graph.unary(Unary::Floor, x.hi);
        let same_state = self.graph.binary(Binary::Eq, state.lo, state.hi);
        let same_input = self.graph.binary(Binary::Eq, first, last);
        let same = self.graph.binary(Binary::And, same_state, same_input);
        let value = self.graph.binary(Binary::Hash, state.lo, x.lo);
        let any = self.between(x.lo, 0.0, HASH_COUNT - 1.0);
        self.select(Interval::new(same, same), Interval::new(value, value), any)
    }

    fn equal(&mut self, x: Values, y: Values) -> Values {
        let (x, y) = (self.interval(x), self.interval(y));
        if self.graph.ty(x.lo) == Type::Bool {
            let certain = self.both_or_neither([x.lo, y.lo], [x.hi, y.hi]);
            return Interval::new(certain, self.both_or_neither([x.hi, y.hi], [x.lo, y.lo])).into();
        }
        let (below, above) = (self.graph.le(x.lo, y.hi), self.graph.le(y.lo, x.hi));
        let possible = self.graph.binary(Binary::And, below, above);
        let (below, above) = (self.graph.le(x.hi, y.lo), self.graph.le(y.hi, x.lo));
        Interval::new(self.graph.binary(Binary::And, below, above), possible).into()
    }

    /// True if the first two truth values are true, or the other two are false.
    fn both_or_neither(&mut self, [a, b]: [NodeId; 2], [c, d]: [NodeId; 2]) -> NodeId {
        let both = self.graph.binary(Binary::And, a, b);
        let (c, d) = (self.graph.unary(Unary::Not, c), self.graph.unary(Unary::Not, d));
        let neither = self.graph.binary(Binary::And, c, d);
        self.graph.binary(Binary::Or, both, neither)
    }

    /// The position of z between two edges, clamped to 0 to 1.
    pub(super) fn position_between(&mut self, low: Values, high: Values, z: Values) -> Values {
        let above = self.difference(z, low);
        let width = self.width_between(low, high);
        let position = self.quotient(above, width);
        self.unary(Unary::Saturate, position)
    }

    /// The distance between two edges. If it may be 0 it is returned as an interval that contains
    /// 0, so that division by it is bounded accordingly.
    pub(super) fn width_between(&mut self, low: Values, high: Values) -> Values {
        let width = self.difference_of_rounded(high, low);
        if let Values::Constant(node) = width {
            let nonzero = |value: crate::node::Const| {
                value.lanes()[..value.ty().width()].iter().all(|&lane| lane != 0.0)
            };
            if self.graph.as_const(node).is_some_and(nonzero) {
                return width;
            }
        }
        self.interval(width).into()
    }

    /// `t² (3 - 2 t)`, which increases from 0 to 1.
    fn smoothstep_of(&mut self, t: Values) -> Values {
        let t = self.interval(t);
        let ends = [t.lo, t.hi].map(|t| {
            let square = self.graph.mul(t, t);
            let twice = self.scaled(t, -2.0);
            let rest = self.offset(twice, 3.0);
            self.graph.mul(square, rest)
        });
        let result = self.expand_by(Interval::new(ends[0], ends[1]), 4.0 * ROUNDING);
        self.clamp(result, 0.0, 1.0).into()
    }
}
