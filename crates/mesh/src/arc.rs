//! Circular arcs between two points, by their bulge.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::polygon::Point;

/// A segment from one point to another: a line if its bulge is 0, else an arc.
///
/// The bulge is the tangent of a quarter of the arc's angle, positive for counter-clockwise arcs:
/// the arc's greatest distance from the line, divided by half the length of the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment {
    pub(crate) ends: [Point; 2],
    pub(crate) bulge: f64,
}

/// An arc with a smaller bulge is a line.
const FLAT: f64 = 1e-12;
/// An arc is divided into at most this many lines.
const MOST_LINES: f64 = 4096.0;

impl Segment {
    fn half_length(&self) -> f64 {
        let [a, b] = self.ends;
        0.5 * (b[0] - a[0]).hypot(b[1] - a[1])
    }

    /// Returns the angle of the arc, positive if it is counter-clockwise.
    pub(crate) fn angle(&self) -> f64 {
        4.0 * self.bulge.atan()
    }

    /// Returns the radius; infinite for a line.
    pub(crate) fn radius(&self) -> f64 {
        self.half_length() * (1.0 + self.bulge * self.bulge) / (2.0 * self.bulge.abs())
    }

    pub(crate) fn length(&self) -> f64 {
        if self.bulge.abs() < FLAT {
            2.0 * self.half_length()
        } else {
            self.angle().abs() * self.radius()
        }
    }

    /// Returns the area between the arc and its line, positive if the arc is counter-clockwise.
    pub(crate) fn area(&self) -> f64 {
        let (half, angle) = (self.half_length(), self.angle());
        if self.bulge.abs() < 1e-4 {
            // The exact formula cancels. A parabola has two thirds of the area of its box.
            return 4.0 / 3.0 * half * half * self.bulge;
        }
        0.5 * self.radius().powi(2) * (angle - angle.sin())
    }

    /// Returns the point at a part of the arc's angle from its start.
    pub(crate) fn at(&self, part: f64) -> Point {
        let [a, b] = self.ends;
        let chord = [b[0] - a[0], b[1] - a[1]];
        if self.bulge.abs() < FLAT {
            return [a[0] + part * chord[0], a[1] + part * chord[1]];
        }
        // The chord to the point is that to the end, turned back and shorter.
        let (turned, whole) = (0.5 * (part - 1.0) * self.angle(), 0.5 * self.angle());
        let scale = (part * whole).sin() / whole.sin();
        let (sine, cosine) = turned.sin_cos();
        [
            a[0] + scale * (cosine * chord[0] - sine * chord[1]),
            a[1] + scale * (sine * chord[0] + cosine * chord[1]),
        ]
    }

    /// Returns the start, and the points where the arc is farthest along an axis.
    pub(crate) fn extremes(&self) -> impl Iterator<Item = Point> + use<> {
        let [a, b] = self.ends;
        let this = *self;
        // The direction of the arc at its start, and how far it turns.
        let start = (b[1] - a[1]).atan2(b[0] - a[0]) - 0.5 * self.angle();
        let angle = self.angle();
        let turned = (0..4).filter_map(move |quarter| {
            let to = f64::from(quarter) * FRAC_PI_2 - start;
            let part =
                if angle > 0.0 { to.rem_euclid(TAU) } else { to.rem_euclid(TAU) - TAU } / angle;
            (angle != 0.0 && part < 1.0).then(|| this.at(part))
        });
        std::iter::once(a).chain(turned)
    }

    /// Returns the starts of lines that are within a distance of the arc. Their ends are the next
    /// starts and the end of the arc.
    pub(crate) fn lines(&self, distance: f64) -> impl Iterator<Item = Point> + use<> {
        let angle = self.angle().abs();
        let step = 2.0 * (1.0 - distance / self.radius()).clamp(-1.0, 1.0).acos();
        let is_flat = self.bulge.abs() < FLAT;
        let count = if is_flat { 1.0 } else { (angle / step).ceil().clamp(1.0, MOST_LINES) };
        let this = *self;
        (0..count as u32).map(move |index| this.at(f64::from(index) / count))
    }

