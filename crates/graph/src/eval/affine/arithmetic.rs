//! The operations of the closed set.

use super::{Affine, ROUNDING};
use crate::eval::{Interval, Number};

fn number(value: f64) -> Interval {
    Interval::constant(value)
}

impl Number for Affine {
    fn constant(value: f64) -> Self {
        Self::from_range(number(value))
    }

    fn neg(self) -> Self {
        let slopes = self.slopes.map(|slope| -slope);
        Self { center: -self.center, slopes, error: self.error, range: self.range.neg() }
    }
    fn abs(self) -> Self {
        self.magnitude()
    }
    fn sign(self) -> Self {
        Self::from_range(self.range.sign())
    }
    fn floor(self) -> Self {
        Self::from_range(self.range.floor())
    }
    fn ceil(self) -> Self {
        Self::from_range(self.range.ceil())
    }
    fn round(self) -> Self {
        Self::from_range(self.range.round())
    }
    fn trunc(self) -> Self {
        Self::from_range(self.range.trunc())
    }
    fn square(self) -> Self {
        self.squared()
    }
    fn sqrt(self) -> Self {
        self.root()
    }
    fn inverse_sqrt(self) -> Self {
        self.inverse_root()
    }
    fn exp(self) -> Self {
        self.smooth(Number::exp, self.range.exp())
    }
    fn exp2(self) -> Self {
        let slope = self.range.exp2().mul(number(std::f64::consts::LN_2));
        self.smooth(Number::exp2, slope)
    }
    fn log(self) -> Self {
        self.smooth(Number::log, positive_reciprocal(self.range))
    }
    fn log2(self) -> Self {
        let slope = positive_reciprocal(self.range).mul(number(std::f64::consts::LOG2_E));
        self.smooth(Number::log2, slope)
    }
    fn sin(self) -> Self {
        self.smooth(Number::sin, self.range.cos())
    }
    fn cos(self) -> Self {
        self.smooth(Number::cos, self.range.sin().neg())
    }
    fn tan(self) -> Self {
        let range = self.range.tan();
        self.smooth(Number::tan, number(1.0).add(range.square()))
    }
    fn asin(self) -> Self {
        self.smooth(Number::asin, self.arc_slope())
    }
    fn acos(self) -> Self {
        self.smooth(Number::acos, self.arc_slope().neg())
    }
    fn atan(self) -> Self {
        let slope = number(1.0).div(number(1.0).add(self.range.square()));
        self.smooth(Number::atan, slope)
    }
    fn sinh(self) -> Self {
        self.smooth(Number::sinh, self.range.cosh())
    }
    fn cosh(self) -> Self {
        self.smooth(Number::cosh, self.range.sinh())
    }
    fn tanh(self) -> Self {
        let slope = number(1.0).sub(self.range.tanh().square());
        self.smooth(Number::tanh, slope)
    }
    fn not(self) -> Self {
        Self::from_range(self.range.not())
    }

    fn add(self, y: Self) -> Self {
        self.plus(y)
    }
    fn sub(self, y: Self) -> Self {
        self.minus(y)
    }
    fn mul(self, y: Self) -> Self {
        self.times(y)
    }
    fn div(self, y: Self) -> Self {
        self.times(y.reciprocal()).within(self.range.div(y.range))
    }
    fn min(self, y: Self) -> Self {
        self.extreme(y, false)
    }
    fn max(self, y: Self) -> Self {
        self.extreme(y, true)
    }
    fn pow(self, y: Self) -> Self {
        self.power(y)
    }
    fn atan2(self, x: Self) -> Self {
        self.angle(x)
    }
    fn step(self, x: Self) -> Self {
        self.compared(x, |edge, x| edge.step(x))
    }
    fn hash(self, x: Self) -> Self {
        Self::from_range(self.range.hash(x.range))
    }
    fn normalize_lane(self, length: Self) -> Self {
        let range = self.range.normalize_lane(length.range);
        if length.range.lo() > 0.0 {
            return self.times(length.reciprocal()).within(range);
        }
        Self::from_range(range)
    }
    fn lt(self, y: Self) -> Self {
        self.compared(y, Number::lt)
    }
    fn le(self, y: Self) -> Self {
        self.compared(y, Number::le)
    }
    fn eq(self, y: Self) -> Self {
        self.compared(y, Number::eq)
    }
    fn ne(self, y: Self) -> Self {
        self.compared(y, Number::ne)
    }
    fn and(self, y: Self) -> Self {
        Self::from_range(self.range.and(y.range))
    }
    fn or(self, y: Self) -> Self {
        Self::from_range(self.range.or(y.range))
    }

    fn is_definitely_false(self) -> bool {
        self.range.is_definitely_false()
    }
    fn jump_slope(self) -> Self {
        Self::from_range(self.range.jump_slope())
    }
    fn element(self, list: &[f64]) -> Self {
        Self::from_range(self.range.element(list))
    }

    fn fract_with_floor(self, whole: Self) -> Self {
        self.minus(whole).within(self.range.fract_with_floor(whole.range))
    }
    fn rem_with_quotient(self, y: Self, whole: Self) -> Self {
        let range = self.range.rem_with_quotient(y.range, whole.range);
        self.minus(y.times(whole)).within(range)
    }
    fn mix(self, y: Self, t: Self) -> Self {
        // Numbers are mixed as x (1 - t) + y t. Where t is large, both terms are larger than their
        // sum, and so is their rounding. Where t has no limit, nothing but the range is known.
        let [x_size, y_size, t_size] = [self, y, t].map(|it| it.range.magnitude());
        let rounding = ROUNDING * (x_size * (1.0 + t_size) + y_size * t_size);
        let Self { center, slopes, error, .. } = self.plus(y.minus(self).times(t));
        Self::new(center, slopes, error + rounding, self.range.mix(y.range, t.range))
    }
    fn clamp(self, lo: Self, hi: Self) -> Self {
        self.extreme(lo, true).extreme(hi, false)
    }
    fn smoothstep(self, hi: Self, x: Self) -> Self {
        self.hermite(hi, x)
    }
    fn x_times_one_minus_x(self, y: Self, c: Self) -> Self {
        // x (1 - x) = 1/4 - (x - 1/2)^2
        let offset = self.minus(Self::constant(0.5)).squared();
        let product = c.times(Self::constant(0.25).minus(offset));
        product.within(self.range.x_times_one_minus_x(y.range, c.range))
    }
    fn clamp_residual(self, lo: Self, hi: Self) -> Self {
        let range = self.range.clamp_residual(lo.range, hi.range);
        self.minus(self.clamp(lo, hi)).within(range)
    }
    fn select(self, yes: Self, no: Self) -> Self {
        if self.range.is_definitely_false() {
            no
        } else if self.range.contains(0.0) {
            yes.hull(no)
        } else {
            yes
        }
    }
}

/// Returns the reciprocal of a positive number; all numbers if it may not be positive.
fn positive_reciprocal(x: Interval) -> Interval {
    if x.lo() > 0.0 { number(1.0).div(x) } else { Interval::ENTIRE }
}
