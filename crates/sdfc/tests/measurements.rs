//! Measured intervals hold the truth: closed forms, and a Monte Carlo that shares no code with
//! them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::f64::consts::PI;
use std::ops::ControlFlow;

use sdfc::{Compiler, Error, MeasureOptions, Measurements, MeshError, Proven, Scene};

fn scene(source: &str) -> Scene {
    Compiler::new().compile("test.sdf", source).unwrap_or_else(|errors| panic!("{errors}"))
}

fn measure(source: &str, relative: f64) -> Measurements {
    let options = MeasureOptions::new().relative(relative);
    scene(source).measure(&options, &mut |_| ControlFlow::Continue(())).unwrap()
}

fn holds([lo, hi]: Proven, truth: f64, what: &str) {
    assert!(lo <= truth && truth <= hi, "{what}: {truth} is not in {lo} .. {hi}");
}

/// A solid in closed form.
struct Truth {
    volume: f64,
    area: f64,
    center: [f64; 3],
    /// xx, yy, zz about the center of mass.
    inertia: [f64; 3],
    extent: [[f64; 3]; 2],
}

fn check(source: &str, truth: &Truth) {
    let found = measure(source, 0.003);
    assert!(!found.is_limited, "{source}");
    holds(found.volume, truth.volume, source);
    assert!(found.volume[1] - found.volume[0] <= 0.0061 * truth.volume, "{source}: {found:?}");
    let (lowest, highest) = (found.lowest.unwrap(), found.highest.unwrap());
    let (center, inertia) = (found.center_of_mass.unwrap(), found.inertia.unwrap());
    for axis in 0..3 {
        holds(center[axis], truth.center[axis], &format!("center {axis} of {source}"));
        let span = truth.extent[1][axis] - truth.extent[0][axis];
        assert!(center[axis][1] - center[axis][0] < 0.03 * span, "{source}: {center:?}");
        let value = truth.inertia[axis];
        holds(inertia[axis], value, &format!("inertia {axis} of {source}"));
        assert!(inertia[axis][1] - inertia[axis][0] < 0.05 * value, "{source}: {inertia:?}");
        holds(inertia[3 + axis], 0.0, &format!("product {axis} of {source}"));
        holds(lowest[axis], truth.extent[0][axis], &format!("lowest {axis} of {source}"));
        holds(highest[axis], truth.extent[1][axis], &format!("highest {axis} of {source}"));
        assert!(highest[axis][1] - highest[axis][0] < 0.02, "{source}: {highest:?}");
    }
    let off = (found.area_estimate - truth.area).abs() / truth.area;
    assert!(off < 0.02, "{source}: area {} for {}", found.area_estimate, truth.area);
}

#[test]
fn a_scene_may_be_smaller_than_the_relative_error() {
    let ball = 4.0 / 3.0 * PI;
    holds(measure("sphere(0.0004)", 0.001).volume, ball * 6.4e-11, "volume");
}

#[test]
fn closed_forms_lie_in_the_intervals() {
    let ball = 4.0 / 3.0 * PI;
    let truth = Truth {
        volume: ball,
        area: 4.0 * PI,
        center: [5.0, 0.0, 0.0],
        inertia: [0.4 * ball; 3],
        extent: [[4.0, -1.0, -1.0], [6.0, 1.0, 1.0]],
    };
    check("sphere(1).translate(x: 5)", &truth);

    let square = |x: f64| x * x;
    let part = |a: f64, b: f64| 3.0 * (square(a) + square(b)) / 12.0;
    let truth = Truth {
        volume: 3.0,
        area: 2.0 * (1.5 + 2.0 + 3.0),
        center: [0.0, 3.0, 0.0],
        inertia: [part(1.5, 2.0), part(1.0, 2.0), part(1.0, 1.5)],
        extent: [[-0.5, 2.25, -1.0], [0.5, 3.75, 1.0]],
    };
    check("box([1, 1.5, 2]).translate(y: 3)", &truth);

    // A torus around y, with the radii 1 and 0.3.
    let volume = 2.0 * PI * PI * 0.09;
    let across = volume * (0.5 + 5.0 / 8.0 * 0.09);
    let truth = Truth {
        volume,
        area: 4.0 * PI * PI * 0.3,
        center: [0.0; 3],
        inertia: [across, volume * (1.0 + 0.75 * 0.09), across],
        extent: [[-1.3, -0.3, -1.3], [1.3, 0.3, 1.3]],
    };
    check("torus(1, 0.3)", &truth);

    let volume = PI * 0.25 * 2.0;
    let across = volume * (3.0 * 0.25 + 4.0) / 12.0;
    let truth = Truth {
        volume,
        area: 2.0 * PI * 0.25 + 2.0 * PI * 0.5 * 2.0,
        center: [0.0; 3],
        inertia: [across, volume * 0.125, across],
        extent: [[-0.5, -1.0, -0.5], [0.5, 1.0, 0.5]],
    };
    check("cylinder(0.5, 2)", &truth);
}

