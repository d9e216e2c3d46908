//! The boundary of the area that a closed polygon fills by the even-odd rule.
//!
//! Edges are cut where they meet. Two pieces that coincide cancel each other: a ray crosses both or
//! none. Every other piece has the inside on exactly one side, so the side of the nearest piece
//! tells the sign of the distance. An evaluation over a box knows that side wherever one piece is
//! certainly nearer than the others. At the height of a corner, it does not know how many edges a
//! ray crosses.

use std::f64::consts::PI;

use crate::outline::{Piece, Point, SMOOTH, distance, mix, sub};

/// Distance of points that count as one, as a fraction of the polygon's extent. Numbers of 32 bits
/// cannot tell them apart.
const SAME: f64 = 1e-9;

/// The largest number of corners: the time grows with its square.
pub const MAX_CORNERS: usize = 4096;

/// An edge or a part of one, as the indices of its ends.
type Ends = [usize; 2];

/// The boundary of the area inside a closed polygon, with the inside on the left of each piece.
/// Every piece is straight.
pub fn boundary(corners: &[Point]) -> Vec<Piece> {
    let mut points = Points::of(corners);
    let path: Vec<usize> = corners.iter().map(|&corner| points.index(corner)).collect();
    let next = path.iter().cycle().skip(1);
    let edges = path.iter().zip(next).map(|(&a, &b)| [a, b]).filter(|[a, b]| a != b);
    let mut pieces = uncancelled(cut(&edges.collect::<Vec<_>>(), &mut points));
    let reversed: Vec<bool> =
        pieces.iter().map(|piece| is_inside_right(*piece, &pieces, &points)).collect();
    for (piece, reversed) in pieces.iter_mut().zip(reversed) {
        if reversed {
            piece.reverse();
        }
    }
    let corners = corner_sides(&pieces, &points);
    let piece = |(&[a, b], corners): (&Ends, [f64; 2])| {
        let [a, b] = [points.all[a], points.all[b]];
        Piece { curve: [a, mix(a, b, 0.5), b], corners }
    };
    pieces.iter().zip(corners).map(piece).collect()
}

/// Points without duplicates.
struct Points {
    all: Vec<Point>,
    /// Distance within which points count as one.
    same: f64,
}

impl Points {
    fn of(corners: &[Point]) -> Self {
        let far = corners.iter().flatten().fold(0.0, |far: f64, part| far.max(part.abs()));
        Self { all: Vec::with_capacity(corners.len()), same: SAME * far }
    }

    fn index(&mut self, point: Point) -> usize {
        let known = self.all.iter().position(|&other| distance(other, point) <= self.same);
        known.unwrap_or_else(|| {
            self.all.push(point);
            self.all.len() - 1
        })
    }
}

/// The parts of edges between the points where they meet others.
fn cut(edges: &[Ends], points: &mut Points) -> Vec<Ends> {
    let mut cuts: Vec<Vec<usize>> = vec![Vec::new(); edges.len()];
    for second in 1..edges.len() {
        for first in 0..second {
            let (one, other) = (edges[first], edges[second]);
            if apart(one, other, points) {
                continue;
            }
            for point in meetings(one, other, points) {
                let met = points.index(point);
                cuts[first].extend((!one.contains(&met)).then_some(met));
                cuts[second].extend((!other.contains(&met)).then_some(met));
            }
        }
    }
    let mut parts = Vec::with_capacity(edges.len());
    for (&[start, end], mut cuts) in edges.iter().zip(cuts) {
        let far = |at: usize| distance(points.all[start], points.all[at]);
        cuts.sort_by(|&a, &b| far(a).total_cmp(&far(b)));
        cuts.dedup();
        cuts.insert(0, start);
        cuts.push(end);
        parts.extend(cuts.windows(2).map(|ends| [ends[0], ends[1]]));
    }
    parts
}

/// Returns true if the boxes around two edges are apart.
fn apart(one: Ends, other: Ends, points: &Points) -> bool {
    (0..2).any(|axis| {
        let extent = |ends: Ends| {
            let [a, b] = ends.map(|end| points.all[end][axis]);
            [a.min(b), a.max(b)]
        };
        let ([low, high], [other_low, other_high]) = (extent(one), extent(other));
        low > other_high + points.same || other_low > high + points.same
    })
}

