//! The diagnostics of elaboration: scenes with errors and their messages.

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
    an_argument_outside_its_range_is_an_error: "let r = -0.2\nsphere(r)\n";
    a_vector_outside_its_range_is_an_error: "box([1, -1, 2])\n";
    a_param_that_can_leave_the_range_is_an_error: "param r = 0.5 in -1..1\nsphere(r * 2)\n";
    a_param_without_a_range_goes_from_0_to_twice_its_default: "param r = 0.5\nsphere(r - 1)\n";
    a_default_outside_the_range_of_its_param_is_an_error: "param r = 3 in 0..1\nsphere(r)\n";
    a_false_requirement_is_an_error: "plane(normal: [0, 0, 0])\n";
    a_requirement_that_a_param_violates_is_an_error: "param s = 0.5 in 0..1\nsphere(1).scale(s)\n";
    a_requirement_that_a_range_without_a_statement_violates_is_an_error:
        "param s = 0.5\nparam a = -20deg\nbox(1).scale(s)\nbox(1).rotate(y: a).scale(-a / 1rad)\n";
    colours_above_1_are_warned_of: "sphere(1).color(rgb(255, 128, 0)).emission(rgb(2, 1.5, 0))\n";
    a_false_requirement_of_the_scene_is_an_error:
        "solid ring(inner: length, outer: length)\n  require inner < outer, \"the inner radius is the smaller one\"\n  = max(length(p) - outer, inner - length(p))\nring(1, 0.5)\n";
    a_division_by_zero_is_an_error: "let n = 0\nsphere(1 / n)\n";
    the_root_of_a_negative_number_is_an_error: "sphere(sqrt(0 - 1))\n";
    an_error_in_nested_functions_shows_their_calls:
        "fn leg(r: length) = cylinder(r: r)\nfn pair(r: length) = leg(r) | leg(r - 1)\npair(0.5)\n";
    an_error_in_the_library_is_shown_at_the_call: "union(blend: smooth(1))\n";
    a_sequence_that_depends_on_time_is_an_error: "union(for i in 0..floor(time): sphere(i))\n";
    an_index_past_the_end_is_an_error: "let radii = [1, 2]\nsphere(radii[2])\n";
    endless_recursion_is_an_error: "fn f(n: int) -> solid = f(n - 1)\nf(7)\n";
    recursion_on_time_is_an_error:
        "fn f(n: number) -> solid = if n <= 0 { sphere(1) } else { f(n - 1).round(0.1) }\nf(time)\n";
    too_many_nodes_are_an_error:
        "union(for x in 0..200: for y in 0..200: for z in 0..200: sphere(0.1).translate([x, y, z]))\n";
    a_sequence_that_is_too_long_is_an_error: "union(for x in 0..10000000: sphere(x))\n";
    shapes_nested_too_deeply_are_an_error:
        "fn chain(n: int) -> solid = if n == 0 { sphere(1) } else { chain(n - 1).round(0.1) }\nfn long(n: int, a: solid) -> solid = if n == 0 { a } else { long(n - 1, a.round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1).round(0.1)) }\nlong(60, chain(10))\n";
    too_many_iterations_are_an_error: "sphere(iterate(5000, 1, fn(s) = s))\n";
    a_string_that_is_too_long_is_an_error:
        "fn long(n: int) -> string = if n == 0 { \"sdf\" } else { str(long(n - 1), long(n - 1)) }\ntext(long(14)).extrude(1)\n";
    a_string_of_a_number_that_changes_is_an_error: "text(str(time)).extrude(1)\n";
    an_infinite_radius_is_an_error: "let r = inf\nsphere(r)\n";
    the_minimum_of_an_empty_list_is_an_error: "solid it() = min([for x in [1] if x > 2: x])\nit()\n";
    sky_and_background_exclude_each_other: "sphere(1)\nsky()\nbackground(#123)\n";
    lights_out_of_range_are_errors:
        "sphere(1)\nsun(shadow: soft(0))\nspot_light(position: [0, 3, 0], angle: 90deg)\nfog(density: -1)\nambient_occlusion(radius: 0, strength: 2)\nantialias(samples: 0)\n";
    too_many_lights_are_an_error:
        "sphere(1)\nsun()\nsun()\nsun()\nsun()\nsun()\npoint_light(position: 1)\nspot_light(position: 2)\nsun()\nsun()\npoint_light(position: 3)\n";
    a_camera_of_height_0_is_an_error: "sphere(1)\ncamera(eye: [0, 0, 5], height: 0)\n";
    reflections_out_of_range_are_errors: "sphere(1)\nreflections(count: 9, strength: 1.5)\n";
    march_settings_out_of_range_are_errors: "sphere(1)\nmarch(steps: 0, method: \"spere\")\n";
}

#[test]
fn independent_errors_are_all_reported() {
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
fn a_long_sum_does_not_overflow_the_stack() {
    let chain = vec!["1"; 4000].join(" + ");
    let (_, scene, found) = front(&format!("sphere({chain})"));
    assert!(scene.is_some(), "{found:?}");
}
