//! Triangles in the coordinates of a frame, and distances to triangles.

use crate::vector::{Vec3, add, cross, dot, length, scale, sub};

/// The parts of triangles within a box.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clipped {
    /// The least and the greatest first coordinate.
    pub(crate) heights: Option<[f64; 2]>,
    /// The triangles that meet the box, whole.
    pub(crate) triangles: Vec<[Vec3; 3]>,
}

/// Clipped heights are widened by this part of the box, for rounding.
const ROUNDING: f64 = 1e-12;

/// Adds a triangle's part within `|x| <= limits`.
pub(crate) fn clip(corners: [Vec3; 3], limits: [f64; 3], found: &mut Clipped) {
    let polygon = polygon_in_box(corners, limits);
    if polygon.is_empty() {
        return;
    }
    let margin = ROUNDING * (limits[0] + limits[1] + limits[2]);
    for [height, ..] in &polygon {
        let [lo, hi] = found.heights.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
        found.heights = Some([lo.min(height - margin), hi.max(height + margin)]);
    }
    found.triangles.push(corners);
}

/// The part of a triangle within `|x| <= limits` (Sutherland and Hodgman, 1974).
pub(crate) fn polygon_in_box(corners: [Vec3; 3], limits: [f64; 3]) -> Vec<Vec3> {
    let mut polygon = corners.to_vec();
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let beyond = |p: &Vec3| sign * p[axis] - limits[axis];
            if polygon.iter().any(|p| beyond(p) > 0.0) {
                polygon = cut(&polygon, beyond);
            }
        }
    }
    polygon
}

/// The part of a polygon where a linear function is at most 0.
pub(crate) fn cut(polygon: &[Vec3], beyond: impl Fn(&Vec3) -> f64) -> Vec<Vec3> {
    let mut rest = Vec::with_capacity(polygon.len() + 1);
    for (index, to) in polygon.iter().enumerate() {
        let from = polygon[(index + polygon.len() - 1) % polygon.len()];
        let [before, here] = [beyond(&from), beyond(to)];
        if (before <= 0.0) != (here <= 0.0) {
            rest.push(add(from, scale(sub(*to, from), before / (before - here))));
        }
        if here <= 0.0 {
            rest.push(*to);
        }
    }
    rest
}

/// True if a triangle meets the box `|x| <= half`: no axis separates them (T. Akenine-Möller, Fast
/// 3D Triangle-Box Overlap Testing, 2001). In doubt because of rounding they meet.
pub(crate) fn is_in_box(corners: [Vec3; 3], half: Vec3) -> bool {
    let [a, b, c] = corners;
    let is_beside = |axis: usize| {
        let [x, y, z] = [a[axis], b[axis], c[axis]];
        x.min(y).min(z) > half[axis] || x.max(y).max(z) < -half[axis]
    };
    if is_beside(0) || is_beside(1) || is_beside(2) {
        return false;
    }
    let is_within =
        |p: Vec3| p[0].abs() <= half[0] && p[1].abs() <= half[1] && p[2].abs() <= half[2];
    if is_within(a) || is_within(b) || is_within(c) {
        return true;
    }
    let greatest = |[x, y, z]: Vec3| x.abs().max(y.abs()).max(z.abs());
    let size = greatest(a).max(greatest(b)).max(greatest(c)).max(greatest(half));
    let separates = |axis: Vec3| {
        let [x, y, z] = [dot(axis, a), dot(axis, b), dot(axis, c)];
        let slopes = axis.map(f64::abs);
        let reach = dot(slopes, half) + ROUNDING * size * (slopes[0] + slopes[1] + slopes[2]);
        x.min(y).min(z) > reach || x.max(y).max(z) < -reach
    };
    let across = |[x, y, z]: Vec3| {
        separates([0.0, -z, y]) || separates([z, 0.0, -x]) || separates([-y, x, 0.0])
    };
    let [ab, bc, ca] = [sub(b, a), sub(c, b), sub(a, c)];
    !separates(cross(ab, bc)) && !across(ab) && !across(bc) && !across(ca)
}

