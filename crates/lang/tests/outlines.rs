//! Compares each region of the library with an outline that is drawn here point by point, without
//! the region's formula, on the outside and the inside.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod support;

use std::f64::consts::{PI, TAU};

use sdfc_lang::font::{Fonts, Setting};
use sdfc_lang::{NoFiles, library};
use support::Field;

type Point = [f64; 2];

/// Number of points of a circle or curve.
const STEPS: usize = 3000;
/// Largest distance of the lines between these points from the curve, in scene units.
const NEAR: f64 = 3e-6;
const POINTS: usize = 500;
/// Distance around the outline within which the field is compared, in scene units.
const REACH: f64 = 0.8;

/// The definition of a region.
enum Expected {
    /// The points that these closed outlines surround an odd number of times.
    Filled(Vec<Vec<Point>>),
    /// The points within a distance of an open polyline.
    Stroke(Vec<Point>, f64),
}

use Expected::{Filled, Stroke};

struct Case {
    text: &'static str,
    expected: Expected,
}

fn filled(text: &'static str, outline: Vec<Point>) -> Case {
    Case { text, expected: Filled(vec![outline]) }
}

fn stroke(text: &'static str, line: Vec<Point>, r: f64) -> Case {
    Case { text, expected: Stroke(line, r) }
}

/// A point in a direction, measured clockwise from the top in degrees.
fn clock(r: f64, degrees: f64) -> Point {
    let angle = degrees.to_radians();
    [r * angle.sin(), r * angle.cos()]
}

fn curve(at: impl Fn(f64) -> Point) -> Vec<Point> {
    (0..=STEPS).map(|i| at(i as f64 / STEPS as f64)).collect()
}

/// An arc of a circle from one direction to another, in degrees clockwise from the top.
fn bow([x, y]: Point, r: f64, from: f64, to: f64) -> Vec<Point> {
    curve(|t| {
        let [dx, dy] = clock(r, from + (to - from) * t);
        [x + dx, y + dy]
    })
}

fn joined(parts: impl IntoIterator<Item = Vec<Point>>) -> Vec<Point> {
    parts.into_iter().flatten().collect()
}

fn mirrored(line: &[Point]) -> Vec<Point> {
    line.iter().rev().map(|[x, y]| [-x, *y]).collect()
}

/// A symmetric outline from its right half, given from top to bottom.
fn both_halves(right: Vec<Point>) -> Vec<Point> {
    let left = mirrored(&right);
    joined([right, left])
}

/// The outline of the convex hull of some discs.
fn hull(discs: &[(Point, f64)]) -> Vec<Point> {
    curve(|t| {
        let n = clock(1.0, 360.0 * t);
        let reach = |(c, r): &(Point, f64)| c[0] * n[0] + c[1] * n[1] + r;
        let (c, r) = discs.iter().max_by(|a, b| reach(a).total_cmp(&reach(b))).expect("a disc");
        [c[0] + r * n[0], c[1] + r * n[1]]
    })
}

fn corners(size: Point) -> Vec<Point> {
    let [x, y] = size.map(|extent| extent / 2.0);
    vec![[-x, -y], [x, -y], [x, y], [-x, y]]
}

fn tips(n: usize, r: f64, inner: f64) -> Vec<Point> {
    let wedge = 360.0 / n as f64;
    let tip = |i: usize| [clock(r, wedge * i as f64), clock(inner, wedge * (i as f64 + 0.5))];
    (0..n).flat_map(tip).collect()
}

fn polygon(n: usize, r: f64) -> Vec<Point> {
    (0..n).map(|i| clock(r, 360.0 / n as f64 * i as f64)).collect()
}

/// A band around an arc of radius 0.5 that covers `angle`, with square ends.
fn band(width: f64, angle: f64) -> Vec<Point> {
    let (from, to) = (-angle / 2.0, angle / 2.0);
    let (outer, inner) = (0.5 + width / 2.0, 0.5 - width / 2.0);
    joined([bow([0.0; 2], outer, from, to), bow([0.0; 2], inner, to, from)])
}

