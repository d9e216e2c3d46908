//! The part of a cube on one side of a plane.

use sdfc_graph::eval::Interval;

/// A slope below this fraction of the greatest one counts as an error, because the formula divides
/// by the product of all slopes.
const WEAK: f64 = 1e-3;
/// More than the rounding error of the formula, whose terms are at most `1 / WEAK^2` in size.
const ROUNDING: f64 = 1e-8;

/// The knowledge about the inside of a box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Share {
    /// The part of the box that is inside, from 0 to 1.
    pub(crate) inside: Interval,
    /// The estimated area of the surface in the box, in volumes of the box: to be multiplied by the
    /// length of the gradient of `center + slopes * t`.
    pub(crate) density: f64,
}

impl Share {
    /// Returns what follows if the sign in a box is that of `center + slopes * t` wherever this is
    /// farther from 0 than an error. The coordinates `t` of the box are from -1 to 1.
    ///
    /// So the inside contains one half-space and is contained in another.
    pub(crate) fn of(center: f64, slopes: [f64; 3], mut error: f64) -> Self {
        let sizes = slopes.map(f64::abs);
        let greatest = sizes.iter().fold(0.0, |a: f64, b| a.max(*b));
        let mut strong = Vec::with_capacity(3);
        for size in sizes {
            if size > WEAK * greatest { strong.push(size) } else { error += size }
        }
        if !(error.is_finite() && center.is_finite()) {
            return Self { inside: Interval::new(0.0, 1.0), density: 0.0 };
        }
        let least = part_below(center + error, &strong) - ROUNDING;
        let most = part_below(center - error, &strong) + ROUNDING;
        let inside = Interval::new(least.clamp(0.0, 1.0), most.clamp(0.0, 1.0));
        Self { inside, density: density(center, &strong) }
    }
}

/// Returns the part of the coordinates, each from -1 to 1, where `center + slopes * t` is below 0
/// (Barrow and Smith, "Spline Notation Applied to a Volume Problem", 1979).
fn part_below(center: f64, slopes: &[f64]) -> f64 {
    match slopes.len() {
        0 => f64::from(u8::from(center < 0.0)),
        _ if is_below(center, slopes) => 1.0,
        count => truncated(center, slopes, count as i32).clamp(0.0, 1.0),
    }
}

/// Returns the derivative of [`part_below`] by `-center`.
fn density(center: f64, slopes: &[f64]) -> f64 {
    match slopes.len() {
        0 => 0.0,
        _ if is_below(center, slopes) => 0.0,
        count => truncated(center, slopes, count as i32 - 1).max(0.0),
    }
}

/// True if `center + slopes * t` is below 0 everywhere. Far from 0, the powers of [`truncated`]
/// would be too large to cancel each other.
fn is_below(center: f64, slopes: &[f64]) -> bool {
    center <= -slopes.iter().sum::<f64>()
}

/// Returns the sum of truncated powers over the corners of a cube, divided by the factorial of the
/// power and by the product of the slopes.
fn truncated(center: f64, slopes: &[f64], power: i32) -> f64 {
    let sum: f64 = slopes.iter().sum();
    let product: f64 = slopes.iter().map(|slope| 2.0 * slope).product();
    let mut total = 0.0;
    for corner in 0..1u32 << slopes.len() {
        let chosen = slopes.iter().enumerate().filter(|(i, _)| corner >> i & 1 == 1);
        let above = sum - center - chosen.map(|(_, slope)| 2.0 * slope).sum::<f64>();
        let term = if above <= 0.0 { 0.0 } else { above.powi(power) };
        total += if corner.count_ones() % 2 == 0 { term } else { -term };
    }
    let factorial = f64::from([1, 1, 2, 6][power as usize]);
    total / (factorial * product)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_far_above_the_slopes_tells_nothing() {
        // The bounds of a polygon with many corners over a large box.
        let Share { inside, .. } = Share::of(5e8, [7e-8, 2e-8, -1e-15], 2.5e9);
        assert_eq!([inside.lo(), inside.hi()], [0.0, 1.0]);
        let Share { inside, density } = Share::of(-5e8, [7e-8, 2e-8, 3e-8], 1.0);
        assert!(inside.lo() > 0.99, "{inside:?}");
        assert_eq!(density, 0.0);
    }

    #[test]
    fn the_part_below_a_plane_is_right() {
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        close(part_below(0.0, &[1.0]), 0.5);
        close(part_below(-0.5, &[1.0]), 0.75);
        close(part_below(0.0, &[1.0, 0.3, 0.2]), 0.5);
        // A corner: a pyramid whose edges are half as long as those of the cube.
        close(part_below(2.0, &[1.0; 3]), 1.0 / 48.0);
        close(part_below(-2.0, &[1.0; 3]), 47.0 / 48.0);
        close(part_below(4.0, &[1.0; 3]), 0.0);
        let step = 1e-6;
        let slopes = [1.0, 0.4, 0.1];
        let slope = part_below(0.2 - step, &slopes) - part_below(0.2 + step, &slopes);
        assert!((density(0.2, &slopes) - slope / (2.0 * step)).abs() < 1e-6);
    }
}