/// A source of pseudo-random numbers from 0 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[test]
fn samples_agree_with_the_intervals() {
    for source in [
        "sphere(1) | box([1, 1, 3]).translate(x: 0.7)",
        "union(box([1, 0.8, 0.9]), torus(0.5, 0.3).rotate(x: 40deg), blend: smooth(0.2))",
        "box([2, 2, 2]).rotate(x: 20deg, y: 30deg) - sphere(1)",
        "box([0.5, 0.5, 0.5]).limited_repeat(spacing: 0.8, count: [2, 3, 1])",
    ] {
        let found = measure(source, 0.005);
        let scene = scene(source);
        let mut field = scene.field(&scene.defaults()).unwrap();
        let [lo, hi] = scene.bounds_at(&scene.defaults()).unwrap();
        let size: f64 = (0..3).map(|axis| hi[axis] - lo[axis]).product();
        let (mut random, count) = (Random(7), 400_000);
        let (mut hits, mut sum) = (0.0, [0.0; 3]);
        for _ in 0..count {
            let point = [0, 1, 2].map(|axis| lo[axis] + random.next() * (hi[axis] - lo[axis]));
            if field.distance(point) < 0.0 {
                hits += 1.0;
                sum = [0, 1, 2].map(|axis| sum[axis] + point[axis]);
            }
        }
        // Five standard deviations.
        let part = hits / f64::from(count);
        let volume = part * size;
        let margin = 5.0 * size * (part * (1.0 - part) / f64::from(count)).sqrt();
        let [least, most] = found.volume;
        assert!(
            least - margin <= volume && volume <= most + margin,
            "{source}: {volume} {found:?}"
        );
        assert!(margin < 0.02 * volume, "{source}: too few samples to tell");
        for (axis, [least, most]) in found.center_of_mass.unwrap().into_iter().enumerate() {
            let center = sum[axis] / hits;
            let margin = 5.0 * (hi[axis] - lo[axis]) / hits.sqrt();
            assert!(least - margin <= center && center <= most + margin, "{source}: {center}");
        }
    }
}

#[test]
fn a_limit_gives_wider_intervals_that_are_still_true() {
    let options = MeasureOptions::new().max_cells(100);
    let found = scene("sphere(1)").measure(&options, &mut |_| ControlFlow::Continue(())).unwrap();
    assert!(found.is_limited);
    holds(found.volume, 4.0 / 3.0 * PI, "volume");
}

#[test]
fn what_has_no_volume_is_refused_or_said() {
    let none = |source: &str| {
        let mut progress = |_| ControlFlow::Continue(());
        scene(source).measure(&MeasureOptions::new(), &mut progress)
    };
    let result = none("plane(y: 0)");
    assert!(matches!(result, Err(Error::Mesh(MeshError::Unbounded { .. }))), "{result:?}");
    let options = MeasureOptions::new();
    let stopped = scene("sphere(1)").measure(&options, &mut |_| ControlFlow::Break(()));
    assert!(matches!(stopped, Err(Error::Mesh(MeshError::Cancelled))), "{stopped:?}");
}
