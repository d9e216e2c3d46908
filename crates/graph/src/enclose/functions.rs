//! What each operation makes of its arguments' extents: one exhaustive match for each arity.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::Enclosing;
use super::extent::{COARSE, Extent, LARGE, ROUNDING, Span, TINY};
use crate::eval::HASHES;
use crate::{Binary, NodeId, Ternary, Type, Unary};

/// What devices may be off by in the sine, the cosine and the arcs of angles and ratios of ordinary size.
const ANGLE: f64 = 1.0 / 65_536.0;
/// Slack in turns when crests of a wave are looked for.
const TURN: f64 = 1.0 / 16_384.0;
/// e to the power of so much is more than twice [`LARGE`].
const LARGEST_POWER: f64 = 36.0;

impl Enclosing<'_> {
    pub(super) fn unary(&mut self, op: Unary, x: Extent) -> Extent {
        if let Extent::Fixed(value) = x {
            return Extent::Fixed(self.graph.unary(op, value));
        }
        match op {
            Unary::Neg => self.negative(x),
            Unary::Abs => self.magnitudes(x),
            Unary::Sign | Unary::Floor | Unary::Ceil | Unary::Round | Unary::Trunc => {
                let x = self.span(x);
                self.monotone(op, x).into()
            }
            Unary::Saturate => {
                let x = self.span(x);
                Span { wild: false, ..self.monotone(op, x) }.into()
            }
            Unary::Fract => self.by_lane([x], |s, [x]| s.fraction(x)),
            Unary::Sqrt => {
                let x = self.span(x);
                let (lo, hi) = (self.above_zero(x.lo), self.above_zero(x.hi));
                let x = Span { lo, hi, ..x };
                let root = self.monotone(op, x);
                let root = self.widened(root, COARSE);
                self.endless_as(root, &[x]).into()
            }
            Unary::InverseSqrt => {
                let x = self.span(x);
                let (lo, hi) = (self.at_least(x.hi, TINY), self.at_least(x.lo, TINY));
                let result = self.monotone(op, Span::new(lo, hi));
                let result = self.widened(result, COARSE);
                let result = self.endless_below(result, x);
                self.cut(result).into()
            }
            Unary::Exp => self.power_of(op, x, LARGEST_POWER),
            Unary::Exp2 => self.power_of(op, x, LARGEST_POWER / std::f64::consts::LN_2),
            Unary::Log | Unary::Log2 => self.by_lane([x], |s, [x]| s.logarithm(op, x)),
            Unary::Sin => self.by_lane([x], |s, [x]| s.wave(op, x, FRAC_PI_2, -FRAC_PI_2)),
            Unary::Cos => self.by_lane([x], |s, [x]| s.wave(op, x, 0.0, PI)),
            Unary::Tan => self.by_lane([x], |s, [x]| s.tangent(x)),
            Unary::Asin => self.arc(op, x),
            Unary::Acos => {
                let x = self.negative(x);
                let rest = self.arc(Unary::Asin, x);
                let quarter = self.entire(self.ty(x)).lo;
                let quarter = self.number_like(quarter, FRAC_PI_2);
                self.sum(Extent::Fixed(quarter), rest)
            }
            Unary::Atan | Unary::Tanh => {
                let x = self.span(x);
                let result = self.monotone(op, Span { wild: false, ..x });
                self.grown_by(result, ANGLE).into()
            }
            Unary::Sinh => self.hyperbolic(op, x),
            Unary::Cosh => {
                let x = self.magnitudes(x);
                self.hyperbolic(op, x)
            }
            Unary::Length => self.length(x),
            Unary::Normalize => self.direction(x),
            Unary::Not => {
                let Span { lo, hi, .. } = self.span(x);
                let ends = [hi, lo].map(|end| self.graph.unary(op, end));
                Span::new(ends[0], ends[1]).into()
            }
        }
    }

    pub(super) fn binary(&mut self, op: Binary, x: Extent, y: Extent) -> Extent {
        if let (Extent::Fixed(x), Extent::Fixed(y)) = (x, y) {
            return Extent::Fixed(self.graph.binary(op, x, y));
        }
        match op {
            Binary::Add => self.sum(x, y),
            Binary::Sub => self.difference(x, y),
            Binary::Mul => self.product(x, y),
            Binary::Div => self.quotient(x, y),
            Binary::Rem => self.remainder(x, y),
            Binary::Min | Binary::Max | Binary::And | Binary::Or => {
                let (x, y) = (self.span(x), self.span(y));
                self.monotone2(op, x, y).into()
            }
            Binary::Pow => self.by_lane([x, y], |s, [x, y]| s.power(x, y)),
            Binary::Atan2 => self.by_lane([x, y], |s, [y, x]| s.angle(y, x)),
            Binary::Step => {
                let (edge, x) = (self.span(x), self.span(y));
                let edge = Span { lo: edge.hi, hi: edge.lo, wild: false };
                self.monotone2(op, edge, Span { wild: false, ..x }).into()
            }
            Binary::Hash => self.by_lane([x, y], |s, [state, x]| s.hash(state, x)),
            Binary::Dot => self.dot(x, y),
            Binary::Cross => self.cross(x, y),
            Binary::Lt | Binary::Le => {
                let (x, y) = (self.span(x), self.span(y));
                let certain = self.graph.binary(op, x.hi, y.lo);
                Span::new(certain, self.graph.binary(op, x.lo, y.hi)).into()
            }
            Binary::Eq => self.equal(x, y),
            Binary::Ne => {
                let equal = self.equal(x, y);
                self.unary(Unary::Not, equal)
            }
        }
    }

    pub(super) fn ternary(&mut self, op: Ternary, [x, y, z]: [Extent; 3]) -> Extent {
        if let (Extent::Fixed(x), Extent::Fixed(y), Extent::Fixed(z)) = (x, y, z) {
            return Extent::Fixed(match op {
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
                let t = self.place_between(x, y, z);
                self.eased(t)
            }
            Ternary::Select => {
                if let (Extent::Fixed(choice), Some([yes, no])) = (x, self.lines([y, z])) {
                    let of = |s: &mut Self, yes, no| s.graph.select(choice, yes, no);
                    let ends = [0, 1].map(|end| of(self, yes.ends[end], no.ends[end]));
                    let size = of(self, yes.size, no.size);
                    return Extent::Line(super::extent::Line { ends, size });
                }
                let (truth, yes, no) = (self.span(x), self.span(y), self.span(z));
                self.chosen(truth, yes, no).into()
            }
        }
    }

    fn fraction(&mut self, x: Extent) -> Span {
        let x = self.span(x);
        let first = self.graph.unary(Unary::Floor, x.lo);
        let last = self.graph.unary(Unary::Floor, x.hi);
        let same = self.graph.binary(Binary::Eq, first, last);
        let moved = Span::new(self.graph.sub(x.lo, first), self.graph.sub(x.hi, first));
        let unit = self.between(x.lo, 0.0, 1.0);
        self.chosen(Span::new(same, same), moved, unit)
    }

    /// The argument is drawn out by what the device may be off by.
    fn power_of(&mut self, op: Unary, x: Extent, largest: f64) -> Extent {
        let x = self.span(x);
        let x = Span { lo: self.at_most(x.lo, largest), hi: self.at_most(x.hi, largest), ..x };
        let x = self.widened(x, 4.0 * ROUNDING);
        let x = self.grown_by(x, 4.0 * ROUNDING);
        Span { wild: true, ..self.monotone(op, x) }.into()
    }

    fn logarithm(&mut self, op: Unary, x: Extent) -> Span {
        let x = self.span(x);
        let ends = Span { lo: self.at_least(x.lo, TINY), hi: self.at_least(x.hi, TINY), ..x };
        let result = self.monotone(op, ends);
        let result = self.widened(result, COARSE);
        let result = self.grown_by(result, 4.0 * ROUNDING);
        let (tiny, least) = (self.graph.number(TINY), self.graph.number(-LARGE));
        let meets_zero = self.graph.le(x.lo, tiny);
        let result = Span::wild(self.graph.select(meets_zero, least, result.lo), result.hi);
        self.endless_as(result, &[Span { lo: ends.lo, ..x }])
    }

    /// A function of period 2π that falls from 1 at `crest` to -1 at `trough`.
    fn wave(&mut self, op: Unary, x: Extent, crest: f64, trough: f64) -> Span {
        let x = self.span(x);
        let size = self.magnitude(x);
        let slack = self.scaled(size, 4.0 * ROUNDING);
        let slack = self.offset(slack, TURN);
        let turns = [x.lo, x.hi].map(|end| self.scaled(end, 1.0 / TAU));
        let turns = self.grown(Span::new(turns[0], turns[1]), slack);
        let [crests, troughs] = [crest, trough].map(|place| {
            let ends = [turns.lo, turns.hi].map(|end| self.offset(end, -place / TAU));
            let last = self.graph.unary(Unary::Floor, ends[1]);
            self.graph.le(ends[0], last)
        });
        let ends = [x.lo, x.hi].map(|end| self.graph.unary(op, end));
        let margin = self.scaled(size, ROUNDING);
        let margin = self.offset(margin, ANGLE);
        let between = self.around(&ends);
        let between = self.grown(between, margin);
        let between = self.clipped(between, -1.0, 1.0);
        let (least, most) = (self.graph.number(-1.0), self.graph.number(1.0));
        let lo = self.graph.select(troughs, least, between.lo);
        Span::new(lo, self.graph.select(crests, most, between.hi))
    }

    fn tangent(&mut self, x: Extent) -> Span {
        let x = self.span(x);
        let ends = [x.lo, x.hi].map(|end| {
            let half_turns = self.scaled(end, 1.0 / PI);
            self.offset(half_turns, 0.5)
        });
        let turns = self.grown_by(Span::new(ends[0], ends[1]), TURN);
        let [first, last] = [turns.lo, turns.hi].map(|end| self.graph.unary(Unary::Floor, end));
        let same = self.graph.binary(Binary::Eq, first, last);
        let result = self.monotone(Unary::Tan, Span::wild(x.lo, x.hi));
        let result = self.widened(result, ANGLE);
        let result = self.grown_by(result, ANGLE);
        let result = self.cut(result);
        let entire = self.entire(Type::Scalar);
        self.chosen(Span::new(same, same), result, entire)
    }

    fn arc(&mut self, op: Unary, x: Extent) -> Extent {
        let x = self.span(x);
        let x = self.clipped(x, -1.0, 1.0);
        let result = self.monotone(op, x);
        // Steep at the ends, where rounding of the argument shows.
        self.grown_by(result, 64.0 * ANGLE).into()
    }

    fn hyperbolic(&mut self, op: Unary, x: Extent) -> Extent {
        let x = self.span(x);
        let x = self.clipped(x, -LARGEST_POWER, LARGEST_POWER);
        let result = self.monotone(op, x);
        let result = self.widened(result, ANGLE);
        Span { wild: true, ..self.grown_by(result, ANGLE) }.into()
    }

    /// Monotonic in the base and in the exponent apart, so the extremes are at corners. Bases below 0 are not defined.
    fn power(&mut self, x: Extent, y: Extent) -> Span {
        let (x, y) = (self.span(x), self.span(y));
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
        let result = self.around(&corners);
        let result = self.clipped(result, 0.0, LARGE);
        let result = Span { wild: true, ..self.widened(result, ANGLE) };
        let mut result = self.endless_as(result, &[Span { lo: bases[0], hi: bases[1], ..x }]);
        if !rises {
            result = self.endless_below(result, x);
            // 0 to a positive power is 0, which what stands for 0 is not.
            let (tiny, nought) = (self.graph.number(TINY), self.graph.number(0.0));
            let meets_zero = self.graph.le(x.lo, tiny);
            result.lo = self.graph.select(meets_zero, nought, result.lo);
        }
        result
    }

    /// `atan2(y, x)`: a box that keeps off the origin and off the cut along negative x is seen under the angles
    /// between its corners.
    fn angle(&mut self, y: Extent, x: Extent) -> Span {
        let (y, x) = (self.span(y), self.span(x));
        let cut = self.meets_cut(y, x);
        let mut corner = |y, x| self.graph.binary(Binary::Atan2, y, x);
        let corners =
            [corner(y.lo, x.lo), corner(y.lo, x.hi), corner(y.hi, x.lo), corner(y.hi, x.hi)];
        let result = self.around(&corners);
        let result = self.grown_by(result, ANGLE);
        let turn = self.between(y.lo, -PI - ANGLE, PI + ANGLE);
        self.chosen(Span::new(cut, cut), turn, result)
    }

    /// Whether a box may hold the origin or a part of the negative x axis.
    pub(super) fn meets_cut(&mut self, y: Span, x: Span) -> NodeId {
        let nought = self.graph.number(0.0);
        let low = self.graph.le(y.lo, nought);
        let high = self.graph.le(nought, y.hi);
        let left = self.graph.le(x.lo, nought);
        let both = self.graph.binary(Binary::And, low, high);
        self.graph.binary(Binary::And, both, left)
    }

    fn hash(&mut self, state: Extent, x: Extent) -> Span {
        let (state, x) = (self.span(state), self.span(x));
        let first = self.graph.unary(Unary::Floor, x.lo);
        let last = self.graph.unary(Unary::Floor, x.hi);
        let same_state = self.graph.binary(Binary::Eq, state.lo, state.hi);
        let same_place = self.graph.binary(Binary::Eq, first, last);
        let same = self.graph.binary(Binary::And, same_state, same_place);
        let value = self.graph.binary(Binary::Hash, state.lo, x.lo);
        let any = self.between(x.lo, 0.0, HASHES - 1.0);
        self.chosen(Span::new(same, same), Span::new(value, value), any)
    }

    fn equal(&mut self, x: Extent, y: Extent) -> Extent {
        let (x, y) = (self.span(x), self.span(y));
        if self.graph.ty(x.lo) == Type::Bool {
            let certain = self.both_or_neither([x.lo, y.lo], [x.hi, y.hi]);
            return Span::new(certain, self.both_or_neither([x.hi, y.hi], [x.lo, y.lo])).into();
        }
        let (below, above) = (self.graph.le(x.lo, y.hi), self.graph.le(y.lo, x.hi));
        let possible = self.graph.binary(Binary::And, below, above);
        let (below, above) = (self.graph.le(x.hi, y.lo), self.graph.le(y.hi, x.lo));
        Span::new(self.graph.binary(Binary::And, below, above), possible).into()
    }

    /// Whether two truth values hold, or two others do not.
    fn both_or_neither(&mut self, [a, b]: [NodeId; 2], [c, d]: [NodeId; 2]) -> NodeId {
        let both = self.graph.binary(Binary::And, a, b);
        let (c, d) = (self.graph.unary(Unary::Not, c), self.graph.unary(Unary::Not, d));
        let neither = self.graph.binary(Binary::And, c, d);
        self.graph.binary(Binary::Or, both, neither)
    }

    /// Where z lies between two edges, from 0 to 1.
    pub(super) fn place_between(&mut self, low: Extent, high: Extent, z: Extent) -> Extent {
        let above = self.difference(z, low);
        let width = self.width_between(low, high);
        let place = self.quotient(above, width);
        self.unary(Unary::Saturate, place)
    }

    /// How far two edges are apart: what may be 0 is told as what spans it, so that it divides like that.
    pub(super) fn width_between(&mut self, low: Extent, high: Extent) -> Extent {
        let width = self.difference_of_rounded(high, low);
        if let Extent::Fixed(node) = width {
            let apart = |value: crate::Const| {
                value.lanes()[..value.ty().width()].iter().all(|&lane| lane != 0.0)
            };
            if self.graph.as_const(node).is_some_and(apart) {
                return width;
            }
        }
        self.span(width).into()
    }

    /// `t² (3 - 2 t)`, which rises from 0 to 1.
    fn eased(&mut self, t: Extent) -> Extent {
        let t = self.span(t);
        let ends = [t.lo, t.hi].map(|t| {
            let square = self.graph.mul(t, t);
            let twice = self.scaled(t, -2.0);
            let rest = self.offset(twice, 3.0);
            self.graph.mul(square, rest)
        });
        let result = self.grown_by(Span::new(ends[0], ends[1]), 4.0 * ROUNDING);
        self.clipped(result, 0.0, 1.0).into()
    }
}
