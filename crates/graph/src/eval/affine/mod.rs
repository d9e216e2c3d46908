//! Affine arithmetic: bounds of a field in a box that may be rotated.

mod arithmetic;
mod functions;
mod path;

use crate::eval::{Interval, Number};

/// Relative bound of the rounding errors of one operation on affine forms.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Absolute bound of what underflow takes from the terms of one operation.
const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// Returns what underflow may take from the terms of a form of a size. A form that is exactly 0 has
/// no terms, and stays exact.
fn underflow(size: f64) -> f64 {
    if size == 0.0 { 0.0 } else { UNDERFLOW }
}

/// The least slope of which underflow takes no more than rounding does.
const LEAST_SLOPE: f64 = f64::MIN_POSITIVE / f64::EPSILON;

/// A number over a box, as an affine function of the box's coordinates and a bound of the rest.
///
/// The value at the coordinates `t`, each from -1 to 1, is `center + slopes * t`, with an error of
/// at most `error`; it also lies in `range`. Where the formula is smooth, the error shrinks with
/// the square of the box, and that of an [`Interval`] only with the box.
#[derive(Clone, Copy, Debug)]
pub struct Affine {
    center: f64,
    slopes: [f64; 3],
    error: f64,
    range: Interval,
}

impl Affine {
    /// Returns the coordinate of a point in a box: `center` in the middle, changing by `slopes`
    /// to the ends of the box's three axes.
    pub fn coordinate(center: f64, slopes: [f64; 3]) -> Self {
        Self::new(center, slopes, 0.0, Interval::ENTIRE)
    }

    /// Returns `center`, `slopes` and `error`: the value at the coordinates `t`, each from -1 to 1,
    /// is `center + slopes * t`, with an error of at most `error`.
    pub fn terms(self) -> (f64, [f64; 3], f64) {
        (self.center, self.slopes, self.error)
    }

    /// Returns the range of the values.
    pub fn range(self) -> Interval {
        self.range
    }

    /// Makes a form, with an error that covers the rounding of its terms, and with the smaller of
    /// both ranges. A form that is no number is replaced by its range.
    fn new(center: f64, slopes: [f64; 3], error: f64, range: Interval) -> Self {
        let reach = slopes.iter().map(|slope| slope.abs()).sum::<f64>();
        let size = center.abs() + reach + error;
        let error = error + ROUNDING * size + underflow(size);
        let radius = (reach + error) * (1.0 + ROUNDING);
        if !(center + radius).is_finite() {
            return Self::from_range(range);
        }
        let margin = ROUNDING * (center.abs() + radius);
        let lo = (center - radius - margin).max(range.lo());
        let hi = (center + radius + margin).min(range.hi());
        // Out of order only where the formula is undefined.
        let range = if lo <= hi { Interval::new(lo, hi) } else { range };
        Self { center, slopes, error, range }
    }

    /// Makes a form of which only the range is known.
    fn from_range(range: Interval) -> Self {
        let center = 0.5 * range.lo() + 0.5 * range.hi();
        let error = (0.5 * range.hi() - 0.5 * range.lo()) * (1.0 + ROUNDING)
            + ROUNDING * range.magnitude()
            + underflow(range.magnitude());
        if error.is_finite() && center.is_finite() {
            Self { center, slopes: [0.0; 3], error, range }
        } else {
            Self { center: 0.0, slopes: [0.0; 3], error: f64::INFINITY, range }
        }
    }

    /// Returns the greatest distance of a value from the center.
    fn radius(self) -> f64 {
        self.slopes.iter().map(|slope| slope.abs()).sum::<f64>() + self.error
    }

    /// Returns a bound of the absolute value; 0 only for the number 0.
    fn size(self) -> f64 {
        self.center.abs() + self.radius()
    }

    /// Returns `scale * self + offset`, where `offset` is an interval.
    fn scaled(self, scale: f64, offset: Interval, range: Interval) -> Self {
        let shift = Self::from_range(offset);
        let center = scale * self.center + shift.center;
        let error = scale.abs() * self.error + shift.error;
        Self::new(center, self.slopes.map(|slope| scale * slope), error, range)
    }

    /// Returns a function of the number, given its derivative over the range and its range.
    ///
    /// By the mean value theorem, the function differs from its tangent with the middle slope by
    /// at most half of the slope's width times the distance from the middle.
    fn smooth(self, f: impl Fn(Interval) -> Interval, slope: Interval) -> Self {
        let range = f(self.range);
        let scale = 0.5 * slope.lo() + 0.5 * slope.hi();
        let width = 0.5 * (self.range.hi() - self.range.lo());
        if !scale.is_finite() || !width.is_finite() || slope.magnitude() < LEAST_SLOPE {
            return Self::from_range(range);
        }
        let middle = self.range.lo() + width;
        let bend = (0.5 * slope.hi() - 0.5 * slope.lo()) * width * (1.0 + 2.0 * ROUNDING)
            + ROUNDING * scale.abs() * (width + middle.abs());
        let at_middle = f(Interval::constant(middle));
        let tangent = at_middle.sub(Interval::constant(scale).mul(Interval::constant(middle)));
        self.scaled(scale, tangent.add(Interval::new(-bend, bend)), range)
    }

    /// Returns a form that covers both.
    fn hull(self, other: Self) -> Self {
        let range = self.range.hull(other.range);
        let difference = self.minus(other);
        let half = 0.5 * difference.range.lo().abs().max(difference.range.hi().abs());
        let middle = self.plus(other);
        let slopes = middle.slopes.map(|slope| 0.5 * slope);
        Self::new(0.5 * middle.center, slopes, 0.5 * middle.error + half, range)
    }

    fn plus(self, y: Self) -> Self {
        let slopes = std::array::from_fn(|axis| self.slopes[axis] + y.slopes[axis]);
        let error = self.error + y.error;
        Self::new(self.center + y.center, slopes, error, self.range.add(y.range))
    }

    fn minus(self, y: Self) -> Self {
        let slopes = std::array::from_fn(|axis| self.slopes[axis] - y.slopes[axis]);
        let error = self.error + y.error;
        Self::new(self.center - y.center, slopes, error, self.range.sub(y.range))
    }

    fn times(self, y: Self) -> Self {
        let slopes =
            std::array::from_fn(|axis| self.center * y.slopes[axis] + y.center * self.slopes[axis]);
        let error = self.center.abs() * y.error
            + y.center.abs() * self.error
            + self.radius() * y.radius() * (1.0 + ROUNDING)
            + underflow(self.size()).min(underflow(y.size()));
        Self::new(self.center * y.center, slopes, error, self.range.mul(y.range))
    }

    /// Returns the same form within a smaller range.
    fn within(self, range: Interval) -> Self {
        Self::new(self.center, self.slopes, self.error, range)
    }
}

#[cfg(test)]
mod tests;
