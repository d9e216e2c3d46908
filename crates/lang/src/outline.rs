//! The boundary of the area that outlines fill.
//!
//! Outlines of a font may overlap; they fill by the nonzero rule. This module cuts curves where
//! they cross and keeps the pieces that have the inside on exactly one side. The distance to the
//! nearest piece is then the distance to the boundary, and the side of that piece gives the sign.

/// A point in ems.
pub type Point = [f64; 2];
/// A quadratic curve: start, control point, end. The control point of a line is its midpoint.
pub type Curve = [Point; 3];

/// A curve of the boundary, with the inside on its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// The curve.
    pub curve: Curve,
    /// The side of points whose nearest point is the start or the end: 1 outside, -1 inside, 0 if
    /// the side of the curve tells.
    pub corners: [f64; 2],
}

/// Size of a box that counts as a point, in ems: a thousandth of a unit of most fonts.
const POINT: f64 = 5e-7;
/// Distance of two ends that count as one point, in ems.
const SAME: f64 = 1e-5;
/// Distance from a piece at which its sides are tested, in ems.
const ASIDE: f64 = 1e-5;
/// Fraction of a curve near its ends in which cuts are ignored.
const LEAST_PART: f64 = 1e-4;
/// Largest number of pairs of parts that are tested for two curves. Curves that coincide would need
/// more.
const MAX_PAIRS: usize = 4096;
/// Largest turn of a smooth joint, in radians.
pub(crate) const SMOOTH: f64 = 0.5;

/// The boundary of the area that outlines fill, in the order of the outlines or its reverse.
pub fn boundary(mut outlines: Vec<Curve>) -> Vec<Piece> {
    // TrueType has the inside on the right, PostScript on the left.
    if outlines.iter().map(doubled_area).sum::<f64>() < 0.0 {
        outlines.reverse();
        outlines.iter_mut().for_each(|curve| curve.reverse());
    }
    let outlines = &outlines[..];
    let mut pieces: Vec<Piece> = Vec::with_capacity(outlines.len());
    for (curve, cuts) in outlines.iter().zip(cuts(outlines)) {
        for ends in cuts.windows(2) {
            let part = part(curve, ends[0], ends[1]);
            pieces.extend(side(outlines, part).map(|curve| Piece { curve, corners: [0.0; 2] }));
        }
    }
    turn_corners(&mut pieces);
    pieces
}

/// Twice the signed area between the curve's control polygon and the origin, positive if the curve
/// turns left about the origin.
fn doubled_area([a, b, c]: &Curve) -> f64 {
    let cross = |p: &Point, q: &Point| p[0] * q[1] - p[1] * q[0];
    cross(a, b) + cross(b, c)
}

/// The curve, reversed if needed, with the inside on its left. `None` if the inside is on both
/// sides or on neither.
fn side(outlines: &[Curve], [a, b, c]: Curve) -> Option<Curve> {
    let middle = at(&[a, b, c], 0.5);
    let [x, y] = sub(c, a);
    let long = x.hypot(y);
    if long == 0.0 {
        return None; // the curve returns to its start
    }
    let aside = [-y / long * ASIDE, x / long * ASIDE];
    let is_inside = |q: Point| outlines.iter().map(|curve| rounds(curve, q)).sum::<i32>() != 0;
    let left = is_inside([middle[0] + aside[0], middle[1] + aside[1]]);
    let right = is_inside([middle[0] - aside[0], middle[1] - aside[1]]);
    match (left, right) {
        (true, false) => Some([a, b, c]),
        (false, true) => Some([c, b, a]),
        (true, true) | (false, false) => None,
    }
}

/// How often a curve crosses the ray from a point to the right: upward minus downward crossings.
fn rounds(curve: &Curve, [x, y]: Point) -> i32 {
    let [low, high] = extent(curve);
    if y < low[1] || y > high[1] || x > high[0] {
        return 0;
    }
    let heights = curve.map(|point| point[1] - y);
    let bend = heights[0] - 2.0 * heights[1] + heights[2];
    let top = if bend == 0.0 { 1.0 } else { (heights[0] - heights[1]) / bend };
    let top = if top > 0.0 && top < 1.0 { top } else { 1.0 };
    let height = |t: f64| at(curve, t)[1] - y;
    let mut count = 0;
    for (from, to) in [(0.0, top), (top, 1.0)] {
        let (first, last) = (height(from), height(to));
        if from == to || (first <= 0.0) == (last <= 0.0) {
            continue;
        }
        // The height is monotonic here.
        let (mut below, mut above) = if first <= 0.0 { (from, to) } else { (to, from) };
        for _ in 0..50 {
            let middle = 0.5 * (below + above);
            *(if height(middle) <= 0.0 { &mut below } else { &mut above }) = middle;
        }
        if at(curve, below)[0] > x {
            count += if first <= 0.0 { 1 } else { -1 };
        }
    }
    count
}

