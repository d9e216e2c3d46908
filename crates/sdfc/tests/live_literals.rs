//! A scene with live literals is the same scene until one of them is changed.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use sdfc::{
    Backend, Compiler, FrameValues, LiveLiteral, MAX_LIVE_LITERALS, PictureOptions, Scene,
    no_progress,
};
use sdfc_graph::eval::sample_field;

/// Compiles the scene with live literals.
fn live(text: &str) -> Scene {
    let compiler = Compiler::new().live_literals(None);
    compiler.compile("a.sdf", text).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Returns the live literals as they are written.
fn literals(text: &str) -> Vec<String> {
    let scene = live(text);
    let written = |literal: &LiveLiteral| scene.sources().slice(literal.span).to_owned();
    let mut literals = scene.live_literals().to_vec();
    literals.sort_by_key(|literal| literal.span);
    literals.iter().map(written).collect()
}

fn distances(scene: &Scene, frame: &FrameValues) -> Vec<f64> {
    let points: Vec<[f64; 3]> = (0..200)
        .map(|i| [0.0, 1.0, 2.0].map(|axis| 5.0 * (f64::from(i) * (1.7 + axis)).sin()))
        .collect();
    let samples = sample_field(scene.program(), frame, &points).unwrap();
    samples.iter().map(|sample| sample.distance).collect()
}

#[test]
fn every_example_is_the_same_scene_with_live_literals() {
    let mut seen = 0;
    for (path, text) in sdfc_test_support::example_sources().unwrap() {
        let Ok(plain) = Compiler::new().compile("a.sdf", &text) else { continue };
        if !plain.draws() {
            continue;
        }
        let slots = live(&text);
        if slots.live_literals().is_empty() {
            continue; // all its numbers decide which shapes are built
        }
        assert_eq!(plain.report().uncertified.len(), slots.report().uncertified.len(), "{path}");
        let frame = |scene: &Scene| FrameValues::defaults(scene.params());
        let pairs =
            distances(&plain, &frame(&plain)).into_iter().zip(distances(&slots, &frame(&slots)));
        for (a, b) in pairs {
            assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs()), "{path}: {a} and {b}");
        }
        seen += 1;
        let options = PictureOptions::new().size([24, 15]).backend(Backend::Cpu);
        let [a, b] = [&plain, &slots]
            .map(|scene| scene.render(&options, &mut no_progress).unwrap().image.to_srgb8());
        let differing = a.iter().zip(&b).filter(|(a, b)| a.abs_diff(**b) > 2).count();
        assert!(differing <= 24, "{path}: {differing} channels differ");
    }
    assert!(seen > 50, "numbers move in {seen} examples");
}

#[test]
fn changing_a_live_literal_gives_the_scene_with_that_number() {
    let scene = live("sphere(0.5).translate(y: 2)\n");
    let mut frame = FrameValues::defaults(scene.params());
    scene.set_param(&mut frame, "at_1_8", "0.75").unwrap();
    scene.set_param(&mut frame, "at_1_26", "-1").unwrap();
    let other = live("sphere(0.75).translate(y: -1)\n");
    let expected = distances(&other, &FrameValues::defaults(other.params()));
    assert_eq!(distances(&scene, &frame), expected);
    // The radius keeps the range of the parameter in the library.
    let error = scene.set_param(&mut frame, "at_1_8", "-0.1").unwrap_err().to_string();
    assert!(error.contains("0..inf"), "{error}");
}

#[test]
fn numbers_that_decide_what_is_built_stay_constant() {
    let none: [&str; 0] = [];
    assert_eq!(literals("sphere(0.5)\n"), ["0.5"]);
    assert_eq!(
        literals("let n = 3\nlet r = if n > 2 { 0.5 } else { 0.7 }\nsphere(r)\n"),
        ["0.5", "0.7"]
    );
    assert_eq!(literals("union(for i in 0..3: sphere(0.5).translate(x: 2 * i))\n"), ["0.5", "2"]);
    assert_eq!(literals("let a = [0.5, 0.6]\nsphere(a[1])\n"), ["0.5", "0.6"]);
    assert_eq!(literals("solid s() = pow(length(p), 2) - 1\ns()\n"), ["1"]);
    assert_eq!(literals("solid s(a, b) require a < b, \"a < b\" = length(p) - b\ns(1, 2)\n"), none);
    assert_eq!(literals("solid s(a) exact if a > 1 = length(p) - a\ns(2)\n"), none);
    // A literal whose parameter has a range is live by itself, but not within a formula.
    assert_eq!(literals("sphere(0.5 / 2)\n"), none);
    assert_eq!(literals("sphere(pi)\n"), none);
}

#[test]
fn beyond_the_limit_the_literals_around_the_focus_are_live() {
    let rows = (0..600).map(|i| format!("  + 0.00{i} * sin(p.x)\n"));
    let text = format!("solid waves() = p.y\n{}waves()\n", rows.collect::<String>());
    let lines = |near| {
        let scene = Compiler::new().live_literals(near).compile("a.sdf", &text).unwrap();
        let line = |at: u32| text[..at as usize].lines().count();
        let starts = scene.live_literals().iter().map(|literal| line(literal.span.start));
        let lines: Vec<usize> = starts.collect();
        assert_eq!(lines.len(), MAX_LIVE_LITERALS);
        [*lines.iter().min().unwrap(), *lines.iter().max().unwrap()]
    };
    assert_eq!(lines(None), [2, 513]);
    assert_eq!(lines(Some(0)), [2, 513]);
    assert_eq!(lines(Some(text.len() as u32)), [90, 601]);
    let middle = text.find("0.00300 ").unwrap() as u32;
    assert_eq!(lines(Some(middle)), [46, 557]);
}

/// The field is not divided by a constant: each axis and each angle make a rotation.
#[test]
fn a_rotation_about_a_live_axis_keeps_distances() {
    let rotated = |axis: &str| format!("sphere().rotate_about({axis}, 30deg).translate(x: 2)\n");
    let plain = Compiler::new().compile("a.sdf", &rotated("[1, 2, 3]")).unwrap();
    let by_param = format!("param k = 2 in 1..3\n{}", rotated("[1, k, 3]"));
    let of = |scene: &Scene| distances(scene, &FrameValues::defaults(scene.params()));
    for turned in [rotated("[1, 2, 3]"), by_param] {
        for (a, b) in of(&plain).into_iter().zip(of(&live(&turned))) {
            assert!((a - b).abs() < 1e-9, "{turned}: {a} and {b}");
        }
    }
}
