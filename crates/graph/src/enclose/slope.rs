//! Bounds of the slope of a node along a segment: the chain rule over intervals, per operation.
//!
//! Between kinks the slope is the derivative. At a kink it covers everything between the
//! derivatives on both sides. Where the value may jump within the segment, the slope is unbounded.
//! So two values on a segment never differ by more than the slope bounds allow.

use super::encloser::Encloser;
use super::values::{AFFINE, Affine, BoundedValue, Interval, ROUNDING, TINY, Values};
use crate::node::{Binary, Ternary, Type, Unary};

impl Encloser<'_> {
    /// The slope of an operation on one argument, given its result.
    pub(super) fn unary_slope(
        &mut self,
        op: Unary,
        x: BoundedValue,
        result: Values,
    ) -> Option<Values> {
        let slope = x.slope?;
        let value = x.value;
        Some(match op {
            Unary::Neg => self.negative(slope),
            Unary::Abs => self.absolute_slope(value, slope),
            Unary::Sign | Unary::Floor | Unary::Ceil | Unary::Round | Unary::Trunc => {
                let whole = self.interval(result);
                self.jump(whole)
            }
            Unary::Fract => {
                let floor = self.unary(Unary::Floor, value);
                let floor = self.interval(floor);
                let jump = self.jump(floor);
                self.sum(slope, jump)
            }
            Unary::Sqrt => {
                let half = self.number(result, 0.5);
                let factor = self.quotient(half, result);
                self.product(slope, factor)
            }
            Unary::InverseSqrt => {
                let factor = self.quotient(result, value);
                let factor = self.times(factor, -0.5);
                self.product(slope, factor)
            }
            Unary::Exp => self.product(slope, result),
            Unary::Exp2 => {
                let slope = self.product(slope, result);
                self.times(slope, std::f64::consts::LN_2)
            }
            Unary::Log => self.quotient(slope, value),
            Unary::Log2 => {
                let slope = self.quotient(slope, value);
                self.times(slope, std::f64::consts::LOG2_E)
            }
            Unary::Sin => {
                let cosine = self.unary(Unary::Cos, value);
                self.product(slope, cosine)
            }
            Unary::Cos => {
                let sine = self.unary(Unary::Sin, value);
                let slope = self.product(slope, sine);
                self.negative(slope)
            }
            Unary::Tan => {
                let square = self.square(result);
                let factor = self.plus(square, 1.0);
                self.product(slope, factor)
            }
            Unary::Asin | Unary::Acos => {
                let square = self.square(value);
                let rest = self.one_minus(square);
                let root = self.unary(Unary::Sqrt, rest);
                let slope = self.quotient(slope, root);
                if op == Unary::Asin { slope } else { self.negative(slope) }
            }
            Unary::Atan => {
                let square = self.square(value);
                let below = self.plus(square, 1.0);
                self.quotient(slope, below)
            }
            Unary::Sinh | Unary::Cosh => {
                let other = if op == Unary::Sinh { Unary::Cosh } else { Unary::Sinh };
                let factor = self.unary(other, value);
                self.product(slope, factor)
            }
            Unary::Tanh => {
                let square = self.square(result);
                let factor = self.one_minus(square);
                self.product(slope, factor)
            }
            Unary::Saturate => {
                let (zero, one) = (self.number(value, 0.0), self.number(value, 1.0));
                self.clamp_slope(x, BoundedValue::fixed(zero), BoundedValue::fixed(one))?
            }
            Unary::Length => self.length_slope(value, slope, result),
            Unary::Normalize => {
                let ty = self.ty(value);
                let along = self.dot(result, slope);
                let along = self.splat(ty, along);
                let part = self.product(result, along);
                let aside = self.difference(slope, part);
                let length = self.length(value);
                let length = self.splat(ty, length);
                self.quotient(aside, length)
            }
            Unary::Not => return None,
        })
    }

    /// The slope of an operation on two arguments, given its result.
    pub(super) fn binary_slope(
        &mut self,
        op: Binary,
        x: BoundedValue,
        y: BoundedValue,
        result: Values,
    ) -> Option<Values> {
        if x.slope.is_none() && y.slope.is_none() {
            return None;
        }
        match op {
            Binary::Add => self.total(x.slope, y.slope),
            Binary::Sub => {
                let y = y.slope.map(|slope| self.negative(slope));
                self.total(x.slope, y)
            }
            Binary::Mul => {
                let first = x.slope.map(|slope| self.product(slope, y.value));
                let second = y.slope.map(|slope| self.product(slope, x.value));
                self.total(first, second)
            }
            Binary::Div => {
                let second = y.slope.map(|slope| {
                    let part = self.product(slope, result);
                    self.negative(part)
                });
                let above = self.total(x.slope, second)?;
                Some(self.quotient(above, y.value))
            }
            Binary::Rem => {
                let quotient = self.quotient(x.value, y.value);
                let whole = self.unary(Unary::Floor, quotient);
                let second = y.slope.map(|slope| {
                    let part = self.product(slope, whole);
                    self.negative(part)
                });
                let smooth = self.total(x.slope, second);
                let whole = self.interval(whole);
                let jump = self.jump(whole);
                self.total(smooth, Some(jump))
            }
            Binary::Min => Some(self.slope_by(x, y, x, y)),
            Binary::Max => Some(self.slope_by(y, x, x, y)),
            Binary::Alternative => y.slope,
            Binary::Pow => self.power_slope(x, y, result),
            Binary::Atan2 => self.angle_slope(x, y),
            Binary::Step | Binary::Hash => {
                let result = self.interval(result);
                Some(self.jump(result))
            }
            Binary::Dot => {
                let first = x.slope.map(|slope| self.dot(slope, y.value));
                let second = y.slope.map(|slope| self.dot(slope, x.value));
                self.total(first, second)
            }
            Binary::Cross => {
                let first = x.slope.map(|slope| self.cross(slope, y.value));
                let second = y.slope.map(|slope| self.cross(x.value, slope));
                self.total(first, second)
            }
            Binary::Lt | Binary::Le | Binary::Eq | Binary::Ne | Binary::And | Binary::Or => None,
        }
    }

    /// The slope of an operation on three arguments.
    pub(super) fn ternary_slope(
        &mut self,
        op: Ternary,
        [x, y, z]: [BoundedValue; 3],
    ) -> Option<Values> {
        match op {
            Ternary::Mix => {
                let rest = self.one_minus(z.value);
                let first = x.slope.map(|slope| self.product(slope, rest));
                let second = y.slope.map(|slope| self.product(slope, z.value));
                let third = z.slope.map(|slope| {
                    let difference = self.difference_of_rounded(y.value, x.value);
                    self.product(slope, difference)
                });
                let moved = self.total(first, second);
                self.total(moved, third)
            }
            Ternary::Clamp => self.clamp_slope(x, y, z),
            Ternary::Smoothstep => {
                let width = self.width_between(x.value, y.value);
                let t = self.position_between(x.value, y.value, z.value);
                let rest = self.one_minus(t);
                let bump = self.product(t, rest);
                let bump = self.times(bump, 6.0);
                let steepness = self.quotient(bump, width);
                let moved = z.slope.map(|slope| self.product(steepness, slope));
                if x.slope.is_none() && y.slope.is_none() {
                    return moved;
                }
                let ty = self.ty(t);
                Some(self.entire(ty).into())
            }
            Ternary::Select => {
                let (yes, no) = (self.slope(y), self.slope(z));
                let truth = self.interval(x.value);
                let (yes, no) = (self.interval(yes), self.interval(no));
                let chosen = self.select(truth, yes, no);
                if truth.lo == truth.hi {
                    return Some(chosen.into());
                }
                // The value may jump where the condition changes.
                let ty = self.graph.ty(chosen.lo);
                let entire = self.entire(ty);
                let undecided = self.graph.binary(Binary::Ne, truth.lo, truth.hi);
                Some(self.select(Interval::new(undecided, undecided), entire, chosen).into())
            }
        }
    }

    /// The slope; 0 if the node is constant.
    pub(super) fn slope(&mut self, x: BoundedValue) -> Values {
        x.slope.unwrap_or_else(|| self.number(x.value, 0.0))
    }

    fn total(&mut self, x: Option<Values>, y: Option<Values>) -> Option<Values> {
        match (x, y) {
            (Some(x), Some(y)) => Some(self.sum(x, y)),
            (x, y) => x.or(y),
        }
    }

    /// A constant with the type of a value.
    fn number(&mut self, like: Values, value: f64) -> Values {
        let ty = self.ty(like);
        Values::Constant(self.graph.constant(ty, &[value; 4]))
    }

    pub(super) fn times(&mut self, x: Values, factor: f64) -> Values {
        let factor = self.number(x, factor);
        self.product(x, factor)
    }

    fn plus(&mut self, x: Values, by: f64) -> Values {
        let by = self.number(x, by);
        self.sum(x, by)
    }

    pub(super) fn one_minus(&mut self, x: Values) -> Values {
        let one = self.number(x, 1.0);
        self.difference_of_rounded(one, x)
    }

    fn absolute_slope(&mut self, x: Values, slope: Values) -> Values {
        let x = self.interval(x);
        let zero = self.number_like(x.lo, 0.0);
        let signs = [x.lo, x.hi].map(|end| {
            let above = self.graph.binary(Binary::Step, zero, end);
            let twice = self.scaled(above, 2.0);
            self.offset(twice, -1.0)
        });
        self.product(slope, Interval::new(signs[0], signs[1]).into())
    }

    /// The slope of `yes` where `x` is less than `y`, of `no` where it is greater.
    fn slope_by(
        &mut self,
        x: BoundedValue,
        y: BoundedValue,
        yes: BoundedValue,
        no: BoundedValue,
    ) -> Values {
        let (yes, no) = (self.slope(yes), self.slope(no));
        self.per_lane([x.value, y.value, yes, no], |s, [x, y, yes, no]| {
            let (x, y) = (s.interval(x), s.interval(y));
            let certain = s.graph.lt(x.hi, y.lo);
            let possible = s.graph.le(x.lo, y.hi);
            let (yes, no) = (s.interval(yes), s.interval(no));
            s.select(Interval::new(certain, possible), yes, no)
        })
    }

    fn clamp_slope(
        &mut self,
        x: BoundedValue,
        low: BoundedValue,
        high: BoundedValue,
    ) -> Option<Values> {
        let value = self.binary(Binary::Max, x.value, low.value);
        let slope = Some(self.slope_by(low, x, x, low));
        let raised = BoundedValue { value, slope };
        Some(self.slope_by(raised, high, raised, high))
    }

    /// The slope of a length. For an affine vector the length is convex, so its slope increases
    /// from one end to the other.
    fn length_slope(&mut self, x: Values, slope: Values, length: Values) -> Values {
        if self.ty(x).width() == 1 {
            return self.absolute_slope(x, slope);
        }
        if let (
            Values::Affine(Affine { ends, magnitude: size }),
            Values::Affine(Affine { ends: [direction, end], magnitude: speed }),
        ) = (x, slope)
            && direction == end
        {
            let (size, speed) = (self.graph.length(size), self.graph.length(speed));
            let [lo, hi] = ends.map(|end| {
                let along = self.graph.dot(end, direction);
                let length = self.graph.length(end);
                let length = self.at_least(length, TINY);
                let slope = self.graph.div(along, length);
                // Near the origin, rounding of the terms turns the direction of the vector.
                let turn = self.graph.div(size, length);
                let turn = self.scaled(turn, 2.0 * AFFINE);
                let turn = self.at_most(turn, 2.0);
                let fraction = self.offset(turn, 4.0 * ROUNDING);
                (slope, self.graph.mul(speed, fraction))
            });
            let (least, most) = (self.graph.sub(lo.0, lo.1), self.graph.add(hi.0, hi.1));
            return Interval::new(least, most).into();
        }
        let along = self.dot(x, slope);
        let ratio = self.quotient(along, length);
        let steepest = self.length(slope);
        let (ratio, steepest) = (self.interval(ratio), self.interval(steepest).hi);
        let least = self.graph.neg(steepest);
        let [lo, hi] = [ratio.lo, ratio.hi].map(|end| {
            let raised = self.graph.max(end, least);
            self.graph.min(raised, steepest)
        });
        Interval { lo, hi, may_overflow: ratio.may_overflow }.into()
    }

    /// `y x^(y - 1)` for the base, `x^y log x` for the exponent.
    fn power_slope(&mut self, x: BoundedValue, y: BoundedValue, result: Values) -> Option<Values> {
        let first = x.slope.map(|slope| {
            let less = self.plus(y.value, -1.0);
            let power = self.binary(Binary::Pow, x.value, less);
            let factor = self.product(power, y.value);
            self.product(slope, factor)
        });
        let second = y.slope.map(|slope| {
            // As an interval even if the base is constant, since it may be 0.
            let base = self.interval(x.value);
            let log = self.unary(Unary::Log, base.into());
            let factor = self.product(result, log);
            self.product(slope, factor)
        });
        self.total(first, second)
    }

    /// `(x y' - y x') / (x² + y²)`; unbounded where the angle may jump.
    fn angle_slope(&mut self, y: BoundedValue, x: BoundedValue) -> Option<Values> {
        let (dy, dx) = (self.slope(y), self.slope(x));
        Some(self.per_lane([y.value, x.value, dy, dx], |s, [y, x, dy, dx]| {
            let above = s.wedge(y, x, dy, dx);
            let vector = s.compose(&[x, y]);
            let square = s.square_of_length(vector);
            let slope = s.quotient(above, square);
            let (slope, y, x) = (s.interval(slope), s.interval(y), s.interval(x));
            let cut = s.meets_branch_cut(y, x);
            let entire = s.entire(Type::Scalar);
            s.select(Interval::new(cut, cut), entire, slope)
        }))
    }

    /// `x y' - y x'`, which is constant for an affine point.
    fn wedge(&mut self, y: Values, x: Values, dy: Values, dx: Values) -> Values {
        let (first, second) = (self.product(x, dy), self.product(y, dx));
        let difference = self.difference(first, second);
        let Values::Affine(Affine { ends, magnitude: size }) = difference else {
            return difference;
        };
        let margin = self.scaled(size, 4.0 * ROUNDING);
        self.expand(Interval::new(ends[0], ends[0]), margin).into()
    }
}
