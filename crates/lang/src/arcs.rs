//! Converts quadratic curves to circular arcs.
//!
//! The nearest point of a parabola is the root of a cubic. That of an arc needs one square root,
//! and its interval bounds over a box are narrow. A curve is replaced by biarcs: two arcs that meet
//! without a kink and match the curve's ends and directions (Bolton, "Biarc curves", 1975). Their
//! error falls with the third power of the curve's length.

use crate::outline::{Curve, Piece, Point, distance, mix, part, sub};

/// Largest distance of arcs from the curve that they replace, in ems: 1/50 of a unit of most fonts.
pub const TOLERANCE: f64 = 2e-5;
/// Largest distance of a line's midpoint from its control point, in ems.
const STRAIGHT: f64 = 1e-12;
/// The largest number of pairs of arcs for a curve.
const MAX_PAIRS: u32 = 64;
/// Number of points of each part of a curve at which the error is measured.
const SAMPLES: u32 = 16;

/// The boundary as arcs. Each arc is its start, the point where the tangents at its ends meet, and
/// its end. Lines do not change.
pub fn arcs(pieces: Vec<Piece>) -> Vec<Piece> {
    pieces.into_iter().flat_map(|piece| pairs(&piece)).collect()
}

/// The arcs of a piece. Its corners go to the start of the first arc and the end of the last.
fn pairs(piece: &Piece) -> Vec<Piece> {
    let [a, b, c] = piece.curve;
    if distance(mix(a, c, 0.5), b) < STRAIGHT {
        return vec![*piece];
    }
    let mut fit = fitted(&piece.curve, 1);
    let mut count = 1;
    while fit.0 > TOLERANCE && count < MAX_PAIRS {
        count += 1;
        fit = fitted(&piece.curve, count);
    }
    let (_, arcs) = fit;
    let end = arcs.len().saturating_sub(1);
    let corner = |at: bool, corner: f64| if at { corner } else { 0.0 };
    let piece = |(index, curve): (usize, Curve)| Piece {
        curve,
        corners: [corner(index == 0, piece.corners[0]), corner(index == end, piece.corners[1])],
    };
    arcs.into_iter().enumerate().map(piece).collect()
}

/// The error of `count` pairs of arcs for a curve, and the arcs.
fn fitted(curve: &Curve, count: u32) -> (f64, Vec<Curve>) {
    let parameter = |index: u32| f64::from(index) / f64::from(count);
    let mut off = 0.0_f64;
    let mut arcs = Vec::with_capacity(2 * count as usize);
    for index in 0..count {
        let mut part = part(curve, parameter(index), parameter(index + 1));
        if index + 1 == count {
            part[2] = curve[2]; // exactly, since the next curve begins there
        }
        let pair = biarc(&part);
        for sample in 1..SAMPLES {
            let t = f64::from(sample) / f64::from(SAMPLES);
            let point = crate::outline::at(&part, t);
            off = off.max(pair.iter().map(|arc| beside(arc, point).abs()).fold(f64::MAX, f64::min));
        }
        arcs.extend(pair);
    }
    (off, arcs)
}

/// Two arcs with the ends of a curve and its directions there, whose tangents have the same length.
fn biarc(&[a, b, c]: &Curve) -> [Curve; 2] {
    let dot = |u: Point, v: Point| u[0] * v[0] + u[1] * v[1];
    let unit = |from: Point, to: Point| {
        let long = distance(from, to).max(f64::MIN_POSITIVE);
        sub(to, from).map(|part| part / long)
    };
    let (leaves, arrives, chord) = (unit(a, b), unit(b, c), sub(c, a));
    let (square, along) = (dot(chord, chord), dot(chord, leaves) + dot(chord, arrives));
    // d is the root of 2 (1 - leaves . arrives) d² + 2 d along = chord²: then the tangents' ends
    // are 2 d apart.
    let turn = 2.0 * (1.0 - dot(leaves, arrives)) * square;
    let d = square / (along + (along * along + turn).sqrt()).max(f64::MIN_POSITIVE);
    let first = [0, 1].map(|axis| a[axis] + d * leaves[axis]);
    let second = [0, 1].map(|axis| c[axis] - d * arrives[axis]);
    let middle = mix(first, second, 0.5);
    [[a, first, middle], [middle, second, c]]
}

/// The signed distance of a point to the right of an arc's circle, without cancellation for large
/// circles.
fn beside(&[a, b, c]: &Curve, q: Point) -> f64 {
    let half = 0.5 * distance(a, c);
    let along = sub(c, a).map(|part| part / (2.0 * half));
    let local = |p: Point| {
        let v = sub(p, mix(a, c, 0.5));
        [v[0] * along[0] + v[1] * along[1], along[0] * v[1] - along[1] * v[0]]
    };
    let bend = -local(b)[1] / (half * half);
    let [x, y] = local(q);
    let norm = (bend * x).hypot(bend * y - 1.0) + (bend * half).hypot(1.0);
    (bend * (x * x + y * y - half * half) - 2.0 * y) / norm
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURVE: Curve = [[0.0, 0.0], [0.3, 0.5], [0.9, 0.1]];

    fn smooth(first: &Curve, second: &Curve) -> bool {
        let (u, v) = (sub(first[2], first[1]), sub(second[1], second[0]));
        first[2] == second[0]
            && (u[0] * v[1] - u[1] * v[0]).abs() < 1e-12
            && u[0] * v[0] + u[1] * v[1] > 0.0
    }

    #[test]
    fn arcs_follow_their_curve_without_kinks() {
        let arcs = arcs(vec![Piece { curve: CURVE, corners: [1.0, -1.0] }]);
        assert!(arcs.len() > 4, "{}", arcs.len());
        assert_eq!((arcs[0].curve[0], arcs[arcs.len() - 1].curve[2]), (CURVE[0], CURVE[2]));
        assert!(arcs.windows(2).all(|pair| smooth(&pair[0].curve, &pair[1].curve)));
        for i in 0..=1000 {
            let point = crate::outline::at(&CURVE, f64::from(i) / 1000.0);
            let off = arcs.iter().map(|arc| {
                let inside =
                    distance(arc.curve[0], point) < 0.1 || distance(arc.curve[2], point) < 0.1;
                if inside { beside(&arc.curve, point).abs() } else { f64::MAX }
            });
            assert!(off.fold(f64::MAX, f64::min) < 1.01 * TOLERANCE, "at {point:?}");
        }
        let corners: Vec<f64> = arcs.iter().flat_map(|arc| arc.corners).collect();
        assert_eq!((corners[0], corners[corners.len() - 1]), (1.0, -1.0));
        assert!(corners[1..corners.len() - 1].iter().all(|corner| *corner == 0.0));
    }

    #[test]
    fn the_tangents_of_each_arc_have_the_same_length() {
        let [first, second] = biarc(&CURVE);
        for [a, b, c] in [first, second] {
            assert!((distance(a, b) - distance(b, c)).abs() < 1e-12);
        }
    }

    #[test]
    fn lines_do_not_change() {
        let line = Piece { curve: [[0.0, 0.0], [0.5, 1.0], [1.0, 2.0]], corners: [1.0, 0.0] };
        assert_eq!(arcs(vec![line]), [line]);
    }
}
