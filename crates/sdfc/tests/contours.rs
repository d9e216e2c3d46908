//! Contours are closed, nested and oriented paths that do not cross, and their certificates are
//! true.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::f64::consts::PI;
use std::ops::ControlFlow;

use robust::{Coord, orient2d};
use sdfc::{Compiler, Contour, ContourPath, Error, MeshError, MeshOptions, MeshSize, Plane, Scene};

type Point = [f64; 2];

fn scene(source: &str) -> Scene {
    Compiler::new().compile("test.sdf", source).unwrap_or_else(|errors| panic!("{errors}"))
}

fn contour(source: &str, normal: [f64; 3], offset: f64, relative: f64) -> Result<Contour, Error> {
    contour_of(source, normal, offset, relative, false)
}

fn contour_of(
    source: &str,
    normal: [f64; 3],
    offset: f64,
    relative: f64,
    has_arcs: bool,
) -> Result<Contour, Error> {
    let options = MeshOptions::new().error(MeshSize::Relative(relative)).has_arcs(has_arcs);
    let plane = Plane::new(normal, offset).unwrap();
    scene(source).contour(plane, &options, &mut |_| ControlFlow::Continue(()))
}

fn sides(points: &[Point]) -> impl Iterator<Item = [Point; 2]> + '_ {
    (0..points.len()).map(|index| [points[index], points[(index + 1) % points.len()]])
}

