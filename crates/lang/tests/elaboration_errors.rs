//! What elaboration says of scenes that are wrong: source and message side by side.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod support;

use support::{findings, front};

macro_rules! shows {
    ($($name:ident: $text:expr;)*) => {$(
        #[test]
        fn $name() {
            support::snapshot!(findings($text));
        }
    )*};
}

shows! {
    an_argument_outside_its_range: "let r = -0.2\nsphere(r)\n";
    a_vector_outside_its_range: "box([1, -1, 2])\n";
    a_param_that_leaves_the_range: "param r = 0.5 in -1..1\nsphere(r * 2)\n";
    a_param_without_a_range: "param r = 0.5\nsphere(r)\n";
    a_default_outside_the_params_range: "param r = 3 in 0..1\nsphere(r)\n";
    a_requirement: "plane(normal: [0, 0, 0])\n";
    a_requirement_that_a_param_breaks: "param s = 0.5 in 0..1\nsphere(1).scale(s)\n";
    a_requirement_of_the_scene:
        "solid ring(inner: length, outer: length)\n  require inner < outer, \"the inner radius is the smaller one\"\n  = max(length(p) - outer, inner - length(p))\nring(1, 0.5)\n";
    a_division_by_zero: "let n = 0\nsphere(1 / n)\n";
    a_root_of_a_negative_number: "sphere(sqrt(0 - 1))\n";
    an_error_deep_in_functions:
        "fn leg(r: length) = cylinder(r: r)\nfn pair(r: length) = leg(r) | leg(r - 1)\npair(0.5)\n";
    an_error_within_the_library: "union(blend: smooth(1))\n";
    a_sequence_that_moves: "param teeth: int = 8 in 3..12\nunion(for i in 0..teeth: sphere(i))\n";
    an_index_past_the_end: "let radii = [1, 2]\nsphere(radii[2])\n";
    recursion_without_end: "fn f(n: int) -> solid = f(n - 1)\nf(7)\n";
    recursion_on_a_param:
        "param n: int = 3 in 0..5\nfn f(n: int) -> solid = if n == 0 { sphere(1) } else { f(n - 1).round(0.1) }\nf(n)\n";
    too_many_nodes:
        "union(for x in 0..200: for y in 0..200: for z in 0..200: sphere(0.1).translate([x, y, z]))\n";
    a_sequence_too_long: "union(for x in 0..10000000: sphere(x))\n";
    shapes_nested_too_deep:
        "fn chain(n: int) -> solid = if n == 0 { sphere(1) } else { chain(n - 1).round(0.1) }\nfn long(n: int, a: solid) -> solid = if n == 0 { a } else { long(n - 1, a.round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1)) }\nlong(60, chain(10))\n";
    too_many_rounds: "sphere(iterate(5000, 1, fn(s) = s))\n";
    an_infinite_radius: "let r = inf\nsphere(r)\n";
    a_list_too_short: "solid it() = min([for x in [1] if x > 2: x])\nit()\n";
    a_sky_and_a_background: "sphere(1)\nsky()\nbackground(#123)\n";
    lights_out_of_range:
        "sphere(1)\nsun(shadow: soft(0))\nspot_light(position: [0, 3, 0], angle: 90deg)\nfog(density: -1)\nambient_occlusion(radius: 0, strength: 2)\nantialias(samples: 0)\n";
    more_lights_than_are_drawn:
        "sphere(1)\nsun()\nsun()\nsun()\nsun()\nsun()\npoint_light(position: 1)\nspot_light(position: 2)\nsun()\nsun()\npoint_light(position: 3)\n";
    a_parallel_camera_without_height: "sphere(1)\ncamera(eye: [0, 0, 5], height: 0)\n";
    reflections_out_of_range: "sphere(1)\nreflections(count: 9, strength: 1.5)\n";
    settings_out_of_range: "sphere(1)\nmarch(steps: 0, method: \"spere\")\n";
}

#[test]
fn independent_errors_come_together() {
    let (_, scene, found) = front("sphere(-1)\nbox(-1)\nsphere(-1) | torus(major: -1)\n");
    assert!(scene.is_none());
    assert_eq!(found.len(), 4, "{found:#?}");
}

#[test]
fn exponential_recursion_ends() {
    let text =
        "fn f(n: int) -> number = if n == 0 { 1 } else { f(n - 1) + f(n - 1) }\nsphere(f(60))\n";
    let (_, scene, found) = front(text);
    assert!(scene.is_none());
    assert_eq!(found[0].code.0, "E0406");
}

#[test]
fn long_chains_do_not_overflow() {
    let chain = vec!["1"; 4000].join(" + ");
    let (_, scene, found) = front(&format!("sphere({chain})"));
    assert!(scene.is_some(), "{found:?}");
}