/// The distances along a direction at which a line through a point enters and leaves the box
/// `|x| <= half`; `None` if it misses the box.
pub(crate) fn line_in_box(point: Vec3, direction: Vec3, half: Vec3) -> Option<[f64; 2]> {
    let mut range = [f64::NEG_INFINITY, f64::INFINITY];
    for axis in 0..3 {
        if direction[axis] == 0.0 {
            if point[axis].abs() > half[axis] {
                return None;
            }
            continue;
        }
        let ends = [-1.0, 1.0].map(|side| (side * half[axis] - point[axis]) / direction[axis]);
        range[0] = range[0].max(ends[0].min(ends[1]));
        range[1] = range[1].min(ends[0].max(ends[1]));
    }
    (range[0] < range[1]).then_some(range)
}

/// True if a line along the first axis, between two heights, crosses the triangles an odd number
/// of times. Its other coordinates are given.
pub(crate) fn crosses_once(triangles: &[[Vec3; 3]], line: [f64; 2], ends: [f64; 2]) -> bool {
    crossings(triangles, line, ends).is_some_and(|count| count % 2 == 1)
}

/// Counts the triangles around a line; `None` if it is too near to an edge to tell.
fn crossings(triangles: &[[Vec3; 3]], [u, v]: [f64; 2], ends: [f64; 2]) -> Option<usize> {
    let close = 1e-9 * (ends[1] - ends[0]);
    let mut count = 0;
    for corners in triangles {
        let [a, b, c] = corners.map(|[_, x, y]| [x - u, y - v]);
        let area = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        let areas = [area(a, b), area(b, c), area(c, a)];
        let sizes = [side(a, b), side(b, c), side(c, a)];
        let is_unclear = areas.iter().zip(sizes).any(|(area, size)| area.abs() <= close * size);
        let signs = areas.map(|area| area > 0.0);
        if is_unclear {
            // A line that is clearly beyond another side misses the triangle.
            let beyond = |sign: bool| {
                areas
                    .iter()
                    .zip(sizes)
                    .any(|(area, size)| area.abs() > close * size && (*area > 0.0) == sign)
            };
            if beyond(true) && beyond(false) {
                continue;
            }
            return None;
        }
        if signs[0] == signs[1] && signs[1] == signs[2] {
            let [x, y, z] = *corners;
            let height = (areas[1] * x[0] + areas[2] * y[0] + areas[0] * z[0])
                / (areas[0] + areas[1] + areas[2]);
            count += usize::from(ends[0] < height && height < ends[1]);
        }
    }
    Some(count)
}

fn side(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).abs()
}

/// Returns the distance of a point from a triangle.
pub(crate) fn distance(point: Vec3, [a, b, c]: [Vec3; 3]) -> f64 {
    let normal = cross(sub(b, a), sub(c, a));
    let above = |from: Vec3, to: Vec3| dot(cross(sub(to, from), sub(point, from)), normal) >= 0.0;
    let size = length(normal);
    if size > 0.0 && above(a, b) && above(b, c) && above(c, a) {
        return dot(sub(point, a), normal).abs() / size;
    }
    to_segment(point, a, b).min(to_segment(point, b, c)).min(to_segment(point, c, a))
}

fn to_segment(point: Vec3, a: Vec3, b: Vec3) -> f64 {
    let along = sub(b, a);
    let t = (dot(sub(point, a), along) / dot(along, along)).clamp(0.0, 1.0);
    let t = if t.is_nan() { 0.0 } else { t };
    length(sub(point, add(a, scale(along, t))))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_triangle_is_in_a_box_if_its_clipped_part_is_not_empty(
            corners in prop::array::uniform3(prop::array::uniform3(-3.0..3.0)),
            half in prop::array::uniform3(0.01..2.0),
        ) {
            let is_clipped = |by: f64| {
                let mut found = Clipped::default();
                clip(corners, half.map(|x: f64| by * x), &mut found);
                found.heights.is_some()
            };
            let found = is_in_box(corners, half);
            prop_assert!(found || !is_clipped(1.0 - 1e-9));
            prop_assert!(!found || is_clipped(1.0 + 1e-9));
        }
    }
}