fn horseshoe(r: f64, angle: f64, leg: f64, width: f64) -> Vec<Point> {
    let side = |r: f64| {
        let [x, y] = clock(r, angle / 2.0);
        let [along_x, along_y] = clock(leg, angle / 2.0 + 90.0);
        let mut side = bow([0.0; 2], r, 0.0, angle / 2.0);
        side.push([x + along_x, y + along_y]);
        side
    };
    let (mut outer, mut inner) = (side(r + width / 2.0), side(r - width / 2.0));
    inner.reverse();
    outer.append(&mut inner);
    both_halves(outer)
}

fn staircase([width, height]: Point, n: usize) -> Vec<Point> {
    let (x, y) = (width / n as f64, height / n as f64);
    let at = |i: usize, j: usize| [i as f64 * x - width / 2.0, j as f64 * y - height / 2.0];
    let mut outline = vec![at(0, 0)];
    outline.extend((0..n).flat_map(|i| [at(i, i + 1), at(i + 1, i + 1)]));
    outline.push(at(n, 0));
    outline
}

fn bezier(a: Point, b: Point, c: Point) -> Vec<Point> {
    curve(|t| {
        let s = 1.0 - t;
        [0, 1].map(|i| s * s * a[i] + 2.0 * s * t * b[i] + t * t * c[i])
    })
}