/// The points where two edges meet, ends included: the point where they cross, and each end of one
/// that lies on the other.
fn meetings(one: Ends, other: Ends, points: &Points) -> Vec<Point> {
    let at = |end: usize| points.all[end];
    let ends_on = |ends: Ends, [from, to]: Ends| {
        let (from, along) = (at(from), sub(at(to), at(from)));
        let square = dot(along, along);
        ends.map(at).into_iter().filter(move |&end| {
            let t = dot(sub(end, from), along) / square;
            let foot = [from[0] + t * along[0], from[1] + t * along[1]];
            (0.0..=1.0).contains(&t) && distance(foot, end) <= points.same
        })
    };
    let mut met: Vec<Point> = ends_on(one, other).chain(ends_on(other, one)).collect();
    let (from, along) = (at(one[0]), sub(at(one[1]), at(one[0])));
    let across = sub(at(other[1]), at(other[0]));
    let start = sub(at(other[0]), from);
    let turn = cross(along, across);
    // Division by 0 gives parameters outside of the range.
    let (s, t) = (cross(start, across) / turn, cross(start, along) / turn);
    if met.is_empty() && s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0 {
        met.push([from[0] + s * along[0], from[1] + s * along[1]]);
    }
    met
}

/// The pieces that occur an odd number of times, in either direction, once each.
fn uncancelled(pieces: Vec<Ends>) -> Vec<Ends> {
    let mut counts = std::collections::HashMap::new();
    let undirected = |[a, b]: Ends| [a.min(b), a.max(b)];
    for &piece in &pieces {
        *counts.entry(undirected(piece)).or_insert(0) += 1;
    }
    pieces
        .into_iter()
        .filter(|&piece| counts.remove(&undirected(piece)).is_some_and(|count| count % 2 == 1))
        .collect()
}

/// Returns true if a piece has the inside on its right: if a ray from its middle to its left
/// crosses an even number of other pieces. The ray is parallel to the axis that is closer to the
/// piece's normal.
fn is_inside_right(piece: Ends, pieces: &[Ends], points: &Points) -> bool {
    let [a, b] = piece.map(|end| points.all[end]);
    let along = sub(b, a);
    // The left of a direction [x, y] is [-y, x].
    let axis = if along[0].abs() < along[1].abs() { 0 } else { 1 };
    let ahead = if axis == 0 { along[1] < 0.0 } else { along[0] > 0.0 };
    let middle = mix(a, b, 0.5);
    let crossed = pieces.iter().filter(|&&other| {
        let [from, to] = other.map(|end| points.all[end]);
        let height = middle[1 - axis];
        if other == piece || (from[1 - axis] <= height) == (to[1 - axis] <= height) {
            return false;
        }
        let t = (height - from[1 - axis]) / (to[1 - axis] - from[1 - axis]);
        (from[axis] + t * (to[axis] - from[axis]) > middle[axis]) == ahead
    });
    crossed.count() % 2 == 0
}

