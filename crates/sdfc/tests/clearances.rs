//! Clearances hold the truth, and collisions are found.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::ops::ControlFlow;

use sdfc::{Clearance, Compiler, Error, MeasureOptions, Scene};

fn scene(a: &str, b: &str) -> Scene {
    let source = format!("let a = {a}\nlet b = {b}\na | b\n");
    Compiler::new().compile("test.sdf", &source).unwrap_or_else(|errors| panic!("{errors}"))
}

fn clearance(scene: &Scene, names: [&str; 2]) -> Result<Clearance, Error> {
    let options = MeasureOptions::new().relative(0.01);
    scene.clearance(names, &options, &mut |_| ControlFlow::Continue(()))
}

#[test]
fn closed_forms_lie_in_the_intervals() {
    let ball = "sphere(1)";
    for (a, b, truth, collides) in [
        (ball, "sphere(1).translate(x: 2.5)", 0.5, Some(false)),
        (ball, "sphere(1).translate(x: 2.5).rotate(z: 30deg, y: 50deg)", 0.5, Some(false)),
        (ball, "sphere(1).translate(x: 1.5)", 0.0, Some(true)),
        (ball, "sphere(1).translate(x: 2)", 0.0, None),
        (ball, "sphere(2) - sphere(1.25)", 0.25, Some(false)),
        ("box([1, 1, 1])", "box([1, 1, 1]).translate([1.3, 1.4, 1.0])", 0.5, Some(false)),
        ("torus(1, 0.2)", "torus(1, 0.2).rotate(x: 90deg).translate(x: 1)", 0.6, Some(false)),
    ] {
        let scene = scene(a, b);
        let found = clearance(&scene, ["a", "b"]).unwrap();
        let [lo, hi] = found.distance;
        assert!(lo <= truth && truth <= hi, "{a}, {b}: {truth} is not in {lo} .. {hi}");
        assert!(hi - lo < 0.05, "{a}, {b}: {lo} .. {hi}");
        assert_eq!(found.collides, collides, "{a}, {b}");
        // The points are inside, so the distance of the solids is not above theirs.
        let [first, second] = found.nearest.unwrap();
        let off: f64 = (0..3).map(|axis| (first[axis] - second[axis]).powi(2)).sum();
        assert!((off.sqrt() - hi).abs() < 1e-9, "{a}, {b}: {first:?} {second:?}");
        let mut field = scene.field(&scene.defaults()).unwrap();
        assert!(field.distance(first) < 0.0 && field.distance(second) < 0.0, "{a}, {b}");
    }
}

#[test]
fn an_unknown_name_is_answered_with_the_known_ones() {
    let error = clearance(&scene("sphere(1)", "box([1, 1, 1])"), ["a", "c"]).unwrap_err();
    let message = error.to_string();
    assert!(error.is_call() && message.contains("`c`") && message.contains("a, b"), "{message}");
}