fn plain() -> Vec<Case> {
    let all_round = |r: f64| bow([0.0; 2], r, 0.0, 360.0);
    vec![
        filled("circle(0.6)", all_round(0.6)),
        stroke("segment([-0.5, -0.2], [0.3, 0.4], r: 0.15)", vec![[-0.5, -0.2], [0.3, 0.4]], 0.15),
        filled("rect([1.2, 0.5])", corners([1.2, 0.5])),
        filled(
            "rounded_rect([1.2, 0.8], r: [0.05, 0.4, 0, 0.2])",
            joined([
                bow([-0.55, 0.35], 0.05, -90.0, 0.0),
                bow([0.2, 0.0], 0.4, 0.0, 90.0),
                bow([0.6, -0.4], 0.0, 90.0, 180.0),
                bow([-0.4, -0.2], 0.2, 180.0, 270.0),
            ]),
        ),
        filled(
            "oriented_rect([-0.1, 0], [0.5, 0.8], width: 0.5)",
            vec![[-0.3, 0.15], [0.1, -0.15], [0.7, 0.65], [0.3, 0.95]],
        ),
        filled("rhombus([1.4, 0.4])", vec![[-0.7, 0.0], [0.0, -0.2], [0.7, 0.0], [0.0, 0.2]]),
        filled(
            "trapezoid(bottom: 1.2, top: 0.3, h: 0.6)",
            vec![[-0.6, -0.3], [0.6, -0.3], [0.15, 0.3], [-0.15, 0.3]],
        ),
        filled(
            "trapezoid(bottom: 0, top: 1, h: 0.9)",
            vec![[0.0, -0.45], [0.5, 0.45], [-0.5, 0.45]],
        ),
        filled(
            "parallelogram(width: 0.8, h: 0.5, shear: 0.6)",
            vec![[-0.7, -0.25], [0.1, -0.25], [0.7, 0.25], [-0.1, 0.25]],
        ),
        filled(
            "parallelogram(width: 0.2, h: 0.8, shear: -0.9)",
            vec![[0.35, -0.4], [0.55, -0.4], [-0.35, 0.4], [-0.55, 0.4]],
        ),
        filled(
            "triangle([-0.6, -0.4], [0.1, 0.5], [0.7, -0.3])",
            vec![[-0.6, -0.4], [0.1, 0.5], [0.7, -0.3]],
        ),
        filled(
            "triangle([-0.6, 0], [0.8, -0.05], [0.7, 0.05])",
            vec![[-0.6, 0.0], [0.8, -0.05], [0.7, 0.05]],
        ),
        filled(
            "isosceles_triangle(width: 0.4, h: 1.2)",
            vec![[-0.2, -0.6], [0.2, -0.6], [0.0, 0.6]],
        ),
        filled("regular_polygon(3, r: 0.6)", polygon(3, 0.6)),
        filled("regular_polygon(8, r: 0.5)", polygon(8, 0.5)),
        filled("regular_polygon(41, r: 0.7)", polygon(41, 0.7)),
        // The inner corners of a pentagram are at 1 / (golden ratio)² of the tips' distance.
        filled("star(5, r: 0.6)", tips(5, 0.6, 0.6 * (3.0 - 5f64.sqrt()) / 2.0)),
        filled("star(7, m: 7, r: 0.6)", polygon(7, 0.6)),
        // As sharp as a triangle's corner: half of the angle is 30 degrees, and the sine rule gives
        // the rest.
        filled(
            "star(9, m: 3, r: 0.6)",
            tips(9, 0.6, 0.6 * 0.5 / (30f64.to_radians() + PI / 9.0).sin()),
        ),
        filled("hexagram(0.7)", tips(6, 0.7, 0.7 / 3f64.sqrt())),
        filled("plus(1.2, width: 0.3)", plus(0.6, 0.15)),
        filled("plus(1, width: 0.9)", plus(0.5, 0.45)),
        filled(
            "polygon([[-0.5, -0.5], [0.6, -0.3], [0.1, 0], [0.3, 0.5], [-0.4, 0.3]])",
            vec![[-0.5, -0.5], [0.6, -0.3], [0.1, 0.0], [0.3, 0.5], [-0.4, 0.3]],
        ),
        filled(
            "polygon([[0, 0.5], [0.5, 0.1], [0.4, -0.4], [-0.6, -0.3]])",
            vec![[0.0, 0.5], [0.5, 0.1], [0.4, -0.4], [-0.6, -0.3]],
        ),
        filled(
            "polygon([[0, 0], [0.5, 0], [0.5, 0.5], [0, 0.5], [0, 0.5], [0, 0]])",
            vec![[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]],
        ),
        filled(
            "polygon([for i in 0..5: [sin(0.4turn * i), cos(0.4turn * i)]])",
            (0..5).map(|i| clock(1.0, 144.0 * i as f64)).collect(),
        ),
        filled(
            "polygon([for i in 0..500: [0.7 * sin(1turn / 500 * i), 0.4 * cos(1turn / 500 * i)]])",
            (0..500)
                .map(|i| clock(1.0, 0.72 * i as f64))
                .map(|[x, y]| [0.7 * x, 0.4 * y])
                .collect(),
        ),
        // A loop within a loop; the inner one is empty.
        filled(
            "polygon([for i in 0..150: (0.2 + 0.5 * cos(2.4deg * i)) * [cos(2.4deg * i), sin(2.4deg * i)]])",
            limacon(),
        ),
        // A bridge leads to a hole: the edges there and back are no boundary.
        Case {
            text: "polygon([[-0.6, -0.6], [0.6, -0.6], [0.6, 0.6], [-0.6, 0.6], [-0.6, -0.6], \
                   [-0.2, -0.2], [-0.2, 0.2], [0.2, 0.2], [0.2, -0.2], [-0.2, -0.2]])",
            expected: Filled(vec![square(0.6), square(0.2)]),
        },
        // Two squares share a part of a side.
        filled(
            "polygon([[-0.5, -0.4], [0, -0.4], [0, 0], [0.5, 0], [0.5, 0.5], [0, 0.5], [0, 0], \
             [0, 0.3], [-0.5, 0.3]])",
            vec![
                [-0.5, -0.4],
                [0.0, -0.4],
                [0.0, 0.0],
                [0.5, 0.0],
                [0.5, 0.5],
                [0.0, 0.5],
                [0.0, 0.3],
                [-0.5, 0.3],
            ],
        ),
        filled(
            "polygon([[-0.6, -0.5], [-0.1, -0.5], [0, 0.2], [0.1, -0.5], [0.6, -0.5], [0, 0.2]])",
            vec![[-0.6, -0.5], [-0.1, -0.5], [0.0, 0.2], [0.1, -0.5], [0.6, -0.5], [0.0, 0.2]],
        ),
        Case {
            text: "rect([0.4, 0.2]).translate(x: 0.3).mirror(x: true)",
            expected: Filled(vec![
                vec![[0.1, -0.1], [0.5, -0.1], [0.5, 0.1], [0.1, 0.1]],
                vec![[-0.1, -0.1], [-0.5, -0.1], [-0.5, 0.1], [-0.1, 0.1]],
            ]),
        },
        filled("staircase([1.2, 0.8], n: 4)", staircase([1.2, 0.8], 4)),
        filled("staircase([0.3, 1.4], n: 7)", staircase([0.3, 1.4], 7)),
        filled("staircase([1, 0.2], n: 1)", staircase([1.0, 0.2], 1)),
    ]
}

fn square(half: f64) -> Vec<Point> {
    vec![[-half, -half], [half, -half], [half, half], [-half, half]]
}

