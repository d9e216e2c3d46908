//! Closed paths of lines and arcs.

use crate::arc::Segment;
use crate::polygon::{self, Point};

/// An arc takes the place of at least this many lines.
const FEWEST_LINES: usize = 2;
/// An arc bends at least this often as far as it may be from its points. Others are straight edges
/// with a part of the next curve.
const LEAST_BEND: f64 = 2.0;
/// There are at least this many points between the ends of an arc.
const FEWEST_POINTS: usize = 3;
/// The greatest bulge. Such an arc turns by 124 degrees, so it is a graph over its line.
const MOST_BULGE: f64 = 0.6;
/// Steps of the search for a bulge.
const STEPS: usize = 40;

/// A closed path of lines and arcs.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Curve {
    pub(crate) points: Vec<Point>,
    /// The bulge of the segment from each point to the next one; see [`Segment`].
    pub(crate) bulges: Vec<f64>,
}

impl Curve {
    /// Returns the path of lines through points.
    pub(crate) fn of_lines(points: Vec<Point>) -> Self {
        let bulges = vec![0.0; points.len()];
        Self { points, bulges }
    }

    pub(crate) fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        segments(&self.points, &self.bulges)
    }

    pub(crate) fn has_arcs(&self) -> bool {
        self.bulges.iter().any(|bulge| *bulge != 0.0)
    }

    /// Returns lines that are within a distance of the path.
    pub(crate) fn lines(&self, distance: f64) -> Vec<Point> {
        self.segments().flat_map(|segment| segment.lines(distance)).collect()
    }

    /// Returns the sides of triangles that hold all arcs, and all lines. The triangles stand on
    /// lines that are within a distance of the arcs.
    pub(crate) fn hull(&self, distance: f64) -> Vec<[Point; 2]> {
        let mut sides = Vec::new();
        for segment in self.segments() {
            let mut starts: Vec<Point> = segment.lines(distance).collect();
            starts.push(segment.ends[1]);
            // The bulge of a part of the arc, from its angle.
            let bulge = (segment.bulge.atan() / (starts.len() - 1) as f64).tan();
            for pair in starts.windows(2) {
                let ends = [pair[0], pair[1]];
                sides.push(ends);
                if bulge != 0.0 {
                    let tip = tip(ends, bulge);
                    sides.extend([[ends[0], tip], [tip, ends[1]]]);
                }
            }
        }
        sides
    }
}

/// Returns the segments of a closed path.
pub(crate) fn segments<'a>(
    points: &'a [Point],
    bulges: &'a [f64],
) -> impl Iterator<Item = Segment> + 'a {
    polygon::sides(points).zip(bulges).map(|(ends, bulge)| Segment { ends, bulge: *bulge })
}

/// Returns the point where the tangents at the ends of an arc meet.
fn tip([a, b]: [Point; 2], bulge: f64) -> Point {
    // Half the line times the tangent of half the angle; the tangent of a quarter is the bulge.
    let height = bulge / (1.0 - bulge * bulge);
    let [x, y] = [b[0] - a[0], b[1] - a[1]];
    [0.5 * (a[0] + b[0]) + height * y, 0.5 * (a[1] + b[1]) - height * x]
}

/// Returns a path through some points of a closed path, whose last point is its first one, with
/// arcs where they stay within a distance of the points. `kept` are the indices of points that
/// lines need, ascending, with the first and the last point.
pub(crate) fn fitted(path: &[Point], kept: &[usize], distance: f64) -> Curve {
    let mut curve = Curve::default();
    let mut at = 0;
    while at + 1 < kept.len() {
        curve.points.push(path[kept[at]]);
        match longest_arc(path, &kept[at..], distance) {
            Some((lines, bulge)) => {
                curve.bulges.push(bulge);
                at += lines;
            }
            None => {
                curve.bulges.push(0.0);
                at += 1;
            }
        }
    }
    curve
}

/// Returns how many lines an arc can replace, and its bulge.
fn longest_arc(path: &[Point], kept: &[usize], distance: f64) -> Option<(usize, f64)> {
    let fit = |lines: usize| {
        let end = *kept.get(lines)?;
        bulge(&path[kept[0]..=end], distance).map(|bulge| (lines, bulge))
    };
    let is_enough = |lines: &usize| kept[*lines] - kept[0] > FEWEST_POINTS;
    let fewest = (FEWEST_LINES..kept.len()).find(is_enough)?;
    let mut best = fit(fewest)?;
    let mut step = fewest;
    while let Some(longer) = fit(best.0 + step) {
        best = longer;
        step *= 2;
    }
    while step > 1 {
        step /= 2;
        best = fit(best.0 + step).unwrap_or(best);
    }
    Some(best)
}

