//! Sums, products, quotients, remainders and mixtures.

use super::{Interval, MARGIN, lower, upper};
use crate::eval::Number;

/// Smallest product whose exactness can be checked: the rounding error of a smaller one may
/// underflow.
const LEAST_CHECKED: f64 = 1e-200;

impl Interval {
    pub(super) fn sum(self, y: Self) -> Self {
        Self { lo: sum_below(self.lo, y.lo), hi: -sum_below(-self.hi, -y.hi) }
    }

    pub(super) fn product(self, y: Self) -> Self {
        if self.lo == self.hi && y.lo == y.hi {
            // Indices into lists are products of whole numbers, and one that is rounded down
            // selects the element before.
            let exact = product(self.lo, y.lo);
            let is_zero = self.lo == 0.0 || y.lo == 0.0;
            if is_zero || exact.abs() > LEAST_CHECKED && self.lo.mul_add(y.lo, -exact) == 0.0 {
                return Self { lo: exact, hi: exact };
            }
        }
        // Rounding keeps the order of products, so the signs say which ends give the extremes.
        let (x_positive, y_positive) = (self.lo >= 0.0, y.lo >= 0.0);
        let (x_negative, y_negative) = (self.hi <= 0.0, y.hi <= 0.0);
        if x_positive && y_positive {
            positive(product(self.lo, y.lo), product(self.hi, y.hi))
        } else if x_negative && y_negative {
            positive(product(self.hi, y.hi), product(self.lo, y.lo))
        } else if x_positive && y_negative {
            negative(product(self.hi, y.lo), product(self.lo, y.hi))
        } else if x_negative && y_positive {
            negative(product(self.lo, y.hi), product(self.hi, y.lo))
        } else {
            let lo = product(self.lo, y.hi).min(product(self.hi, y.lo));
            let hi = product(self.lo, y.lo).max(product(self.hi, y.hi));
            Self { lo: lower(lo), hi: upper(hi) }
        }
    }

    /// The quotient. A divisor with 0 at one end makes one side unbounded, a divisor with 0 inside
    /// both sides.
    pub(super) fn quotient(self, y: Self) -> Self {
        if y.hi <= 0.0 {
            return self.neg().quotient_by_positive(y.neg());
        }
        self.quotient_by_positive(y)
    }

    fn quotient_by_positive(self, y: Self) -> Self {
        if self.lo == self.hi && y.lo == y.hi && y.lo > 0.0 {
            // Code that counts relies on exact quotients of whole numbers.
            let exact = self.lo / y.lo;
            if exact.mul_add(-y.lo, self.lo) == 0.0 {
                return Self { lo: exact, hi: exact };
            }
        }
        if y.lo > 0.0 {
            if self.lo >= 0.0 {
                positive(quotient(self.lo, y.hi), quotient(self.hi, y.lo))
            } else if self.hi <= 0.0 {
                negative(quotient(self.lo, y.lo), quotient(self.hi, y.hi))
            } else {
                let lo = lower(quotient(self.lo, y.lo));
                Self { lo, hi: upper(quotient(self.hi, y.lo)) }
            }
        } else if y.lo < 0.0 || y.hi <= 0.0 {
            Self::ENTIRE
        } else if self.lo >= 0.0 {
            Self { lo: lower(quotient(self.lo, y.hi)).max(0.0), hi: f64::INFINITY }
        } else if self.hi <= 0.0 {
            Self { lo: f64::NEG_INFINITY, hi: upper(quotient(self.hi, y.hi)).min(0.0) }
        } else {
            Self::ENTIRE
        }
    }

    /// `x - y * n` if the quotient's floor is one whole number n, else the range between 0 and y.
    /// In f64 `x - y * floor(x / y)` leaves that range by an error that grows with x.
    pub(super) fn remainder(self, y: Self, whole: Self) -> Self {
        if y.contains(0.0) {
            return Self::ENTIRE;
        }
        if whole.lo == whole.hi {
            return self.sub(y.product(whole));
        }
        let between = Self { lo: y.lo.min(0.0), hi: y.hi.max(0.0) };
        between.grown(MARGIN * (self.magnitude() + y.magnitude()))
    }

    /// A component of a vector, divided by the vector's length, which is at least the component's
    /// magnitude; 0 divided by 0 is 0.
    pub(super) fn component(self, length: Self) -> Self {
        // If the squares are subnormal, a computed length is off by up to a third.
        let limit = if length.lo > 1e-150 { 1.0 + MARGIN } else { 1.5 };
        let ratio = if length.lo > 0.0 { self.quotient(length) } else { Self::ENTIRE };
        let lo = if self.lo >= 0.0 { 0.0 } else { -limit };
        let hi = if self.hi <= 0.0 { 0.0 } else { limit };
        ratio.clipped(lo, hi)
    }

    /// `x * (1 - t) + y * t`. For t from 0 to 1 it increases with x and y and is linear in t, so
    /// its extremes are at ends, also when rounded, up to a margin relative to the terms.
    pub(super) fn mixture(self, y: Self, t: Self) -> Self {
        if t.lo < 0.0 || t.hi > 1.0 {
            return self.product(Self::TRUE.sum(t.neg())).sum(y.product(t));
        }
        Self { lo: mixture_below(self.lo, y.lo, t), hi: -mixture_below(-self.hi, -y.hi, t) }
    }
}