fn limacon() -> Vec<Point> {
    (0..150)
        .map(|i| (2.4 * f64::from(i)).to_radians())
        .map(|t| [t.cos(), t.sin()].map(|part| (0.2 + 0.5 * t.cos()) * part))
        .collect()
}

fn plus(reach: f64, half: f64) -> Vec<Point> {
    both_halves(vec![
        [half, reach],
        [half, half],
        [reach, half],
        [reach, -half],
        [half, -half],
        [half, -reach],
    ])
}

fn round() -> Vec<Case> {
    let centre = [0.0; 2];
    let slice = |angle: f64| {
        let mut slice = bow(centre, 0.6, -angle / 2.0, angle / 2.0);
        slice.push(centre);
        slice
    };
    // The points where a line below or above the centre cuts a circle of radius 0.6.
    let cut = |height: f64| {
        let corner = f64::acos(height / 0.6).to_degrees();
        bow(centre, 0.6, -corner, corner)
    };
    // The discs of a vesica of 0.6 by 1.2 have the radius 0.75, with centres 0.45 off the axis.
    let lens = f64::acos(0.45 / 0.75).to_degrees();
    let heart = 1.1 / (0.5 + 0.5 * 2f64.sqrt());
    let lift = (3.0 + 2f64.sqrt()) / 8.0;
    let in_heart = |[x, y]: Point| [x * heart, (y - lift) * heart];
    vec![
        filled("pie(0.6, angle: 80deg)", slice(80.0)),
        filled("pie(0.6, angle: 300deg)", slice(300.0)),
        filled("pie(0.6, angle: 360deg)", bow(centre, 0.6, 0.0, 360.0)),
        filled("cut_disk(0.6, cut: -0.2)", cut(-0.2)),
        filled("cut_disk(0.6, cut: 0.45)", cut(0.45)),
        stroke("arc(0.5, angle: 100deg, width: 0.2)", bow(centre, 0.5, -50.0, 50.0), 0.1),
        stroke("arc(0.5, angle: 290deg, width: 0.3)", bow(centre, 0.5, -145.0, 145.0), 0.15),
        stroke("arc(0.5, angle: 360deg, width: 0.3)", bow(centre, 0.5, 0.0, 360.0), 0.15),
        filled("ring(0.5, width: 0.3, angle: 110deg)", band(0.3, 110.0)),
        filled("ring(0.5, width: 0.9, angle: 300deg)", band(0.9, 300.0)),
        Case {
            text: "ring(0.5, width: 0.3)",
            expected: Filled(vec![bow(centre, 0.65, 0.0, 360.0), bow(centre, 0.35, 0.0, 360.0)]),
        },
        filled(
            "horseshoe(0.4, angle: 180deg, leg: 0.5, width: 0.2)",
            horseshoe(0.4, 180.0, 0.5, 0.2),
        ),
        filled(
            "horseshoe(0.4, angle: 260deg, leg: 0.2, width: 0.3)",
            horseshoe(0.4, 260.0, 0.2, 0.3),
        ),
        filled(
            "horseshoe(0.4, angle: 60deg, leg: 0.03, width: 0.5)",
            horseshoe(0.4, 60.0, 0.03, 0.5),
        ),
        filled(
            "vesica(width: 0.6, h: 1.2)",
            both_halves(bow([-0.45, 0.0], 0.75, 90.0 - lens, 90.0 + lens)),
        ),
        filled("vesica(width: 0.8, h: 0.8)", bow(centre, 0.4, 0.0, 360.0)),
        filled("moon(0.6, bite: 0.5, offset: 0.3)", moon(0.6, 0.5, 0.3)),
        filled("moon(0.6, bite: 0.8, offset: 0.3)", moon(0.6, 0.8, 0.3)),
        filled("moon(0.5, bite: 0.2, offset: 0.6)", moon(0.5, 0.2, 0.6)),
        Case {
            text: "moon(0.6, bite: 0.2, offset: 0.1)",
            expected: Filled(vec![bow(centre, 0.6, 0.0, 360.0), bow([0.1, 0.0], 0.2, 0.0, 360.0)]),
        },
        filled("rounded_cross(1.2, width: 0.3)", rounded_cross(0.45, 0.15)),
        filled("rounded_cross(1, width: 0.5)", rounded_cross(0.25, 0.25)),
        // Three arcs; c is the distance of the side arc's centre from the axis, such that it
        // touches both ends.
        filled("egg(0.4, 0.1, h: 1.2)", egg(0.4, 0.1, 1.2)),
        filled("egg(0.5, 0.45, h: 1)", egg(0.5, 0.45, 1.0)),
        filled("egg(0.3, 0.3, h: 1)", hull(&[([0.0, 0.2], 0.3), ([0.0, -0.2], 0.3)])),
        filled(
            "heart(1.1)",
            both_halves(
                bow([0.25, 0.75], 2f64.sqrt() / 4.0, -45.0, 135.0)
                    .into_iter()
                    .chain([centre])
                    .map(in_heart)
                    .collect(),
            ),
        ),
        filled(
            "tunnel(width: 0.8, h: 1.1)",
            both_halves(joined([bow([0.0, 0.15], 0.4, 0.0, 90.0), vec![[0.4, -0.55]]])),
        ),
        filled("tunnel(width: 1, h: 0.5)", bow([0.0, -0.25], 0.5, -90.0, 90.0)),
        filled(
            "uneven_capsule([-0.2, -0.3], [0.2, 0.4], r1: 0.35, r2: 0.1)",
            hull(&[([-0.2, -0.3], 0.35), ([0.2, 0.4], 0.1)]),
        ),
        filled(
            "uneven_capsule([-0.2, -0.3], [0.1, 0], r1: 0.1, r2: 0.4)",
            hull(&[([-0.2, -0.3], 0.1), ([0.1, 0.0], 0.4)]),
        ),
        filled(
            "uneven_capsule([0.1, 0], [0.1, 0], r1: 0.2, r2: 0.4)",
            bow([0.1, 0.0], 0.4, 0.0, 360.0),
        ),
        filled("ellipse([0.8, 0.4])", curve(|t| [0.8 * (TAU * t).sin(), 0.4 * (TAU * t).cos()])),
        filled("ellipse([0.1, 0.9])", curve(|t| [0.1 * (TAU * t).sin(), 0.9 * (TAU * t).cos()])),
        filled("ellipse(0.5)", bow(centre, 0.5, 0.0, 360.0)),
        filled("parabola(width: 1, h: 0.8)", parabola(1.0, 0.8)),
        filled("parabola(width: 0.1, h: 1.2)", parabola(0.1, 1.2)),
        filled("parabola(width: 1.2, h: 0.05)", parabola(1.2, 0.05)),
        stroke(
            "quadratic_bezier([-0.6, -0.3], [0, 0.8], [0.5, -0.2], r: 0.08)",
            bezier([-0.6, -0.3], [0.0, 0.8], [0.5, -0.2]),
            0.08,
        ),
        stroke(
            "quadratic_bezier([-0.3, -0.3], [0.8, 0.6], [-0.2, -0.4], r: 0.02)",
            bezier([-0.3, -0.3], [0.8, 0.6], [-0.2, -0.4]),
            0.02,
        ),
        stroke(
            "quadratic_bezier([-0.5, -0.3], [0, 0.1001], [0.5, 0.5], r: 0.1)",
            bezier([-0.5, -0.3], [0.0, 0.1001], [0.5, 0.5]),
            0.1,
        ),
        stroke(
            "quadratic_bezier([-0.5, -0.3], [-0.1, 0.02], [0.5, 0.5], r: 0.1)",
            vec![[-0.5, -0.3], [0.5, 0.5]],
            0.1,
        ),
    ]
}