    /// Returns how far a point is from the circle of the arc, positive on the outer side of a
    /// counter-clockwise arc and on the inner side of a clockwise one: to the right of the path.
    pub(crate) fn right_of(&self, point: Point) -> f64 {
        let [a, b] = self.ends;
        let half = self.half_length();
        let along = [(b[0] - a[0]) / (2.0 * half), (b[1] - a[1]) / (2.0 * half)];
        let from = [point[0] - 0.5 * (a[0] + b[0]), point[1] - 0.5 * (a[1] + b[1])];
        let u = from[0] * along[0] + from[1] * along[1];
        let v = from[0] * along[1] - from[1] * along[0];
        if self.bulge.abs() < FLAT {
            return v;
        }
        // The circle's equation over the radius and the distance, so that flat arcs do not cancel.
        let sagitta = self.bulge * half;
        let center = 0.5 * (sagitta - half / self.bulge);
        let radius = self.radius();
        let power = u * u + v * v - half * half - 2.0 * v * center;
        let away = u.hypot(v - center);
        power / (away + radius) * self.bulge.signum()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }

    #[test]
    fn a_bulge_of_1_is_a_half_circle_on_the_right_of_its_line() {
        let half = Segment { ends: [[-2.0, 0.0], [2.0, 0.0]], bulge: 1.0 };
        close(half.radius(), 2.0);
        close(half.length(), 2.0 * PI);
        close(half.area(), 2.0 * PI);
        let [x, y] = half.at(0.5);
        close(x, 0.0);
        close(y, -2.0);
        let [x, y] = half.at(0.25);
        close(x, -2f64.sqrt());
        close(y, -2f64.sqrt());
        for part in [0.0, 0.1, 0.7, 1.0] {
            close(half.right_of(half.at(part)), 0.0);
        }
        close(half.right_of([0.0, -2.5]), 0.5);
        close(half.right_of([0.0, -1.5]), -0.5);
    }

    #[test]
    fn an_arc_reaches_to_its_extremes() {
        let arc = Segment { ends: [[-1.0, 0.0], [1.0, 0.0]], bulge: -0.5 };
        let highest = arc.extremes().map(|[_, y]| y).fold(0.0, f64::max);
        close(highest, 0.5);
        assert_eq!(arc.extremes().count(), 2);
        let line = Segment { bulge: 0.0, ..arc };
        assert_eq!(line.extremes().count(), 1);
    }

    #[test]
    fn an_arc_and_its_reverse_are_the_same_curve() {
        let arc = Segment { ends: [[1.0, 2.0], [4.0, 3.0]], bulge: -0.3 };
        let reverse = Segment { ends: [[4.0, 3.0], [1.0, 2.0]], bulge: 0.3 };
        close(arc.length(), reverse.length());
        close(arc.area(), -reverse.area());
        let ([x, y], [u, v]) = (arc.at(0.3), reverse.at(0.7));
        close(x, u);
        close(y, v);
        close(arc.right_of([2.0, 9.0]), -reverse.right_of([2.0, 9.0]));
    }

    #[test]
    fn a_flat_arc_is_nearly_a_line() {
        let [line, arc] =
            [0.0, 1e-9].map(|bulge| Segment { ends: [[0.0, 0.0], [1.0, 1.0]], bulge });
        let point = [0.3, 0.8];
        assert!((line.right_of(point) - arc.right_of(point)).abs() < 1e-8);
        assert!((line.length() - arc.length()).abs() < 1e-8);
    }

    #[test]
    fn lines_stay_within_their_distance() {
        let arc = Segment { ends: [[0.0, 0.0], [1.0, 1.0]], bulge: 0.5 };
        let mut points: Vec<Point> = arc.lines(1e-3).collect();
        points.push(arc.ends[1]);
        assert!(points.len() > 10);
        for pair in points.windows(2) {
            let middle = [0.5 * (pair[0][0] + pair[1][0]), 0.5 * (pair[0][1] + pair[1][1])];
            let away = arc.right_of(middle).abs();
            assert!((0.5e-3..=1e-3).contains(&away), "{away}");
        }
    }
}
