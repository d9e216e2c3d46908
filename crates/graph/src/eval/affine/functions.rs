//! Functions of one and two affine forms.

use super::{Affine, LEAST_SLOPE, underflow};
use crate::eval::{Interval, Number};

fn number(value: f64) -> Interval {
    Interval::constant(value)
}

impl Affine {
    pub(super) fn magnitude(self) -> Self {
        let (lo, hi) = (self.range.lo(), self.range.hi());
        if lo >= 0.0 {
            return self;
        }
        if hi <= 0.0 {
            return self.neg();
        }
        let range = Number::abs(self.range);
        if !(hi - lo).is_finite() {
            return Self::from_range(range);
        }
        // The chord through both ends is above |x| by at most its height at 0.
        let scale = (hi + lo) / (hi - lo);
        let height = 2.0 * -lo * (hi / (hi - lo)) * (1.0 + 1e-14);
        self.scaled(scale, Interval::new(0.0, height), range)
    }

    pub(super) fn squared(self) -> Self {
        let radius = self.radius();
        let bend = 0.5 * radius * radius;
        let slopes = self.slopes.map(|slope| 2.0 * self.center * slope);
        let error =
            2.0 * self.center.abs() * self.error + bend * (1.0 + 1e-14) + underflow(self.size());
        Self::new(self.center * self.center + bend, slopes, error, self.range.square())
    }

    pub(super) fn root(self) -> Self {
        let half = number(0.5);
        let slope = match self.range.lo() > 0.0 {
            true => half.div(self.range.sqrt()),
            false => Interval::ENTIRE,
        };
        self.smooth(Number::sqrt, slope)
    }

    pub(super) fn inverse_root(self) -> Self {
        let slope = match self.range.lo() > 0.0 {
            true => number(-0.5).mul(self.range.inverse_sqrt()).div(self.range),
            false => Interval::ENTIRE,
        };
        self.smooth(Number::inverse_sqrt, slope)
    }

    pub(super) fn reciprocal(self) -> Self {
        let f = |x: Interval| number(1.0).div(x);
        let slope = match self.range.contains(0.0) {
            true => Interval::ENTIRE,
            false => number(-1.0).div(self.range.square()),
        };
        self.smooth(f, slope)
    }

    pub(super) fn arc_slope(self) -> Interval {
        number(1.0).sub(self.range.square()).inverse_sqrt()
    }

    /// Returns the lesser of two numbers, or the greater.
    pub(super) fn extreme(self, y: Self, greater: bool) -> Self {
        let difference = self.minus(y);
        let (lo, hi) = (difference.range.lo(), difference.range.hi());
        let pick = |first: bool| if first != greater { self } else { y };
        if hi <= 0.0 {
            return pick(true);
        }
        if lo >= 0.0 {
            return pick(false);
        }
        let range = match greater {
            true => Number::max(self.range, y.range),
            false => Number::min(self.range, y.range),
        };
        // (x + y - |x - y|) / 2 is the lesser.
        let (sum, magnitude) = (self.plus(y), difference.magnitude());
        let twice = if greater { sum.plus(magnitude) } else { sum.minus(magnitude) };
        twice.scaled(
            0.5,
            number(0.0),
            range.clipped(0.5 * twice.range.lo(), 0.5 * twice.range.hi()),
        )
    }

    /// Compares two numbers, also by the range of their difference.
    pub(super) fn compared(self, y: Self, f: impl Fn(Interval, Interval) -> Interval) -> Self {
        let direct = f(self.range, y.range);
        if direct.lo() == direct.hi() {
            return Self::from_range(direct);
        }
        Self::from_range(f(self.minus(y).range, number(0.0)))
    }

    pub(super) fn angle(self, x: Self) -> Self {
        let range = self.range.atan2(x.range);
        let norm = self.range.square().add(x.range.square());
        let is_cut = self.range.contains(0.0) && x.range.lo() <= 0.0;
        let [by_y, by_x] = [x.range.div(norm), self.range.neg().div(norm)];
        let widths = [by_y, by_x].map(|slope| slope.hi() - slope.lo());
        let is_flat = by_y.magnitude().min(by_x.magnitude()) < LEAST_SLOPE;
        if is_cut || is_flat || !(widths[0] + widths[1]).is_finite() {
            return Self::from_range(range);
        }
        let middle = |slope: Interval| 0.5 * slope.lo() + 0.5 * slope.hi();
        let [y0, x0] = [self.range, x.range].map(middle);
        let [dy, dx] = [by_y, by_x].map(middle);
        let radius = |range: Interval| 0.5 * (range.hi() - range.lo()) * (1.0 + 1e-14);
        let bend = 0.5 * widths[0] * radius(self.range) + 0.5 * widths[1] * radius(x.range);
        let bend = bend * (1.0 + 1e-14) + 1e-14 * (dy.abs() * y0.abs() + dx.abs() * x0.abs());
        let at_middle = number(y0).atan2(number(x0));
        let tangent = at_middle.sub(number(dy).mul(number(y0))).sub(number(dx).mul(number(x0)));
        let offset = tangent.add(Interval::new(-bend, bend));
        let by_x = x.scaled(dx, offset, Interval::ENTIRE);
        self.scaled(dy, number(0.0), Interval::ENTIRE).plus(by_x).within(range)
    }

    pub(super) fn power(self, y: Self) -> Self {
        let range = self.range.pow(y.range);
        if y.range.lo() == y.range.hi() {
            let exponent = y.range.lo();
            let slope = number(exponent).mul(self.range.pow(number(exponent - 1.0)));
            return self.smooth(|x| x.pow(number(exponent)), slope);
        }
        if self.range.lo() > 0.0 {
            return y.times(self.log()).exp().within(range);
        }
        Self::from_range(range)
    }

    pub(super) fn hermite(self, hi: Self, x: Self) -> Self {
        let range = self.range.smoothstep(hi.range, x.range);
        let width = hi.minus(self);
        if width.range.contains(0.0) {
            return Self::from_range(range);
        }
        let t = x.minus(self).times(width.reciprocal());
        let t = t.extreme(Self::constant(0.0), true).extreme(Self::constant(1.0), false);
        let f = |t: Interval| t.square().mul(number(3.0).sub(number(2.0).mul(t)));
        let slope = number(6.0).mul(t.range).mul(number(1.0).sub(t.range));
        let curve = t.smooth(f, slope);
        curve.within(range)
    }
}
