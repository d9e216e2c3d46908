//! The thinnest walls: closed forms, and an independent search by small steps.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::ops::ControlFlow;

use sdfc::{Compiler, Error, Field, MeasureOptions, MeshError, Scene, Wall};

type Point = [f64; 3];

fn scene(source: &str) -> Scene {
    Compiler::new().compile("test.sdf", source).unwrap_or_else(|errors| panic!("{errors}"))
}

fn wall(scene: &Scene, relative: f64) -> Wall {
    let options = MeasureOptions::new().relative(relative);
    scene.thinnest_wall(&options, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// Checks a scene against the true thickness, to a tolerance in scene units.
fn check(source: &str, truth: f64, relative: f64, tolerance: f64) {
    let scene = scene(source);
    let found = wall(&scene, relative);
    let [lo, hi] = found.thickness.unwrap_or_else(|| panic!("{source}: {found:?}"));
    assert!(lo <= truth && truth <= hi, "{source}: {truth} is not in {lo} .. {hi}");
    assert!(hi - lo <= tolerance, "{source}: {lo} .. {hi}");
    assert!(found.undecided == 0 && !found.is_limited, "{source}: {found:?}");
    let [begin, end] = found.at.unwrap();
    assert!((distance(begin, end) - hi).abs() < 1e-6, "{source}: {found:?}");
    let mut field = scene.field(&scene.defaults()).unwrap();
    for step in 1..100 {
        let point = between(begin, end, f64::from(step) / 100.0);
        assert!(field.distance(point) < 0.0, "{source}: {point:?}");
    }
}

fn between(a: Point, b: Point, t: f64) -> Point {
    [0, 1, 2].map(|axis| a[axis] + t * (b[axis] - a[axis]))
}

fn distance(a: Point, b: Point) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn closed_forms_lie_in_the_intervals() {
    check("sphere(1) - sphere(0.9)", 0.1, 0.005, 0.0101);
    check("sphere(1)", 2.0, 0.02, 0.0401);
    check("box([2, 2, 0.1])", 0.1, 0.005, 0.0101);
    check("box([2, 2, 2]) - box([1.8, 1.7, 1.9])", 0.05, 0.005, 0.0101);
    check("cylinder(1, 1) - cylinder(0.8, 3)", 0.2, 0.02, 0.0401);
}

#[test]
fn a_pocket_that_nearly_breaks_through_is_found() {
    // The floor of the pocket is at -0.23, and the bottom of the board at -0.25.
    check("box([2, 1, 0.5]) - box([0.4, 0.3, 1]).translate(z: 0.27)", 0.02, 0.004, 0.0081);
}

#[test]
fn a_tapered_wall_is_thinnest_at_its_end() {
    // The upper face leans by 5 degrees. Over the lower edge at x = -1 it is lowest.
    let lean = 5f64.to_radians();
    let truth = 0.3 + (0.1 - lean.sin()) / lean.cos();
    check("box([2, 0.6, 1]) & plane(y: 0.1).rotate(z: 5deg)", truth, 0.01, 0.0201);
}

/// Numbers from 0 to 1 (G. Marsaglia, Xorshift RNGs, 2003).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Returns the outward normal by central differences.
fn normal(field: &mut Field<'_>, point: Point) -> Point {
    let step = 1e-6;
    let slopes: Point = std::array::from_fn(|axis| {
        let (mut low, mut high) = (point, point);
        low[axis] -= step;
        high[axis] += step;
        field.distance(high) - field.distance(low)
    });
    let length = distance(slopes, [0.0; 3]);
    slopes.map(|slope| slope / length)
}

/// Returns the thickness of the wall at a point of the surface, by small steps.
fn marched(field: &mut Field<'_>, begin: Point, longest: f64) -> Option<f64> {
    let outward = normal(field, begin);
    let at = |t: f64| [0, 1, 2].map(|axis| begin[axis] - t * outward[axis]);
    let step = 5e-4 * longest;
    let mut t = step;
    while field.distance(at(t)) < 0.0 {
        t += step;
    }
    let [mut from, mut to] = [t - step, t];
    for _ in 0..40 {
        let middle = 0.5 * (from + to);
        if field.distance(at(middle)) < 0.0 { from = middle } else { to = middle }
    }
    let end = normal(field, at(to));
    let cosine: f64 = (0..3).map(|axis| end[axis] * outward[axis]).sum();
    (cosine < (141f64).to_radians().cos() && t > 2.0 * step).then_some(to)
}

#[test]
fn no_sample_is_thinner_than_the_lower_end() {
    for (source, size) in [
        ("box([0.5, 2, 0.3]).twist(60deg) - sphere(0.1)", 1.2),
        (
            "union(sphere(0.5).translate(x: -0.4), sphere(0.4).translate(x: 0.4), \
             blend: smooth(0.2)) - sphere(0.35).translate(x: -0.4)",
            1.0,
        ),
        ("torus(0.7, 0.25) - torus(0.72, 0.15)", 1.1),
    ] {
        let scene = scene(source);
        let options = MeasureOptions::new().relative(0.02).max_cells(400_000);
        let found = scene.thinnest_wall(&options, &mut |_| ControlFlow::Continue(())).unwrap();
        let [lo, hi] = found.thickness.unwrap();
        assert!(lo > 0.0, "{source}: {found:?}");
        let mut field = scene.field(&scene.defaults()).unwrap();
        let mut random = Random(0x2545_F491_4F6C_DD1D);
        let (mut count, mut least) = (0, f64::INFINITY);
        for _ in 0..60_000 {
            let [a, b] = [0, 1].map(|_| [0, 1, 2].map(|_| size * (2.0 * random.next() - 1.0)));
            let is_inside = |field: &mut Field<'_>, t: f64| field.distance(between(a, b, t)) < 0.0;
            if is_inside(&mut field, 0.0) == is_inside(&mut field, 1.0) {
                continue;
            }
            let side = is_inside(&mut field, 0.0);
            let [mut from, mut to] = [0.0, 1.0];
            for _ in 0..45 {
                let middle = 0.5 * (from + to);
                if is_inside(&mut field, middle) == side { from = middle } else { to = middle }
            }
            if let Some(thickness) = marched(&mut field, between(a, b, to), size) {
                count += 1;
                least = least.min(thickness);
            }
            if count == 3000 {
                break;
            }
        }
        assert!(count > 500, "{source}: {count} walls");
        assert!(least >= lo - 1e-6, "{source}: a wall of {least} is below {lo} .. {hi}");
        assert!(hi <= least + 0.05, "{source}: {hi} is found, and {least} by samples");
    }
}

#[test]
fn no_wall_is_found_where_faces_do_not_oppose_each_other() {
    // The normals of the cone's sides enclose at most 127 degrees, and 117 degrees with the base.
    let found = wall(&scene("cone(1, 2)"), 0.1);
    assert!(found.thickness.is_none() && found.at.is_none() && found.is_absent, "{found:?}");
}

#[test]
fn a_limit_of_boxes_and_wrong_options_are_reported() {
    let shell = scene("sphere(1) - sphere(0.9)");
    let options = MeasureOptions::new().max_cells(1000);
    let found = shell.thinnest_wall(&options, &mut |_| ControlFlow::Continue(())).unwrap();
    let [lo, hi] = found.thickness.unwrap();
    assert!(found.is_limited && (0.0..0.1).contains(&lo) && hi >= 0.1, "{found:?}");
    let mut stop = |_| ControlFlow::Break(());
    let stopped = shell.thinnest_wall(&options, &mut stop);
    assert!(matches!(stopped, Err(Error::Mesh(MeshError::Cancelled))));
    for relative in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = MeasureOptions::new().relative(relative);
        let found = shell.thinnest_wall(&options, &mut |_| ControlFlow::Continue(()));
        assert!(matches!(found, Err(Error::Mesh(MeshError::Error(_)))), "{relative}");
    }
}
