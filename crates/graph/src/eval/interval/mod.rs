//! Interval arithmetic with conservative rounding.

mod arithmetic;
mod elementary;
mod path;

pub use path::BranchPath;

use super::Number;
use super::hash::{HASH_COUNT, hash};

/// An interval: all numbers from `lo` to `hi`, in f64.
///
/// An operation on intervals gives an interval that contains the operation's result, both in real
/// arithmetic and as computed in f64, for all numbers from the arguments for which it is defined.
/// So for a field over a box: wherever its formula is defined, its value lies in the result. If it
/// is defined nowhere, the result is all numbers. An undecided truth value spans 0 to 1; a
/// selection by it spans both branches.
///
/// Division by zero, also by a negative zero, counts as undefined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lo: f64,
    hi: f64,
}

impl Interval {
    /// All numbers.
    pub const ENTIRE: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    const FALSE: Self = Self { lo: 0.0, hi: 0.0 };
    const TRUE: Self = Self { lo: 1.0, hi: 1.0 };
    const UNDECIDED: Self = Self { lo: 0.0, hi: 1.0 };

    /// The interval between two ends; all numbers if they are out of order or NaN.
    pub fn new(lo: f64, hi: f64) -> Self {
        if lo <= hi { Self { lo, hi } } else { Self::ENTIRE }
    }

    /// The lower end.
    pub fn lo(self) -> f64 {
        self.lo
    }

    /// The upper end.
    pub fn hi(self) -> f64 {
        self.hi
    }

    /// True if the interval contains the number.
    pub fn contains(self, value: f64) -> bool {
        self.lo <= value && value <= self.hi
    }

    /// The smallest interval that contains both.
    pub fn hull(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// The part that lies in a range; the nearest end of the range if there is none.
    pub(super) fn clipped(self, lo: f64, hi: f64) -> Self {
        Self { lo: self.lo.clamp(lo, hi), hi: self.hi.clamp(lo, hi) }
    }

    /// The greatest absolute value.
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// Widened to cover ends that were computed with an error of a few units in the last place.
    fn widened(self) -> Self {
        Self { lo: below(self.lo), hi: above(self.hi) }
    }

    /// Widened by an absolute margin.
    fn grown(self, margin: f64) -> Self {
        Self { lo: lower(self.lo - margin), hi: upper(self.hi + margin) }
    }

    /// The image under an increasing function that f64 computes to a few units in the last place.
    fn increasing(self, f: impl Fn(f64) -> f64) -> Self {
        Self { lo: f(self.lo), hi: f(self.hi) }.widened()
    }

    /// A truth value: certain, impossible or undecided.
    fn truth(certain: bool, impossible: bool) -> Self {
        if certain {
            Self::TRUE
        } else if impossible {
            Self::FALSE
        } else {
            Self::UNDECIDED
        }
    }
}

/// Relative margin for library functions, which do not promise exact rounding.
const MARGIN: f64 = 8.0 * f64::EPSILON;
/// The same for results below `f64::MIN_POSITIVE`, whose last place is always the same.
const LEAST_MARGIN: f64 = f64::from_bits(8);

/// The next number below a lower end that was rounded once.
fn lower(end: f64) -> f64 {
    if end.is_nan() { f64::NEG_INFINITY } else { end.next_down() }
}

/// The next number above an upper end that was rounded once.
fn upper(end: f64) -> f64 {
    -lower(-end)
}

/// A number below a lower end that a library function computed.
fn below(end: f64) -> f64 {
    if end.is_infinite() { lower(end) } else { lower(end - (end.abs() * MARGIN).max(LEAST_MARGIN)) }
}

/// A number above an upper end that a library function computed.
fn above(end: f64) -> f64 {
    -below(-end)
}

impl Number for Interval {
    fn constant(value: f64) -> Self {
        Self::new(value, value)
    }

    fn neg(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo }
    }
    fn abs(self) -> Self {
        if self.lo >= 0.0 {
            self
        } else if self.hi <= 0.0 {
            self.neg()
        } else {
            Self { lo: 0.0, hi: self.magnitude() }
        }
    }
    fn sign(self) -> Self {
        Self { lo: Number::sign(self.lo), hi: Number::sign(self.hi) }
    }
    fn floor(self) -> Self {
        Self { lo: self.lo.floor(), hi: self.hi.floor() }
    }
    fn ceil(self) -> Self {
        Self { lo: self.lo.ceil(), hi: self.hi.ceil() }
    }
    fn round(self) -> Self {
        Self { lo: Number::round(self.lo), hi: Number::round(self.hi) }
    }
    fn trunc(self) -> Self {
        Self { lo: self.lo.trunc(), hi: self.hi.trunc() }
    }
    fn square(self) -> Self {
        let Self { lo, hi } = self.abs();
        // The square of 0 is 0.
        Self { lo: lower(lo * lo).max(0.0), hi: if hi == 0.0 { 0.0 } else { upper(hi * hi) } }
    }
    fn sqrt(self) -> Self {
        self.root()
    }
    fn inverse_sqrt(self) -> Self {
        self.inverse_root()
    }
    fn exp(self) -> Self {
        self.increasing(libm::exp).clipped(0.0, f64::INFINITY)
    }
    fn exp2(self) -> Self {
        self.increasing(libm::exp2).clipped(0.0, f64::INFINITY)
    }
    fn log(self) -> Self {
        self.logarithm(libm::log)
    }
    fn log2(self) -> Self {
        self.logarithm(libm::log2)
    }
    fn sin(self) -> Self {
        self.sine()
    }
    fn cos(self) -> Self {
        self.cosine()
    }
    fn tan(self) -> Self {
        self.tangent()
    }
    fn asin(self) -> Self {
        self.arc_sine()
    }
    fn acos(self) -> Self {
        self.arc_cosine()
    }
    fn atan(self) -> Self {
        self.increasing(libm::atan)
    }
    fn sinh(self) -> Self {
        self.increasing(libm::sinh)
    }
    fn cosh(self) -> Self {
        Number::abs(self).increasing(libm::cosh)
    }
    fn tanh(self) -> Self {
        self.increasing(libm::tanh).clipped(-1.0, 1.0)
    }
    fn not(self) -> Self {
        Self { lo: 1.0 - self.hi, hi: 1.0 - self.lo }
    }