/// For each curve, the parameters at which others cross it, with 0 and 1, in ascending order.
fn cuts(outlines: &[Curve]) -> Vec<Vec<f64>> {
    let mut cuts: Vec<Vec<f64>> = vec![vec![0.0, 1.0]; outlines.len()];
    let extents: Vec<[Point; 2]> = outlines.iter().map(extent).collect();
    for second in 1..outlines.len() {
        for first in 0..second {
            if apart(extents[first], extents[second]) {
                continue;
            }
            for (s, t) in crossings(&outlines[first], &outlines[second]) {
                cuts[first].push(s);
                cuts[second].push(t);
            }
        }
    }
    for parameters in &mut cuts {
        parameters.retain(|&t| t == 0.0 || t == 1.0 || (t > LEAST_PART && t < 1.0 - LEAST_PART));
        parameters.sort_unstable_by(f64::total_cmp);
        parameters.dedup_by(|later, earlier| *later - *earlier < LEAST_PART);
    }
    cuts
}

/// The parameters at which two curves meet, by bisection of boxes; empty if the curves coincide.
fn crossings(first: &Curve, second: &Curve) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    let mut pending = vec![([0.0, 1.0], [0.0, 1.0])];
    for _ in 0..MAX_PAIRS {
        let Some((s, t)) = pending.pop() else { return found };
        let ends = [extent(&part(first, s[0], s[1])), extent(&part(second, t[0], t[1]))];
        if apart(ends[0], ends[1]) {
            continue;
        }
        let halves = |[from, to]: [f64; 2], [low, high]: [Point; 2]| {
            let middle = 0.5 * (from + to);
            let is_point = (high[0] - low[0]).max(high[1] - low[1]) < POINT;
            if is_point { vec![[from, to]] } else { vec![[from, middle], [middle, to]] }
        };
        let (parts, others) = (halves(s, ends[0]), halves(t, ends[1]));
        if parts.len() == 1 && others.len() == 1 {
            found.push((0.5 * (s[0] + s[1]), 0.5 * (t[0] + t[1])));
            continue;
        }
        pending.extend(parts.iter().flat_map(|&s| others.iter().map(move |&t| (s, t))));
    }
    Vec::new()
}

/// Finds the piece that follows each piece, and sets the side of the corner between them.
fn turn_corners(pieces: &mut [Piece]) {
    let starts: Vec<Point> = pieces.iter().map(|piece| piece.curve[0]).collect();
    for index in 0..pieces.len() {
        let end = pieces[index].curve[2];
        let near = |&at: &usize| distance(starts[at], end) < SAME;
        let following = Some(index + 1).filter(|at| *at < starts.len()).filter(near);
        let Some(next) = following.or_else(|| (0..starts.len()).find(near)) else { continue };
        let (from, to) = (leaving(&pieces[index].curve), arriving(&pieces[next].curve));
        let turn =
            libm::atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
        if turn.abs() > SMOOTH {
            pieces[index].corners[1] = turn.signum();
            pieces[next].corners[0] = turn.signum();
        }
    }
}

/// The direction in which a curve leaves its end.
fn leaving(&[a, b, c]: &Curve) -> Point {
    if b == c { sub(c, a) } else { sub(c, b) }
}

/// The direction in which a curve comes from its start.
fn arriving(&[a, b, c]: &Curve) -> Point {
    if a == b { sub(c, a) } else { sub(b, a) }
}

/// The box around a curve's control points: lowest and highest coordinates.
fn extent(&[a, b, c]: &Curve) -> [Point; 2] {
    let ends = |pick: fn(f64, f64) -> f64| [0, 1].map(|axis| pick(pick(a[axis], b[axis]), c[axis]));
    [ends(f64::min), ends(f64::max)]
}

fn apart([low, high]: [Point; 2], [other_low, other_high]: [Point; 2]) -> bool {
    (0..2).any(|axis| low[axis] > other_high[axis] || other_low[axis] > high[axis])
}