fn between(a: &Point, b: &Point) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// Returns the bulge of an arc from the first to the last point that is within a distance of the
/// points between, and within twice the distance of the lines between them.
fn bulge(points: &[Point], distance: f64) -> Option<f64> {
    let [first, .., last] = points else { return None };
    let along = |p: &Point, q: &Point| {
        (q[0] - p[0]) * (last[0] - first[0]) + (q[1] - p[1]) * (last[1] - first[1])
    };
    if points.windows(2).any(|pair| along(&pair[0], &pair[1]) <= 0.0) {
        return None;
    }
    let range = |bulge: f64| {
        let arc = Segment { ends: [*first, *last], bulge };
        points[1..points.len() - 1]
            .iter()
            .map(|point| arc.right_of(*point))
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], away| [lo.min(away), hi.max(away)])
    };
    let longest = points.windows(2).map(|pair| between(&pair[0], &pair[1])).fold(0.0, f64::max);
    // A line between two points of a circle is at most its squared length over 8 radii away.
    let is_near_lines = |bulge: f64| {
        let radius = Segment { ends: [*first, *last], bulge }.radius();
        longest * longest <= 8.0 * radius * 2.0 * distance
    };
    let [mut least, mut most] = [-MOST_BULGE, MOST_BULGE];
    for _ in 0..STEPS {
        let middle = 0.5 * (least + most);
        let [lo, hi] = range(middle);
        if lo >= -distance && hi <= distance && (hi + lo).abs() <= 0.1 * distance {
            let is_bent = middle.abs() * 0.5 * between(first, last) >= LEAST_BEND * distance;
            return (is_bent && is_near_lines(middle)).then_some(middle);
        }
        if hi + lo > 0.0 { least = middle } else { most = middle }
    }
    None
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Returns points on a circle, the last one equal to the first one.
    fn circle(count: usize) -> Vec<Point> {
        let at = |index: usize| {
            let (sine, cosine) = (TAU * (index % count) as f64 / count as f64).sin_cos();
            [cosine, sine]
        };
        (0..=count).map(at).collect()
    }

    #[test]
    fn a_circle_is_a_few_arcs() {
        let path = circle(200);
        let kept: Vec<usize> = (0..=200).step_by(10).collect();
        let curve = fitted(&path, &kept, 1e-3);
        assert!(curve.points.len() <= 4, "{curve:?}");
        for point in curve.lines(1e-5) {
            assert!((point[0].hypot(point[1]) - 1.0).abs() <= 1e-3, "{point:?}");
        }
        let area: f64 = polygon::area(&curve.points);
        let area = area + curve.segments().map(|segment| segment.area()).sum::<f64>();
        assert!((area - TAU / 2.0).abs() < 2e-3, "{area}");
    }

    #[test]
    fn a_polygon_is_no_circle_where_its_sides_are_far_from_one() {
        let path = circle(24);
        let kept: Vec<usize> = (0..=24).collect();
        assert_eq!(fitted(&path, &kept, 4e-3).bulges, [0.0; 24]);
        assert!(fitted(&path, &kept, 5e-3).points.len() <= 4);
    }

    #[test]
    fn corners_stay_corners() {
        let mut path = Vec::new();
        for index in 0..=40 {
            let t = f64::from(index % 10) / 10.0;
            path.push(
                [[t, 0.0], [1.0, t], [1.0 - t, 1.0], [0.0, 1.0 - t]][index as usize / 10 % 4],
            );
        }
        let curve = fitted(&path, &[0, 10, 20, 30, 40], 1e-3);
        assert_eq!(curve.points, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(curve.bulges, [0.0; 4]);
    }

    #[test]
    fn the_hull_of_an_arc_holds_it() {
        let curve = Curve { points: vec![[1.0, 0.0], [-1.0, 0.0]], bulges: vec![0.5, 0.0] };
        let arc = curve.segments().next().expect("an arc");
        let tips = curve.hull(0.01).into_iter().map(|[_, end]| end);
        // Ends of sides are on the arc, or outside of its circle.
        assert!(tips.clone().take(20).all(|point| arc.right_of(point) > -1e-12));
        assert!(tips.clone().any(|point| arc.right_of(point) > 1e-4));
    }
}