    fn add(self, y: Self) -> Self {
        self.sum(y)
    }
    fn sub(self, y: Self) -> Self {
        self.sum(y.neg())
    }
    fn mul(self, y: Self) -> Self {
        self.product(y)
    }
    fn div(self, y: Self) -> Self {
        self.quotient(y)
    }
    fn min(self, y: Self) -> Self {
        Self { lo: self.lo.min(y.lo), hi: self.hi.min(y.hi) }
    }
    fn max(self, y: Self) -> Self {
        Self { lo: self.lo.max(y.lo), hi: self.hi.max(y.hi) }
    }
    fn pow(self, y: Self) -> Self {
        self.power(y)
    }
    fn atan2(self, x: Self) -> Self {
        self.angle(x)
    }
    fn step(self, x: Self) -> Self {
        Self::truth(x.lo >= self.hi, x.hi < self.lo)
    }
    fn hash(self, x: Self) -> Self {
        let whole = x.floor();
        if self.lo == self.hi && whole.lo == whole.hi {
            return Self::constant(hash(self.lo, whole.lo));
        }
        Self { lo: 0.0, hi: HASH_COUNT - 1.0 }
    }
    fn normalize_lane(self, length: Self) -> Self {
        self.component(length)
    }
    fn lt(self, y: Self) -> Self {
        Self::truth(self.hi < y.lo, self.lo >= y.hi)
    }
    fn le(self, y: Self) -> Self {
        Self::truth(self.hi <= y.lo, self.lo > y.hi)
    }
    fn eq(self, y: Self) -> Self {
        let one = self.lo == self.hi && y.lo == y.hi && self.lo == y.lo;
        Self::truth(one, self.hi < y.lo || self.lo > y.hi)
    }
    fn ne(self, y: Self) -> Self {
        Number::eq(self, y).not()
    }
    fn and(self, y: Self) -> Self {
        Number::min(self, y)
    }
    fn or(self, y: Self) -> Self {
        Number::max(self, y)
    }

    fn is_definitely_false(self) -> bool {
        self.hi == 0.0
    }
    fn jump_slope(self) -> Self {
        if self.lo == self.hi { Self::FALSE } else { Self::ENTIRE }
    }
    fn element(self, list: &[f64]) -> Self {
        let last = list.len().saturating_sub(1);
        let index = |end: f64| (end.max(0.0) as usize).min(last);
        let found = list.get(index(self.lo)..=index(self.hi)).unwrap_or_default();
        let values = found.iter().map(|&value| Self::constant(value));
        values.reduce(Self::hull).unwrap_or(Self::ENTIRE)
    }

    fn fract_with_floor(self, whole: Self) -> Self {
        self.sub(whole).clipped(0.0, 1.0)
    }
    fn rem_with_quotient(self, y: Self, whole: Self) -> Self {
        self.remainder(y, whole)
    }
    fn mix(self, y: Self, t: Self) -> Self {
        self.mixture(y, t)
    }
    fn clamp(self, lo: Self, hi: Self) -> Self {
        Number::min(Number::max(self, lo), hi)
    }
    fn smoothstep(self, hi: Self, x: Self) -> Self {
        let width = hi.sub(self);
        if width.contains(0.0) {
            return Self::UNDECIDED; // a jump: f64 divides a finite number by 0
        }
        let t = x.sub(self).div(width).saturate();
        t.increasing(|t| t * t * (3.0 - 2.0 * t)).grown(MARGIN)
    }
    fn clamp_residual(self, lo: Self, hi: Self) -> Self {
        // Each end is subtracted once, so within the range this is exactly 0. Where the ends are
        // out of order the upper one counts, as in `clamp`.
        let below = Number::min(self.sub(lo), Self::new(0.0, 0.0));
        Number::max(self.sub(hi), below)
    }
    fn x_times_one_minus_x(self, y: Self, c: Self) -> Self {
        self.x_times_complement(y, c)
    }
    fn select(self, yes: Self, no: Self) -> Self {
        if self.contains(0.0) { if self == Self::FALSE { no } else { yes.hull(no) } } else { yes }
    }
}