/// The point of a curve at parameter t.
pub(crate) fn at(&[a, b, c]: &Curve, t: f64) -> Point {
    mix(mix(a, b, t), mix(b, c, t), t)
}

/// The part of a curve from parameter s to t, by its blossom.
pub(crate) fn part(curve: &Curve, s: f64, t: f64) -> Curve {
    if (s, t) == (0.0, 1.0) {
        return *curve;
    }
    let [a, b, c] = *curve;
    [at(curve, s), mix(mix(a, b, s), mix(b, c, s), t), at(curve, t)]
}

/// The linear interpolation of two points.
pub(crate) fn mix(a: Point, b: Point, t: f64) -> Point {
    [0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * t)
}

/// The vector from `b` to `a`.
pub(crate) fn sub(a: Point, b: Point) -> Point {
    [0, 1].map(|axis| a[axis] - b[axis])
}

/// The distance of two points.
pub(crate) fn distance(a: Point, b: Point) -> f64 {
    let [x, y] = sub(a, b);
    x.hypot(y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[Point]) -> Vec<Curve> {
        let ends = corners.iter().zip(corners.iter().cycle().skip(1));
        ends.map(|(&a, &b)| [a, mix(a, b, 0.5), b]).collect()
    }

    fn length(pieces: &[Piece]) -> f64 {
        pieces.iter().map(|piece| distance(piece.curve[0], piece.curve[2])).sum()
    }

    #[test]
    fn a_square_keeps_its_sides_in_both_directions() {
        let mut square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        for _ in 0..2 {
            let pieces = boundary(polygon(&square));
            assert_eq!(pieces.len(), 4);
            for piece in pieces {
                assert_eq!(piece.corners, [1.0, 1.0]);
                let [x, y] = sub(piece.curve[2], piece.curve[0]);
                let [mx, my] = piece.curve[1];
                assert!(x * (0.5 - my) - y * (0.5 - mx) > 0.0, "the middle is on the left");
            }
            square.reverse();
        }
    }

    #[test]
    fn curves_inside_another_outline_are_dropped() {
        let mut outlines = polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]);
        outlines.extend(polygon(&[[1.0, -0.5], [1.5, -0.5], [1.5, 0.5], [1.0, 0.5]]));
        let pieces = boundary(outlines);
        // The smaller outline extends half a unit below and covers half a unit of the lower side.
        assert!((length(&pieces) - (6.0 - 0.5 + 0.5 + 0.5 + 0.5)).abs() < 1e-5);
        let reflex = pieces.iter().filter(|piece| piece.corners.contains(&-1.0)).count();
        assert_eq!(reflex, 4, "two corners are reflex, and two pieces meet at each");
    }

    #[test]
    fn a_hole_is_kept() {
        let mut outlines = polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
        let hole = polygon(&[[0.5, 0.5], [0.5, 1.5], [1.5, 1.5], [1.5, 0.5]]);
        outlines.extend(&hole);
        let pieces = boundary(outlines.clone());
        assert_eq!(pieces.len(), 8);
        assert!(pieces[4..].iter().all(|piece| piece.corners == [-1.0, -1.0]));
        outlines.truncate(4);
        outlines.extend(hole.iter().rev().map(|&[a, b, c]| [c, b, a]));
        assert_eq!(boundary(outlines).len(), 4, "an outline in the same direction adds nothing");
    }

    #[test]
    fn crossing_curves_are_cut() {
        // Each lens consists of two parabolas.
        let arc = |a: Point, b: Point, c: Point| [a, b, c];
        let lens = |x: f64| {
            vec![
                arc([x - 1.0, 0.0], [x, -1.0], [x + 1.0, 0.0]),
                arc([x + 1.0, 0.0], [x, 1.0], [x - 1.0, 0.0]),
            ]
        };
        let mut outlines = lens(0.0);
        outlines.extend(lens(1.0));
        let pieces = boundary(outlines);
        assert_eq!(pieces.len(), 4);
        let meeting = pieces.iter().flat_map(|piece| [piece.curve[0], piece.curve[2]]);
        // y = (x² - 1) / 2 and its copy shifted by 1 meet at x = 1/2.
        let met = meeting.filter(|p| distance([p[0], p[1].abs()], [0.5, 0.375]) < 1e-5).count();
        assert_eq!(met, 4);
    }
}