/// For both ends of each piece: the side of the points to which that end is nearest. There are such
/// points if the pieces at a corner leave an angle above 180 degrees free.
fn corner_sides(pieces: &[Ends], points: &Points) -> Vec<[f64; 2]> {
    // At each point, the directions of the pieces there, and which end of which piece it is.
    let mut leaving: Vec<Vec<(f64, usize, usize)>> = vec![Vec::new(); points.all.len()];
    for (index, piece) in pieces.iter().enumerate() {
        for end in 0..2 {
            let [x, y] = sub(points.all[piece[1 - end]], points.all[piece[end]]);
            leaving[piece[end]].push((libm::atan2(y, x), index, end));
        }
    }
    let mut sides = vec![[0.0; 2]; pieces.len()];
    for mut ends in leaving {
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        let gap = |at: usize| {
            let wrapped = if at + 1 == ends.len() { 2.0 * PI } else { 0.0 };
            ends[(at + 1) % ends.len()].0 + wrapped - ends[at].0
        };
        let Some(widest) = (0..ends.len()).max_by(|&a, &b| gap(a).total_cmp(&gap(b))) else {
            continue;
        };
        let turn = gap(widest) - PI;
        // Counterclockwise of a piece that starts here is its left, the inside.
        let side = if ends[widest].2 == 0 { -1.0 } else { 1.0 };
        for (at, &(_, piece, end)) in ends.iter().enumerate() {
            let is_beside = at == widest || at == (widest + 1) % ends.len();
            // At a smooth joint the sides of both pieces tell, whichever is nearer after rounding.
            if turn > if is_beside { SMOOTH } else { 0.0 } {
                sides[piece][end] = side;
            }
        }
    }
    sides
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that the inside is on the left of each piece, and returns their total length.
    fn checked(corners: &[Point]) -> f64 {
        let is_inside = |[x, y]: Point| {
            let edges = corners.iter().zip(corners.iter().cycle().skip(1));
            let crossed = edges.filter(|(a, b)| {
                let t = (y - a[1]) / (b[1] - a[1]);
                (a[1] <= y) != (b[1] <= y) && a[0] + t * (b[0] - a[0]) > x
            });
            crossed.count() % 2 == 1
        };
        let pieces = boundary(corners);
        for Piece { curve: [a, middle, b], .. } in &pieces {
            let [x, y] = sub(*b, *a).map(|part| 1e-6 * part / distance(*a, *b));
            assert!(is_inside([middle[0] - y, middle[1] + x]), "left of {a:?} to {b:?}");
            assert!(!is_inside([middle[0] + y, middle[1] - x]), "right of {a:?} to {b:?}");
        }
        pieces.iter().map(|piece| distance(piece.curve[0], piece.curve[2])).sum()
    }

    fn sides(corners: &[Point]) -> Vec<f64> {
        boundary(corners).iter().map(|piece| piece.corners[1]).collect()
    }

    #[test]
    fn the_inside_is_on_the_left_of_both_directions() {
        let mut arrow = [[0.0, 0.0], [1.0, 0.4], [0.0, 0.8], [0.3, 0.4]];
        for _ in 0..2 {
            let pieces = boundary(&arrow);
            assert_eq!(pieces.len(), 4);
            checked(&arrow);
            for Piece { curve: [_, _, end], corners } in pieces {
                assert_eq!(corners[1], if end == [0.3, 0.4] { -1.0 } else { 1.0 });
            }
            arrow.reverse();
        }
    }

    #[test]
    fn repeated_corners_and_smooth_joints_have_no_side() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        assert_eq!(sides(&square), [0.0, 1.0, 1.0, 1.0, 1.0]);
        assert!((checked(&square) - 8.0).abs() < 1e-12);
    }

    #[test]
    fn a_pentagram_has_ten_edges() {
        let tip = |i: usize| {
            let turn = (90.0 + 144.0 * i as f64).to_radians();
            [libm::cos(turn), libm::sin(turn)]
        };
        let star: Vec<Point> = (0..5).map(tip).collect();
        // The middle is outside by the even-odd rule, so both sides of its corners are narrow.
        assert_eq!(boundary(&star).len(), 15);
        assert!((checked(&star) - 10.0 * libm::sin(0.4 * PI)).abs() < 1e-9);
        assert_eq!(sides(&star).iter().filter(|side| **side == 1.0).count(), 5);
    }

    #[test]
    fn a_bridge_to_a_hole_is_no_boundary() {
        let keyhole = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [0.0, 3.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
        ];
        assert!((checked(&keyhole) - 16.0).abs() < 1e-12);
        assert_eq!(sides(&keyhole).iter().sum::<f64>(), 0.0);
    }

    #[test]
    fn edges_that_coincide_in_part_are_cut() {
        // Two squares share half a side.
        let squares = [
            [0.0, 0.0],
            [1.0, 0.0],
            [1.0, 0.5],
            [2.0, 0.5],
            [2.0, 1.5],
            [1.0, 1.5],
            [1.0, 0.5],
            [1.0, 1.0],
            [0.0, 1.0],
        ];
        assert!((checked(&squares) - 7.0).abs() < 1e-12);
    }

    #[test]
    fn corners_that_touch_know_the_outside() {
        // Two triangles meet at their tips; the angle above the tips is wider than 180 degrees.
        let bow = [[-1.0, -1.0], [-0.2, -1.0], [0.0, 0.0], [0.2, -1.0], [1.0, -1.0], [0.0, 0.0]];
        let at_tips = boundary(&bow).into_iter().filter(|piece| piece.curve[2] == [0.0, 0.0]);
        assert!(at_tips.map(|piece| piece.corners[1]).all(|side| side == 1.0));
        checked(&bow);
    }

    #[test]
    fn nothing_is_left_of_a_line() {
        assert!(boundary(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]).is_empty());
        assert!(boundary(&[[0.5, 0.5]; 3]).is_empty());
    }
}
