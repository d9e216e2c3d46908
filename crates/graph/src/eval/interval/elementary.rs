//! Roots, logarithms, powers, trigonometric functions and angles.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{Interval, MARGIN, above, below, lower, upper};

/// Largest angle whose phase is computed.
const LARGEST_ANGLE: f64 = 1e9;

impl Interval {
    pub(super) fn root(self) -> Self {
        if self.hi < 0.0 {
            return Self::ENTIRE;
        }
        let lo = if self.lo > 0.0 { lower(self.lo.sqrt()) } else { 0.0 };
        Self { lo, hi: if self.hi == 0.0 { 0.0 } else { upper(self.hi.sqrt()) } }
    }

    pub(super) fn inverse_root(self) -> Self {
        if self.hi < 0.0 {
            return Self::ENTIRE;
        }
        let hi = if self.lo > 0.0 { above(1.0 / self.lo.sqrt()) } else { f64::INFINITY };
        Self { lo: below(1.0 / self.hi.sqrt()).max(0.0), hi }
    }

    pub(super) fn logarithm(self, log: impl Fn(f64) -> f64) -> Self {
        if self.hi < 0.0 {
            return Self::ENTIRE;
        }
        self.clipped(0.0, f64::INFINITY).increasing(log)
    }

    pub(super) fn sine(self) -> Self {
        self.sine_wave(libm::sin, FRAC_PI_2, -FRAC_PI_2)
    }

    pub(super) fn cosine(self) -> Self {
        self.sine_wave(libm::cos, 0.0, PI)
    }

    /// Bounds sine or cosine: a function of period 2π that falls from 1 at `crest` to -1 at
    /// `trough`.
    fn sine_wave(self, f: impl Fn(f64) -> f64, crest: f64, trough: f64) -> Self {
        let (a, b) = (f(self.lo), f(self.hi));
        let hi = if self.contains_multiple(crest, TAU) { 1.0 } else { above(a.max(b)) };
        let lo = if self.contains_multiple(trough, TAU) { -1.0 } else { below(a.min(b)) };
        Self { lo, hi }.clipped(-1.0, 1.0)
    }

    pub(super) fn tangent(self) -> Self {
        if self.contains_multiple(FRAC_PI_2, PI) {
            Self::ENTIRE
        } else {
            self.increasing(libm::tan)
        }
    }

    /// True if the interval may contain `phase + k * period` for a whole number k.
    fn contains_multiple(self, phase: f64, period: f64) -> bool {
        let size = self.magnitude();
        if size > LARGEST_ANGLE || self.hi - self.lo >= period {
            return true;
        }
        let slack = MARGIN * (size + period);
        let last = ((self.hi + slack - phase) / period).floor() * period + phase;
        last >= self.lo - slack
    }

    pub(super) fn arc_sine(self) -> Self {
        if self.lo > 1.0 || self.hi < -1.0 {
            return Self::ENTIRE;
        }
        self.clipped(-1.0, 1.0).increasing(libm::asin)
    }

    pub(super) fn arc_cosine(self) -> Self {
        if self.lo > 1.0 || self.hi < -1.0 {
            return Self::ENTIRE;
        }
        let Self { lo, hi } = self.clipped(-1.0, 1.0);
        Self { lo: below(libm::acos(hi)).max(0.0), hi: above(libm::acos(lo)) }
    }

    /// `x^y`, monotonic in the base and in the exponent separately, so the extremes are at corners.
    pub(super) fn power(self, y: Self) -> Self {
        if self.hi < 0.0 {
            return Self::ENTIRE;
        }
        let base = Self { lo: self.lo.max(0.0) + 0.0, hi: self.hi + 0.0 }; // no negative zero
        let corners = [
            libm::pow(base.lo, y.lo),
            libm::pow(base.lo, y.hi),
            libm::pow(base.hi, y.lo),
            libm::pow(base.hi, y.hi),
        ];
        let lo = corners.into_iter().fold(f64::INFINITY, f64::min);
        let hi = corners.into_iter().fold(0.0, f64::max);
        Self { lo, hi }.widened().clipped(0.0, f64::INFINITY)
    }

    /// `atan2(self, x)`: the angles of a box that contains neither the origin nor a point of the
    /// branch cut along negative x lie between the angles of its corners.
    pub(super) fn angle(self, x: Self) -> Self {
        if self.contains(0.0) && x.lo <= 0.0 {
            return Self { lo: below(-PI), hi: above(PI) };
        }
        let corners = [
            libm::atan2(self.lo, x.lo),
            libm::atan2(self.lo, x.hi),
            libm::atan2(self.hi, x.lo),
            libm::atan2(self.hi, x.hi),
        ];
        let lo = corners.into_iter().fold(f64::INFINITY, f64::min);
        let hi = corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Self { lo, hi }.widened()
    }

    /// `atan2(y, x)` for negative x and a y around 0: first for y ≤ 0, then for y ≥ 0.
    pub(super) fn angles_at_cut(y: Self, x: Self) -> [Self; 2] {
        let below = Self { lo: -PI, hi: if y.lo < 0.0 { libm::atan2(y.lo, x.hi) } else { -PI } };
        let above = Self { lo: if y.hi > 0.0 { libm::atan2(y.hi, x.hi) } else { PI }, hi: PI };
        [below.widened(), above.widened()]
    }
}