/// True if two sides cross or touch, other than in a common end.
fn meet([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let turn = |a: Point, b: Point, c: Point| {
        let coord = |[x, y]: Point| Coord { x, y };
        orient2d(coord(a), coord(b), coord(c))
    };
    let is_apart = |axis: usize| {
        a[axis].max(b[axis]) < c[axis].min(d[axis]) || c[axis].max(d[axis]) < a[axis].min(b[axis])
    };
    if is_apart(0) || is_apart(1) || [a, b].iter().any(|end| [c, d].contains(end)) {
        return false;
    }
    turn(a, b, c) * turn(a, b, d) <= 0.0 && turn(c, d, a) * turn(c, d, b) <= 0.0
}

/// True if a point is within a path, by the parity of a ray's crossings.
fn is_within([x, y]: Point, path: &[Point]) -> bool {
    let crosses = |[a, b]: &[Point; 2]| {
        (a[1] <= y) != (b[1] <= y) && a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > x
    };
    sides(path).filter(crosses).count() % 2 == 1
}

/// Returns points of a path, with 16 on each arc: on a circle about the center of the arc.
fn divided(path: &ContourPath) -> Vec<Point> {
    let mut found = Vec::new();
    for ([a, b], bulge) in sides(&path.points).zip(&path.bulges) {
        if *bulge == 0.0 {
            found.push(a);
            continue;
        }
        let above = (bulge.recip() - bulge) / 4.0;
        let center = [
            0.5 * (a[0] + b[0]) - above * (b[1] - a[1]),
            0.5 * (a[1] + b[1]) + above * (b[0] - a[0]),
        ];
        for index in 0..16 {
            let (sine, cosine) = (bulge.atan() * 4.0 * f64::from(index) / 16.0).sin_cos();
            let [x, y] = [a[0] - center[0], a[1] - center[1]];
            found.push([center[0] + cosine * x - sine * y, center[1] + sine * x + cosine * y]);
        }
    }
    found
}

/// Checks what holds for every contour, by brute force.
fn check(contour: &Contour, name: &str) {
    let paths: Vec<Vec<Point>> = contour.paths.iter().map(divided).collect();
    let paths: Vec<&[Point]> = paths.iter().map(|path| &path[..]).collect();
    let all: Vec<[Point; 2]> = paths.iter().flat_map(|path| sides(path)).collect();
    for (index, side) in all.iter().enumerate() {
        let crossed = all[..index].iter().find(|other| meet(*side, **other));
        assert!(crossed.is_none(), "{name}: {side:?} crosses {crossed:?}");
    }
    for (index, path) in contour.paths.iter().enumerate() {
        let around: Vec<usize> = (0..paths.len())
            .filter(|other| *other != index && is_within(path.points[0], paths[*other]))
            .collect();
        // The path directly around this one lies within all others around this one.
        let parent = around.iter().copied().find(|one| {
            around.iter().all(|other| one == other || is_within(paths[*one][0], paths[*other]))
        });
        assert_eq!(path.parent, parent, "{name}: path {index}");
        assert_eq!(path.is_hole, around.len() % 2 == 1, "{name}: path {index}");
        let area: f64 = sides(paths[index]).map(|[a, b]| a[0] * b[1] - a[1] * b[0]).sum();
        assert_eq!(path.is_hole, area < 0.0, "{name}: path {index} has the wrong orientation");
    }
}

/// Scenes, planes, the number of paths, and whether everything is proven.
const CASES: &[(&str, [f64; 3], f64, usize, bool)] = &[
    ("box([1, 1, 1])", [0.0, 0.0, 1.0], 0.0, 1, true),
    ("box([1, 0.7, 0.5]).rotate(x: 20deg, y: 30deg)", [1.0, 2.0, 3.0], 0.0, 1, true),
    ("(sphere(1) - sphere(0.9)) | (sphere(0.8) - sphere(0.7))", [1.0, 2.0, 3.0], 0.1, 4, true),
    ("box([1, 1, 0.003])", [1.0, 0.0, 0.0], 0.1, 1, true),
    ("torus(1, 0.3)", [0.0, 1.0, 0.0], 0.0, 2, true),
    ("torus(1, 0.3)", [1.0, 0.0, 0.0], 0.69, 2, true),
    ("cone(0.5, 1)", [0.0, 0.0, 1.0], 0.0, 1, true),
    ("sphere(1) | sphere(1).translate(x: 2)", [0.0, 0.0, 1.0], 0.0, 1, false),
    ("sphere(1).translate(x: 1000000)", [0.0, 0.0, 1.0], 0.1, 1, true),
    ("sphere(0.1).translate(x: 0.7).polar_repeat(8)", [0.0, 1.0, 0.0], 0.0, 8, true),
    (
        "cylinder(r: 1, h: 0.2) - cylinder(r: 0.1, h: 1).translate(x: 0.7).polar_repeat(5)",
        [0.0, 1.0, 0.0],
        0.0,
        6,
        true,
    ),
    (
        "box([0.5, 0.5, 0.5]).limited_repeat(spacing: 1, count: [3, 3, 3])",
        [0.0, 0.0, 1.0],
        0.0,
        9,
        false,
    ),
];

#[test]
fn hard_sections_give_valid_contours() {
    for (source, normal, offset, paths, is_proven) in CASES {
        for has_arcs in [false, true] {
            let contour = contour_of(source, *normal, *offset, 0.005, has_arcs).unwrap();
            check(&contour, source);
            assert_eq!(contour.paths.len(), *paths, "{source}");
            let certificate = &contour.certificate;
            assert!(certificate.is_proven || !is_proven, "{source}: {certificate:?}");
        }
    }
}

#[test]
fn arcs_are_within_the_error_of_a_section_of_lines_and_circles() {
    let source = "box([1.6, 0.6, 0.6]).round(0.2) - cylinder(r: 0.25, h: 3).rotate(x: 90deg)";
    let contour = contour_of(source, [0.0, 0.0, 1.0], 0.0, 0.001, true).unwrap();
    let certificate = &contour.certificate;
    assert!(certificate.is_proven, "{certificate:?}");
    let points: usize = contour.paths.iter().map(|path| path.points.len()).sum();
    assert!(points <= 20, "{points} points: {contour:?}");
    let scene = scene(source);
    let mut field = scene.field(&scene.defaults()).unwrap();
    let mut farthest: f64 = 0.0;
    for [x, y] in contour.paths.iter().flat_map(divided) {
        farthest = farthest.max(field.distance([x, y, 0.0]).abs());
    }
    let error = certificate.error;
    assert!(farthest <= error && farthest > 0.01 * error, "{farthest} of {error}");
    // A rectangle with round corners and a round hole.
    let exact = 2.0 - (4.0 - PI) * 0.04 - PI * 0.0625;
    assert!((contour.area() - exact).abs() < 8.0 * error, "{} of {exact}", contour.area());
}

#[test]
fn a_section_of_a_box_has_four_corners() {
    let contour = contour("box([1, 0.7, 0.5])", [0.0, 0.0, 1.0], 0.1, 0.01).unwrap();
    let [path] = &contour.paths[..] else { panic!("{contour:?}") };
    assert_eq!(path.points.len(), 4, "{path:?}");
    assert!((contour.area() - 0.7).abs() < 1e-4, "{}", contour.area());
}

#[test]
fn no_point_of_a_circle_is_farther_than_the_error() {
    let contour = contour("sphere(1)", [1.0, -2.0, 0.5], 0.6, 0.002).unwrap();
    let error = contour.certificate.error;
    assert!(contour.certificate.is_proven);
    let [path] = &contour.paths[..] else { panic!("{contour:?}") };
    let mut farthest: f64 = 0.0;
    for [a, b] in sides(&path.points) {
        for t in 0..20 {
            let t = f64::from(t) / 20.0;
            let [x, y] = [0, 1].map(|i| a[i] + t * (b[i] - a[i]));
            farthest = farthest.max((x.hypot(y) - 0.8).abs());
        }
    }
    assert!(farthest <= error && farthest > 0.05 * error, "{farthest} of {error}");
    assert!((contour.area() - PI * 0.64).abs() < error * 2.0 * PI * 0.8);
}

#[test]
fn a_plane_that_meets_no_inside_is_refused() {
    for (source, offset, is_touched) in [
        ("sphere(1)", 3.0, false),
        ("sphere(1)", 1.0, true),
        ("box([2, 2, 2])", 1.0, true),
        ("sphere(1) - sphere(0.5)", -1.2, false),
    ] {
        let result = contour(source, [0.0, 0.0, 1.0], offset, 0.01);
        let Err(Error::Mesh(MeshError::NoSection { touches, from, to, .. })) = result else {
            panic!("{source} at {offset}: {result:?}")
        };
        assert_eq!((touches, from, to), (is_touched, -1.0, 1.0), "{source} at {offset}");
    }
    let result = contour("plane(y: 0)", [0.0, 0.0, 1.0], 0.0, 0.01);
    assert!(matches!(result, Err(Error::Mesh(MeshError::Unbounded { .. }))), "{result:?}");
}

/// At the height of each corner the number of crossed edges is not known, but the nearest edge is.
#[test]
fn contours_of_polygons_are_proven() {
    let teeth =
        "polygon([for i in 0..60: (0.6 + 0.04 * (i % 2)) * [cos(i * 6deg), sin(i * 6deg)]])";
    let star = "polygon([for i in 0..5: [sin(0.4turn * i), cos(0.4turn * i)]])";
    for (source, paths) in [(teeth, 1), (star, 2)] {
        let contour = contour(source, [0.0, 0.0, 1.0], 0.0, 0.001).unwrap();
        assert!(contour.certificate.is_proven, "{source}: {:?}", contour.certificate);
        assert_eq!(contour.paths.len(), paths, "{source}");
    }
}

/// The round strokes of an 8 have places where many arcs are equally near.
#[test]
fn contours_of_text_are_proven() {
    let contour = contour("text(\"8\", size: 0.5)", [0.0, 0.0, 1.0], 0.0, 0.001).unwrap();
    assert_eq!(contour.paths.len(), 3);
    assert!(contour.certificate.is_proven, "{:?}", contour.certificate);
}
