//! The camera of a scene: stated by distances, or fitted to what is drawn.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use sdfc::{Backend, Compiler, FrameValues, Painter, PictureOptions, Pose, Scene, no_progress};

fn compiled(compiler: Compiler<'_>, text: &str) -> Scene {
    compiler.compile("a.sdf", text).unwrap_or_else(|errors| panic!("{errors}"))
}

fn pose(scene: &Scene) -> Pose {
    scene.pose(&FrameValues::defaults(scene.params()), 1.5).unwrap()
}

#[test]
fn a_setting_may_sample_a_distance() {
    let text = "sphere(1)\ncamera(eye: [0, 0, 4], target: [0, sphere(1)([0, 1.5, 0]), 0])";
    assert_eq!(pose(&compiled(Compiler::new(), text)).target.to_array(), [0.0, 0.5, 0.0]);
}

#[test]
fn a_fitted_camera_shows_the_whole_of_a_formula_without_bounds() {
    // A tanglecube, which reaches from -2.27 to 2.27.
    let tangle = "solid tangle() = { let q = p * p; dot(q, q) - 5 * (q.x + q.y + q.z) + 11.8 }\n";
    for (rest, middle) in [("tangle()", 0.0), ("tangle().translate(y: 3)\nplane()", 3.0)] {
        let scene = compiled(Compiler::new(), &format!("{tangle}{rest}"));
        assert!(scene.bounds_at(&scene.defaults()).unwrap()[1][0].is_infinite());
        let fitted = pose(&scene);
        let about = format!("box(4.54).translate(y: {middle})");
        let to_box = pose(&compiled(Compiler::new(), &about));
        assert!(fitted.target.distance(to_box.target) < 0.5, "{fitted:?}");
        let [away, of_box] = [fitted, to_box].map(|pose| pose.eye.distance(pose.target));
        assert!((1.0..1.25).contains(&(away / of_box)), "{away} and {of_box}");
    }
}

#[test]
fn a_fitted_camera_does_not_depend_on_what_may_change() {
    // The bounds of these scenes are wider if they hold for all values of the numbers.
    for text in [
        "shape op(a: shape, k: number) = a(p) + k * sin(3 * p.x)\nsphere(0.5).op(0.1)",
        "solid egg(k: number) = length(p * [1, k, 1]) - 1\negg(0.7)",
        "box([1, 0.5, 2]).twist(rate: 20deg).translate(x: 0.5)",
        "sphere().onion(6, 1, 1).swirl()",
        "circle(1).elongate().extrude()",
        "loft(circle(), polar_repeat(circle()).displace(1))",
        "(sphere().engrave(sphere()) - link(1, minor: 1)).bend()",
        "param w = 0.1 in 0.05..1\nsphere().onion(6, w, 1).swirl(45deg)",
        "union(sphere(0.5), box(0.7).translate(x: 0.4), blend: smooth(0.2))",
    ] {
        let plain = pose(&compiled(Compiler::new(), text));
        let live = compiled(Compiler::new().live_literals(None), text);
        assert!(!live.live_literals().is_empty(), "{text}");
        assert_eq!(plain, pose(&live), "{text}");
    }
}

#[test]
fn a_fitted_camera_follows_the_values_of_live_literals() {
    let live = compiled(Compiler::new().live_literals(None), "sphere(1)");
    let mut frame = live.defaults();
    frame.params[live.live_literals()[0].param][0] = 2.0;
    let other = pose(&compiled(Compiler::new(), "sphere(2)"));
    assert_eq!(live.pose(&frame, 1.5).unwrap(), other);
}

#[test]
fn a_painter_that_is_aimed_draws_as_a_new_one() {
    let scene = compiled(Compiler::new(), "box([1, 0.5, 2])\nplane(y: -0.5)");
    let first = pose(&scene);
    let other = Pose { eye: first.eye * 2.0, ..first };
    let options = PictureOptions::new().backend(Backend::Cpu).size([16, 9]).pose(first);
    let mut painter = scene.painter(&options).unwrap();
    let draw = |painter: &Painter<'_>| {
        painter.paint(&scene.defaults(), 1, &mut no_progress).unwrap().image
    };
    let before = draw(&painter);
    assert!(painter.aim([24, 16], other));
    let new = scene.painter(&options.clone().size([24, 16]).pose(other)).unwrap();
    assert_eq!(draw(&painter), draw(&new));
    // The shader for parallel rays is another one.
    assert!(!painter.aim([16, 9], Pose { parallel: true, ..first }));
    assert!(painter.aim([16, 9], first));
    assert_eq!(draw(&painter), before);
    let without = scene.painter(&PictureOptions::new().backend(Backend::Cpu)).unwrap();
    assert!(!{ without }.aim([16, 9], first));
}

#[test]
fn a_camera_that_shows_nothing_is_explained() {
    let note = |camera: &str| {
        let scene = compiled(Compiler::new(), &format!("sphere(1)\n{camera}"));
        let options = PictureOptions::new().backend(Backend::Cpu).size([16, 9]).samples(1);
        scene.render(&options, &mut no_progress).unwrap().note.unwrap_or_default()
    };
    assert!(note("camera(eye: [0, 0.5, 0], target: [0, 0, -5])").contains("inside of a solid"));
    assert!(note("camera(eye: [0, 0, 4], target: [0, 9, 4])").contains("no ray meets the scene"));
    for camera in ["camera(eye: [0, 0, 4], target: [0, 0, 0])", ""] {
        assert_eq!(note(camera), "", "{camera}");
    }
}