/// The part of a circle outside another one that crosses it at `corner`.
fn moon(r: f64, bite: f64, offset: f64) -> Vec<Point> {
    let x = (r * r - bite * bite + offset * offset) / (2.0 * offset);
    let outer = f64::acos(x / r).to_degrees();
    let inner = f64::acos((x - offset) / bite).to_degrees();
    joined([
        bow([0.0; 2], r, 90.0 + outer, 450.0 - outer),
        bow([offset, 0.0], bite, 450.0 - inner, 90.0 + inner),
    ])
}

fn rounded_cross(arm: f64, r: f64) -> Vec<Point> {
    both_halves(joined([
        bow([0.0, arm], r, 0.0, 90.0),
        bow([arm, arm], arm - r, 270.0, 180.0),
        bow([arm, 0.0], r, 0.0, 180.0),
        bow([arm, -arm], arm - r, 0.0, -90.0),
        bow([0.0, -arm], r, 90.0, 180.0),
    ]))
}

fn egg(r1: f64, r2: f64, h: f64) -> Vec<Point> {
    let (low, rise) = (r1 - h / 2.0, h - r1 - r2);
    let c = (rise * rise - (r1 - r2) * (r1 - r2)) / (2.0 * (r1 - r2));
    let turn = f64::atan2(c, rise).to_degrees();
    both_halves(joined([
        bow([0.0, low + rise], r2, 0.0, turn),
        bow([-c, low], r1 + c, turn, 90.0),
        bow([0.0, low], r1, 90.0, 180.0),
    ]))
}

