//! Sums, products, quotients, remainders and mixtures.

use super::encloser::Encloser;
use super::values::{Affine, COARSE, Interval, LARGE, ROUNDING, TINY, Values};
use crate::graph::Graph;
use crate::node::{Binary, NodeId, Ternary, Type, Unary};

impl Encloser<'_> {
    pub(super) fn negative(&mut self, x: Values) -> Values {
        match x {
            Values::Constant(value) => Values::Constant(self.graph.neg(value)),
            Values::Affine(Affine { ends, magnitude: size }) => Values::Affine(Affine {
                ends: ends.map(|end| self.graph.neg(end)),
                magnitude: size,
            }),
            Values::Interval(Interval { lo, hi, may_overflow }) => {
                Interval { lo: self.graph.neg(hi), hi: self.graph.neg(lo), may_overflow }.into()
            }
        }
    }

    pub(super) fn magnitudes(&mut self, x: Values) -> Values {
        if let Values::Constant(value) = x {
            return Values::Constant(self.graph.abs(value));
        }
        let x = self.interval(x);
        let low = self.graph.neg(x.lo);
        let negated = self.graph.neg(x.hi);
        let apart = self.graph.max(x.lo, negated);
        Interval { lo: self.above_zero(apart), hi: self.graph.max(low, x.hi), ..x }.into()
    }

    pub(super) fn sum(&mut self, x: Values, y: Values) -> Values {
        if let (Values::Constant(x), Values::Constant(y)) = (x, y) {
            return Values::Constant(self.graph.add(x, y));
        }
        if let Some([x, y]) = self.affine_all([x, y]) {
            let ends = [0, 1].map(|end| self.graph.add(x.ends[end], y.ends[end]));
            return Values::Affine(Affine {
                ends,
                magnitude: self.graph.add(x.magnitude, y.magnitude),
            });
        }
        let (x, y) = (self.interval(x), self.interval(y));
        let sum = self.monotone2(Binary::Add, x, y);
        let sum = self.widen_relative(sum, ROUNDING);
        self.overflow_monotone(sum, &[x, y]).into()
    }

    pub(super) fn difference(&mut self, x: Values, y: Values) -> Values {
        if let (Values::Constant(x), Values::Constant(y)) = (x, y) {
            return Values::Constant(self.graph.sub(x, y));
        }
        let y = self.negative(y);
        self.sum(x, y)
    }

    /// The difference of two values of the field that the field itself does not compute. The field
    /// rounds per-frame values to f32 before it uses them, whereas this difference is rounded once:
    /// that matters where they nearly cancel.
    pub(super) fn difference_of_rounded(&mut self, x: Values, y: Values) -> Values {
        let difference = self.difference(x, y);
        let (Values::Constant(x), Values::Constant(y), Values::Constant(node)) = (x, y, difference)
        else {
            return difference;
        };
        if [x, y, node].into_iter().all(|it| self.is_single(it)) {
            return difference;
        }
        let (x, y) = (self.graph.abs(x), self.graph.abs(y));
        let size = self.graph.add(x, y);
        let margin = self.scaled(size, ROUNDING);
        self.expand(Interval::new(node, node), margin).into()
    }

    /// True if a node is a constant that f32 represents exactly.
    fn is_single(&self, node: NodeId) -> bool {
        let lanes = |value: crate::node::Const| {
            let width = value.ty().width();
            value.lanes()[..width].iter().all(|&lane| f64::from(lane as f32) == lane)
        };
        self.graph.as_const(node).is_some_and(lanes)
    }

    /// The product of two values of one type, lane by lane.
    pub(super) fn product(&mut self, x: Values, y: Values) -> Values {
        match (x, y) {
            (Values::Constant(x), Values::Constant(y)) => Values::Constant(self.graph.mul(x, y)),
            (Values::Affine(affine), Values::Constant(by))
            | (Values::Constant(by), Values::Affine(affine)) => {
                let ends = affine.ends.map(|end| self.graph.mul(end, by));
                let factor = self.graph.abs(by);
                Values::Affine(Affine { ends, magnitude: self.graph.mul(affine.magnitude, factor) })
            }
            (Values::Interval(interval), Values::Constant(by))
            | (Values::Constant(by), Values::Interval(interval)) => {
                self.multiple(interval, by).into()
            }
            (Values::Affine(x), Values::Affine(y)) if x.is_constant() || y.is_constant() => {
                self.affine_product(x, y, Graph::mul)
            }
            (Values::Affine(_) | Values::Interval(_), Values::Affine(_) | Values::Interval(_)) => {
                let (x, y) = (self.interval(x), self.interval(y));
                self.span_product(x, y).into()
            }
        }
    }

    /// The product of two affine values of which one is constant.
    pub(super) fn affine_product(
        &mut self,
        x: Affine,
        y: Affine,
        product: impl Fn(&mut Graph, NodeId, NodeId) -> NodeId,
    ) -> Values {
        let mut product = |x, y| product(self.graph, x, y);
        let ends = [product(x.ends[0], y.ends[0]), product(x.ends[1], y.ends[1])];
        Values::Affine(Affine { ends, magnitude: product(x.magnitude, y.magnitude) })
    }

    /// The product of an interval and one number of any sign.
    fn multiple(&mut self, x: Interval, by: NodeId) -> Interval {
        let ends = [x.lo, x.hi].map(|end| self.graph.mul(end, by));
        let range = self.graph.range(by);
        let result = if range.lo >= 0.0 {
            Interval { lo: ends[0], hi: ends[1], ..x }
        } else if range.hi <= 0.0 {
            Interval { lo: ends[1], hi: ends[0], ..x }
        } else {
            Interval { may_overflow: x.may_overflow, ..self.hull_of(&ends) }
        };
        let result = self.widen_relative(result, ROUNDING);
        if !x.may_overflow {
            return result;
        }
        let result = self.overflow_product(result, x, Interval::new(by, by));
        self.clamp_to_large(result)
    }

    fn span_product(&mut self, x: Interval, y: Interval) -> Interval {
        let [x_is_positive, y_is_positive] =
            [x, y].map(|interval| self.graph.range(interval.lo).lo >= 0.0);
        let (x, y) = if x_is_positive { (y, x) } else { (x, y) };
        let mut corner = |a, b| self.graph.mul(a, b);
        let result = if x_is_positive && y_is_positive {
            Interval::new(corner(x.lo, y.lo), corner(x.hi, y.hi))
        } else if x_is_positive || y_is_positive {
            let [low, high] = [x.lo, x.hi].map(|end| [corner(end, y.lo), corner(end, y.hi)]);
            let lo = self.graph.min(low[0], low[1]);
            Interval::new(lo, self.graph.max(high[0], high[1]))
        } else {
            let corners =
                [corner(x.lo, y.lo), corner(x.lo, y.hi), corner(x.hi, y.lo), corner(x.hi, y.hi)];
            self.hull_of(&corners)
        };
        let result = self.widen_relative(result, ROUNDING);
        if !x.may_overflow && !y.may_overflow {
            return result;
        }
        let result = self.overflow_product(result, x, y);
        self.clamp_to_large(result)
    }

    pub(super) fn square(&mut self, x: Values) -> Values {
        if let Values::Constant(value) = x {
            return Values::Constant(self.graph.mul(value, value));
        }
        let x = self.magnitudes(x);
        let x = self.interval(x);
        self.span_product(x, x).into()
    }

    pub(super) fn quotient(&mut self, x: Values, y: Values) -> Values {
        match (x, y) {
            (Values::Constant(x), Values::Constant(y)) => Values::Constant(self.graph.div(x, y)),
            (Values::Affine(affine), Values::Constant(by)) => {
                let ends = affine.ends.map(|end| self.graph.div(end, by));
                let divisor = self.graph.abs(by);
                Values::Affine(Affine {
                    ends,
                    magnitude: self.graph.div(affine.magnitude, divisor),
                })
            }
            (Values::Interval(interval), Values::Constant(by)) => {
                let one = self.number_like(by, 1.0);
                let factor = self.graph.div(one, by);
                let result = self.multiple(interval, factor);
                self.widen_relative(result, COARSE).into()
            }
            (_, Values::Affine(_) | Values::Interval(_)) => {
                let (x, y) = (self.interval(x), self.interval(y));
                if self.graph.range(y.lo).lo >= 0.0 {
                    self.quotient_by_positive(x, y).into()
                } else {
                    self.per_lane([x.into(), y.into()], |s, [x, y]| s.quotient_of_numbers(x, y))
                }
            }
        }
    }

    /// The quotient by a positive divisor. A divisor that may reach 0 leaves the quotient
    /// [`LARGE`].
    pub(super) fn quotient_by_positive(&mut self, x: Interval, y: Interval) -> Interval {
        let divisors = [y.lo, y.hi].map(|end| self.at_least(end, TINY));
        let ends = [x.lo, x.hi].map(|end| divisors.map(|by| self.graph.div(end, by)));
        let lo = self.graph.min(ends[0][0], ends[0][1]);
        let result = Interval::new(lo, self.graph.max(ends[1][0], ends[1][1]));
        let result = self.widen_relative(result, COARSE);
        let result = self.overflow_monotone(result, &[x]);
        let result = self.overflow_reciprocal(result, y);
        self.clamp_to_large(result)
    }

    fn quotient_of_numbers(&mut self, x: Values, y: Values) -> Interval {
        let (x, y) = (self.interval(x), self.interval(y));
        let zero = self.graph.number(0.0);
        let (below, above) = (self.graph.le(y.lo, zero), self.graph.le(zero, y.hi));
        let meets_zero = self.graph.binary(Binary::And, below, above);
        // Makes the divisor positive; the result is not used where it contains 0.
        let negative = self.graph.le(y.hi, zero);
        let (low, high) = (self.graph.neg(y.hi), self.graph.neg(y.lo));
        let y_lo = self.graph.select(negative, low, y.lo);
        let y_hi = self.graph.select(negative, high, y.hi);
        let (low, high) = (self.graph.neg(x.hi), self.graph.neg(x.lo));
        let x_lo = self.graph.select(negative, low, x.lo);
        let x_hi = self.graph.select(negative, high, x.hi);
        let (x, y) = (Interval { lo: x_lo, hi: x_hi, ..x }, Interval { lo: y_lo, hi: y_hi, ..y });
        let result = self.quotient_by_positive(x, y);
        let entire = self.entire(Type::Scalar);
        self.select(Interval::new(meets_zero, meets_zero), entire, result)
    }

    /// `x - y * floor(x / y)`: x shifted by a constant while the quotient's floor is one number,
    /// else between 0 and y.
    pub(super) fn remainder(&mut self, x: Values, y: Values) -> Values {
        self.per_lane([x, y], |s, [x, y]| {
            let fixed = if let Values::Constant(y) = y { Some(y) } else { None };
            let (x, y) = (s.interval(x), s.interval(y));
            let (low, high) = (s.at_most(y.lo, 0.0), s.at_least(y.hi, 0.0));
            let between = Interval { lo: low, hi: high, may_overflow: y.may_overflow };
            let size = s.magnitude(x);
            let margin = s.scaled(size, ROUNDING);
            let between = s.expand(between, margin);
            let Some(y) = fixed else { return between };
            let [first, last] = s.quotient_floors(x.into(), Values::Constant(y));
            let step = s.graph.mul(y, first);
            let moved = Interval { lo: s.graph.sub(x.lo, step), hi: s.graph.sub(x.hi, step), ..x };
            let moved = s.expand(moved, margin);
            let same = s.graph.binary(Binary::Eq, first, last);
            s.select(Interval::new(same, same), moved, between)
        })
    }

    /// The floors of the least and the greatest quotient. Devices need not agree on the side of a
    /// whole number on which a quotient close to it lies.
    fn quotient_floors(&mut self, x: Values, y: Values) -> [NodeId; 2] {
        let quotient = self.quotient(x, y);
        let Interval { lo, hi, .. } = self.interval(quotient);
        [lo, hi].map(|end| self.graph.unary(Unary::Floor, end))
    }

    /// `x * (1 - t) + y * t`. For t from 0 to 1 it lies between the mixtures at the ends.
    pub(super) fn mixture(&mut self, x: Values, y: Values, t: Values) -> Values {
        let interval = self.interval(t);
        let unit =
            self.graph.range(interval.lo).lo >= 0.0 && self.graph.range(interval.hi).hi <= 1.0;
        if !unit {
            let rest = self.one_minus(t);
            let (first, second) = (self.product(x, rest), self.product(y, t));
            let sum = self.sum(first, second);
            return self.mixed_by_difference(sum, [x, y], interval);
        }
        let (x, y) = (self.interval(x), self.interval(y));
        let mut mixed = |x, y, t| self.graph.ternary(Ternary::Mix, x, y, t);
        let low = [mixed(x.lo, y.lo, interval.lo), mixed(x.lo, y.lo, interval.hi)];
        let high = [mixed(x.hi, y.hi, interval.lo), mixed(x.hi, y.hi, interval.hi)];
        let (lo, hi) = (self.graph.min(low[0], low[1]), self.graph.max(high[0], high[1]));
        let sizes = [self.magnitude(x), self.magnitude(y)];
        let size = self.graph.max(sizes[0], sizes[1]);
        let margin = self.scaled(size, 2.0 * ROUNDING);
        let result = self
            .expand(Interval { lo, hi, may_overflow: x.may_overflow || y.may_overflow }, margin);
        let result = self.overflow_monotone(result, &[x, y]);
        if result.may_overflow { self.clamp_to_large(result).into() } else { result.into() }
    }

    /// Widens a mixture for devices that compute `x + t (y - x)`, whose terms may be larger than
    /// those of `x (1 - t) + y t`.
    fn mixed_by_difference(&mut self, mixture: Values, ends: [Values; 2], t: Interval) -> Values {
        let [x, y] = ends.map(|end| {
            let end = self.interval(end);
            self.magnitude(end)
        });
        let size = self.graph.max(x, y);
        let weight = self.magnitude(t);
        let weight = self.at_least(weight, 1.0);
        let size = self.graph.mul(size, weight);
        let margin = self.scaled(size, 2.0 * ROUNDING);
        let mixture = self.interval(mixture);
        let result = self.expand(mixture, margin);
        if result.may_overflow { self.clamp_to_large(result).into() } else { result.into() }
    }

    /// The slope of a value that jumps from one whole number to the next: 0 where it is the same at
    /// both ends, else unbounded.
    pub(super) fn jump(&mut self, x: Interval) -> Values {
        let gap = self.graph.sub(x.hi, x.lo);
        let jumps = self.graph.unary(Unary::Saturate, gap);
        let hi = self.scaled(jumps, LARGE);
        Interval::overflowing(self.graph.neg(hi), hi).into()
    }
}