impl Interval {
    /// `x * y` for `y = c * (1 - x)`: `x * (1 - x)` is extreme at the ends of x, and 1/4 at 1/2.
    pub(super) fn x_times_complement(self, y: Self, c: Self) -> Self {
        let apart = self.product(y);
        let at = |x: f64| x * (1.0 - x);
        let (a, b) = (at(self.lo), at(self.hi));
        let top = if self.contains(0.5) { 0.25 } else { a.max(b) };
        let rounding = MARGIN * self.magnitude() * y.magnitude();
        let together = Self::new(a.min(b), top).widened().product(c).grown(rounding);
        let (lo, hi) = (apart.lo.max(together.lo), apart.hi.min(together.hi));
        if lo <= hi { Self { lo, hi } } else { apart }
    }
}

/// A lower bound of the mixtures of two lower ends, for t from 0 to 1.
fn mixture_below(x: f64, y: f64, t: Interval) -> f64 {
    let mixed = |t: f64| product(x, 1.0 - t) + product(y, t);
    let (first, last) = (mixed(t.lo), mixed(t.hi));
    if first.is_nan() || last.is_nan() {
        return f64::NEG_INFINITY;
    }
    let size = |end: f64| if end.is_finite() { end.abs() } else { 0.0 };
    lower(first.min(last) - MARGIN * (size(x) + size(y)))
}

/// The sum, rounded down unless Knuth's two-sum shows it to be exact.
fn sum_below(a: f64, b: f64) -> f64 {
    let sum = a + b;
    let part = sum - a;
    let error = (a - (sum - part)) + (b - part);
    if !sum.is_finite() {
        return infinite_or_below(sum, a, b);
    }
    // The next number below has the next lower bits, or above 0 higher ones. Half of all sums are
    // rounded up, in no order, so a branch would often be predicted wrongly. A sum of 0 is exact.
    let bits = sum.to_bits() as i64;
    let away = 1 | (bits >> 63);
    let is_above = i64::from(error >= 0.0) ^ 1;
    f64::from_bits((bits - away * is_above) as u64)
}

/// The sum itself if it is infinite because a term is, else the next number below.
fn infinite_or_below(sum: f64, a: f64, b: f64) -> f64 {
    if sum == f64::INFINITY && (a.is_infinite() || b.is_infinite()) { sum } else { lower(sum) }
}

/// A product of ends. An infinite end is never reached, so 0 times it is 0.
fn product(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// A quotient of ends. It is 0 for two infinite ones, since other ends then give the other extreme.
fn quotient(a: f64, b: f64) -> f64 {
    if a.is_infinite() && b.is_infinite() { 0.0 } else { a / b }
}

/// The interval between two rounded ends of which neither is negative.
fn positive(lo: f64, hi: f64) -> Interval {
    Interval { lo: lower(lo).max(0.0), hi: upper(hi) }
}

/// The interval between two rounded ends of which neither is positive.
fn negative(lo: f64, hi: f64) -> Interval {
    Interval { lo: lower(lo), hi: upper(hi).min(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_sums_of_whole_numbers_are_exact() {
        let one = |x: i32| Interval::constant(f64::from(x));
        for (x, y) in [(0, 16), (16, 0), (-3, 0), (0, 0), (7, -5), (16, 12)] {
            assert_eq!(one(x).mul(one(y)), one(x * y), "{x} * {y}");
            assert_eq!(one(x).mul(one(16)).add(one(y)), one(16 * x + y), "16 * {x} + {y}");
        }
    }
    /// Each pair of ends in order, with ends that are 0, infinite, or near the limits of f64.
    fn awkward() -> impl Iterator<Item = Interval> + Clone {
        let ends =
            [f64::NEG_INFINITY, -f64::MAX, -3.0, -0.1, -1e-310, 0.0, 5e-324, 0.3, 7.0, 1e300]
                .into_iter()
                .chain([f64::INFINITY]);
        ends.clone().flat_map(move |lo| {
            ends.clone().filter(move |&hi| lo <= hi).map(move |hi| Interval { lo, hi })
        })
    }

    fn all_pairs() -> impl Iterator<Item = (Interval, Interval)> {
        awkward().flat_map(|x| awkward().map(move |y| (x, y)))
    }

    fn ends([x, y]: [Interval; 2], op: impl Fn(f64, f64) -> f64) -> [f64; 2] {
        let all = [op(x.lo, y.lo), op(x.lo, y.hi), op(x.hi, y.lo), op(x.hi, y.hi)];
        [
            all.into_iter().fold(f64::INFINITY, f64::min),
            all.into_iter().fold(-f64::INFINITY, f64::max),
        ]
    }

    #[test]
    fn products_and_quotients_span_those_of_all_ends() {
        for (x, y) in all_pairs() {
            let mut found = vec![(x.mul(y), ends([x, y], product), "*")];
            if y.lo > 0.0 {
                found.push((x.div(y), ends([x, y], quotient), "/"));
            }
            for (Interval { lo, hi }, [least, greatest], op) in found {
                // One step from the extremes, or none where the signs or exactness allow it.
                assert!(lo == least || lo == least.next_down(), "{x:?} {op} {y:?}: {lo}");
                assert!(hi == greatest || hi == greatest.next_up(), "{x:?} {op} {y:?}: {hi}");
            }
        }
    }

    #[test]
    fn sums_are_rounded_outward_unless_they_are_exact() {
        for (x, y) in all_pairs() {
            let Interval { lo, hi } = x.add(y);
            let sums = [(lo, x.lo, y.lo), (-hi, -x.hi, -y.hi)];
            for (end, a, b) in sums.into_iter().filter(|(_, a, b)| (a + b).is_finite()) {
                // The error of a rounded sum is a number of f64.
                let part = (a + b) - a;
                let error = (a - ((a + b) - part)) + (b - part);
                let expected = if error < 0.0 { (a + b).next_down() } else { a + b };
                assert_eq!(end, expected, "{a} + {b}");
            }
        }
    }
}