fn parabola(width: f64, h: f64) -> Vec<Point> {
    both_halves(curve(|t| [t * width / 2.0, h / 2.0 - h * t * t]))
}

fn to_segment(p: Point, a: Point, b: Point) -> f64 {
    let (side, q) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = side[0] * side[0] + side[1] * side[1];
    let t = (q[0] * side[0] + q[1] * side[1]) / square.max(1e-300);
    let t = t.clamp(0.0, 1.0);
    (q[0] - t * side[0]).hypot(q[1] - t * side[1])
}

fn to_line(p: Point, line: &[Point]) -> f64 {
    line.windows(2).map(|ends| to_segment(p, ends[0], ends[1])).fold(f64::INFINITY, f64::min)
}

fn closed(outline: &[Point]) -> Vec<Point> {
    outline.iter().chain(outline.first()).copied().collect()
}

/// The number of times that a ray to the right crosses the outline.
fn crossings(p: Point, outline: &[Point]) -> usize {
    let crosses = |ends: &[Point]| {
        let (a, b) = (ends[0], ends[1]);
        (a[1] <= p[1]) != (b[1] <= p[1])
            && p[0] < a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1])
    };
    outline.windows(2).filter(|ends| crosses(ends)).count()
}

impl Expected {
    fn distance(&self, p: Point) -> f64 {
        match self {
            Stroke(line, r) => to_line(p, line) - r,
            Filled(outlines) => {
                let outlines: Vec<_> = outlines.iter().map(|outline| closed(outline)).collect();
                let near = |outline: &Vec<Point>| to_line(p, outline);
                let nearest = outlines.iter().map(near).fold(f64::INFINITY, f64::min);
                let crossed: usize = outlines.iter().map(|outline| crossings(p, outline)).sum();
                if crossed % 2 == 1 { -nearest } else { nearest }
            }
        }
    }

    /// The box around all lines, grown by their thickness.
    fn box_of(&self) -> [Point; 2] {
        let (points, r): (Vec<Point>, f64) = match self {
            Stroke(line, r) => (line.clone(), *r),
            Filled(outlines) => (outlines.concat(), 0.0),
        };
        let ends = |axis: usize| {
            let places = points.iter().map(move |p| p[axis]);
            (places.clone().fold(f64::INFINITY, f64::min), places.fold(f64::NEG_INFINITY, f64::max))
        };
        let ((left, right), (low, high)) = (ends(0), ends(1));
        [[left - r, low - r], [right + r, high + r]]
    }
}

/// The outlines of letters, with every arc drawn by points.
fn letters(words: &str, size: f64, setting: Setting) -> Expected {
    let curves = Fonts::new(&NoFiles).curves(words, "sans", setting).expect("the font has them");
    let mut outlines: Vec<Vec<Point>> = Vec::new();
    let mut last = None;
    for piece in curves {
        let [a, b, c] = piece.curve.map(|point| point.map(|place| size * place));
        if last != Some(a) {
            outlines.push(Vec::new());
        }
        last = Some(c);
        let piece = (0..400).map(|i| on_arc([a, b, c], f64::from(i) / 400.0));
        outlines.last_mut().expect("one was begun").extend(piece);
    }
    Filled(outlines)
}

/// A point of a circular arc from a to c whose tangents at both ends meet in b; b is the midpoint
/// of a straight one.
fn on_arc([a, b, c]: [Point; 3], t: f64) -> Point {
    let middle = [0, 1].map(|i| (a[i] + c[i]) / 2.0);
    let (half, up) = ([0, 1].map(|i| (c[i] - a[i]) / 2.0), [0, 1].map(|i| b[i] - middle[i]));
    let long = half[0].hypot(half[1]);
    let turn = f64::atan2(half[0] * up[1] - half[1] * up[0], long * long);
    let angle = turn * (2.0 * t - 1.0);
    let (along, height) = if turn.abs() < 1e-9 {
        (2.0 * t - 1.0, 0.0)
    } else {
        (angle.sin() / turn.sin(), (angle.cos() - turn.cos()) / turn.sin())
    };
    [middle[0] + half[0] * along - half[1] * height, middle[1] + half[1] * along + half[0] * height]
}

fn texts() -> Vec<Case> {
    let left = Setting { align: 0.0, spacing: 0.0, leading: 1.2 };
    let wide = Setting { align: 1.0, spacing: 0.1, leading: 0.9 };
    vec![
        Case { text: "text(\"sdf\", size: 0.8)", expected: letters("sdf", 0.8, left) },
        Case {
            text: "text(\"B8&\\nAV\", align: \"right\", spacing: 0.1, leading: 0.9)",
            expected: letters("B8&\nAV", 1.0, wide),
        },
    ]
}

/// With a param the sign of a polygon comes from the crossings of a ray.
fn polygons_with_params() -> Vec<Case> {
    vec![
        filled(
            "param x = 0.1\npolygon([[-0.5, -0.5], [0.6, -0.3], [x, 0], [0.3, 0.5], [-0.4, 0.3]])",
            vec![[-0.5, -0.5], [0.6, -0.3], [0.1, 0.0], [0.3, 0.5], [-0.4, 0.3]],
        ),
        filled(
            "param a = 0.2\npolygon([for i in 0..150: (a + 0.5 * cos(2.4deg * i)) * [cos(2.4deg * i), sin(2.4deg * i)]])",
            limacon(),
        ),
    ]
}

fn cases() -> Vec<Case> {
    plain().into_iter().chain(round()).chain(texts()).collect()
}

#[test]
fn the_distance_of_a_region_is_that_to_its_outline() {
    let mut wrong = Vec::new();
    for Case { text, expected } in cases().into_iter().chain(polygons_with_params()) {
        let drawn = format!("{text}.extrude(10)");
        let field = Field::drawn(&drawn);
        let mut field = field.evaluator();
        let [lo, hi] = expected.box_of();
        let mut random = Random(3);
        for round in 0..POINTS {
            let grown = [0.0, 0.05, REACH][round % 3];
            let p = [0, 1].map(|axis| {
                let (lo, hi) = (lo[axis] - grown, hi[axis] + grown);
                lo + (hi - lo) * random.next()
            });
            let (found, distance) = (field.scalar([p[0], p[1], 0.0]), expected.distance(p));
            if (found - distance).abs() > NEAR || found.is_nan() {
                wrong.push(format!("{text} at {p:?}: {found}, but the outline is at {distance}"));
                break;
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn bounds_of_regions_are_tight() {
    let mut wrong = Vec::new();
    for Case { text, expected } in cases() {
        let scene = support::elaborated(&format!("{text}.extrude(10)")).scene;
        let mut graph = scene.graph.clone();
        let root = scene.root.expect("the scene draws something");
        let ends = sdfc_graph::bounds(&mut graph, root, &scene.params);
        let stated = ends.map(|end| graph.as_const(end).expect("they are constant").lanes());
        let off = |(stated, expected): (&[f64; 4], Point)| {
            (0..2).any(|axis| (stated[axis] - expected[axis]).abs() > 1e-3)
        };
        let expected = expected.box_of();
        if stated.iter().zip(expected).any(off) {
            wrong.push(format!("{text}: bounds {stated:?}, not {expected:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_region_has_an_outline() {
    // Regions that take other shapes, or functions that make them, are not included.
    let of_shapes = [": region", ": solid", "-> region", "-> solid"];
    let made_here = |entry: &library::Entry| {
        entry.kind == "region" && !of_shapes.iter().any(|part| entry.signature.contains(part))
    };
    let cases = cases();
    for entry in library::entries().into_iter().filter(made_here) {
        let call = format!("{}(", entry.name);
        assert!(
            cases.iter().any(|case| case.text.starts_with(&call)),
            "{} is compared with no outline",
            entry.name
        );
    }
}

/// SplitMix64: the same numbers on every machine.
struct Random(u64);

impl Random {
    /// A number in 0..1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
