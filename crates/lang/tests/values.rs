//! Library formulas at points worked out by hand.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod support;

use support::Field;

fn assert_at(text: &str, points: &[([f64; 3], f64)]) {
    let field = Field::drawn(text);
    for &(point, expected) in points {
        let found = field.at(point);
        assert!((found - expected).abs() < 1e-12, "{text} at {point:?}: {found}, not {expected}");
    }
}

#[test]
fn solids_have_the_distances_worked_out_by_hand() {
    assert_at("sphere(0.5)", &[([0.0; 3], -0.5), ([0.0, 3.0, 4.0], 4.5)]);
    assert_at(
        "box([2, 4, 6])",
        &[([0.0; 3], -1.0), ([2.0, 2.0, 4.0], 2f64.sqrt()), ([4.0, 4.0, 4.0], 14f64.sqrt())],
    );
    assert_at("plane(y: 1)", &[([7.0, 0.0, -3.0], -1.0), ([0.0, 3.0, 0.0], 2.0)]);
    assert_at("plane(y: 1, normal: [0, 0, 2])", &[([7.0, 5.0, 3.0], 2.0)]);
    assert_at(
        "torus(major: 2, minor: 0.5)",
        &[([0.0; 3], 1.5), ([2.0, 0.0, 0.0], -0.5), ([0.0, 4.0, 5.0], 4.5)],
    );
    assert_at(
        "capsule([0, -1, 0], [0, 1, 0], r: 0.25)",
        &[([3.0, 0.5, 0.0], 2.75), ([3.0, 5.0, 0.0], 4.75), ([0.0; 3], -0.25)],
    );
    assert_at("capsule([1, 0, 0], [1, 0, 0], r: 0.5)", &[([4.0, 0.0, 4.0], 4.5)]);
    assert_at(
        "cylinder(r: 1, h: 2)",
        &[
            ([0.0; 3], -1.0),
            ([0.0, 4.0, 0.0], 3.0),
            ([4.0, 5.0, 0.0], 5.0),
            ([0.5, 0.0, 0.0], -0.5),
        ],
    );
    // The unit ball's field, scaled by the smallest radius.
    assert_at("ellipsoid([1, 0.5, 2])", &[([2.0, 0.0, 0.0], 0.5), ([0.0; 3], -0.5)]);
    // On an axis the first-order estimate is r (k0 - 1): the distance itself.
    assert_at("ellipsoid_fast([1, 0.5, 2])", &[([3.0, 0.0, 0.0], 2.0), ([0.0; 3], -0.5)]);
}

/// The orientation of solids.
#[test]
fn solids_stand_the_right_way_round() {
    // The middle of the arc is on the x axis; half a ring does not reach negative x.
    assert_at(
        "capped_torus(arc: 180deg, major: 2, minor: 0.5)",
        &[([2.0, 0.0, 0.0], -0.5), ([-3.0, 0.0, 2.0], 2.5)],
    );
    assert_at("link(straight: 2, major: 1, minor: 0.25)", &[([0.0, 2.0, 0.0], -0.25)]);
    assert_at("cone(r: 1, h: 2)", &[([0.0, 3.0, 0.0], 2.0), ([3.0, -3.0, 0.0], 8f64.sqrt())]);
    assert_at("capped_cone(h: 2, r1: 3, r2: 1)", &[([1.0, -2.0, 0.0], 1.0), ([0.0; 3], -1.0)]);
    assert_at(
        "solid_angle(r: 2, open: 90deg)",
        &[([0.0, 3.0, 0.0], 1.0), ([3.0, -3.0, 0.0], 18f64.sqrt())],
    );
    assert_at("cut_sphere(r: 2, y: 1)", &[([0.0, 2.0, 0.0], 1.0), ([0.0, -3.0, 0.0], 1.0)]);
    assert_at(
        "cut_hollow_sphere(r: 2, y: 0, wall: 0.2)",
        &[([0.0, -2.0, 0.0], -0.1), ([2.0, 1.0, 0.0], 0.9)],
    );
    assert_at("death_star(r1: 2, r2: 1, d: 2)", &[([0.0, 2.0, 0.0], 1.0), ([0.0, -3.0, 0.0], 1.0)]);
    // A quarter turn counter-clockwise from x is -z.
    assert_at(
        "helix(major: 2, minor: 0.5, pitch: 4, h: 9)",
        &[([2.0, 0.0, 0.0], -0.5), ([0.0, 1.0, -2.0], -0.5), ([-2.0, 2.0, 0.0], -0.5)],
    );
    assert_at("tri_prism(r: 2, h: 1)", &[([3.0, 0.0, 0.0], 1.0), ([-3.0, 0.0, 0.0], 2.0)]);
    assert_at("hex_prism(r: 2, h: 1)", &[([3.0, 0.0, 0.0], 1.0), ([0.0, 2.0, 0.0], 1.5)]);
    assert_at("rhombic_prism([4, 2], h: 1)", &[([3.0, 0.0, 0.0], 1.0), ([0.0, 0.0, 2.0], 1.0)]);
    assert_at("pyramid(base: 2, h: 2)", &[([0.0, 3.0, 0.0], 2.0), ([2.0, -1.0, 2.0], 2f64.sqrt())]);
    assert_at("tetrahedron(r: 3)", &[([0.0, 4.0, 0.0], 1.0), ([0.0, -3.0, 0.0], 2.0)]);
    assert_at("octahedron(2)", &[([3.0, 0.0, 0.0], 1.0), ([2.0; 3], 4.0 / 3f64.sqrt())]);
}

#[test]
fn regions_have_the_distances_worked_out_by_hand() {
    assert_at("circle(0.5).extrude(2)", &[([3.0, 4.0, 0.0], 4.5), ([0.0, 0.0, 5.0], 4.0)]);
    assert_at("rect([2, 4]).extrude(6)", &[([4.0, 4.0, 4.0], 14f64.sqrt())]);
    assert_at("circle(0.5).translate(x: 2).revolve()", &[([0.0, 0.0, 2.0], -0.5), ([0.0; 3], 1.5)]);
}

#[test]
fn maps_move_points_the_right_way() {
    assert_at("sphere(1).translate([1, 2, 3], y: 1)", &[([1.0, 3.0, 3.0], -1.0)]);
    // A quarter turn about z takes x to y; about y takes z to x; about x takes y to z.
    let ball = "sphere(0.5).translate";
    assert_at(&format!("{ball}(x: 2).rotate(z: 90deg)"), &[([0.0, 2.0, 0.0], -0.5)]);
    assert_at(&format!("{ball}(z: 2).rotate(y: 90deg)"), &[([2.0, 0.0, 0.0], -0.5)]);
    assert_at(&format!("{ball}(y: 2).rotate(x: 90deg)"), &[([0.0, 0.0, 2.0], -0.5)]);
    // x comes first: y to z, then z to x.
    assert_at(&format!("{ball}(y: 2).rotate(x: 90deg, y: 90deg)"), &[([2.0, 0.0, 0.0], -0.5)]);
    assert_at(
        "circle(0.5).translate(x: 2).rotate(0.25turn).extrude(1)",
        &[([0.0, 2.0, 0.0], -0.5)],
    );
    assert_at("sphere(1).scale(3)", &[([5.0, 0.0, 0.0], 2.0)]);
    assert_at("box(2).round(0.5)", &[([3.0, 0.0, 0.0], 1.5)]);
    // One unit up the twist is a quarter turn about y: from z to x.
    assert_at("sphere(0.5).translate(z: 2, y: 1).twist(90deg)", &[([2.0, 1.0, 0.0], -0.5)]);
}

#[test]
fn combinations_have_the_distances_worked_out_by_hand() {
    let pair = "sphere(1), sphere(1).translate(x: 3)";
    assert_at(&format!("union({pair})"), &[([0.0; 3], -1.0), ([3.0, 0.0, 0.0], -1.0)]);
    assert_at(&format!("intersection({pair})"), &[([0.0; 3], 2.0)]);
    assert_at(&format!("difference({pair})"), &[([0.0; 3], -1.0), ([3.0, 0.0, 0.0], 2.0)]);
    // Equal distances swell by k / 4; k = 0 is the hard union.
    let middle = [1.5, 0.0, 0.0];
    assert_at(&format!("union({pair}, blend: smooth(0.4))"), &[(middle, 0.5 - 0.1)]);
    assert_at(
        &format!("union({pair}, blend: smooth(0))"),
        &[(middle, 0.5), ([1.0, 0.0, 0.0], 0.0)],
    );
    assert_at(&format!("intersection({pair}, blend: smooth(0.4))"), &[(middle, 0.5 + 0.1)]);
    // Half the sum less the leg: 0.5 (0.5 + 0.5 - 0.4).
    assert_at(&format!("union({pair}, blend: chamfer(0.4))"), &[(middle, 0.3)]);
    assert_at("sphere(1) - box(4) | sphere(0.5)", &[([0.0; 3], -0.5)]);
}

#[test]
fn drawn_solids_are_joined_in_order() {
    assert_at("sphere(1)\nsphere(1).translate(x: 3)", &[([0.0; 3], -1.0), ([3.0, 0.0, 0.0], -1.0)]);
}

#[test]
fn expressions_have_the_values_worked_out_by_hand() {
    let value = |expression: &str, expected: f64| {
        assert_at(&format!("solid it() = {expression}\nit()"), &[([0.25, 0.5, -0.75], expected)]);
    };
    value("iterate(4, 1, fn(s) = s * 2)", 16.0);
    value("iterate(4, 1, fn(s, i) = s + i)", 7.0);
    value("iterate(2..5, 0, fn(s, i) = s + i)", 9.0);
    value("iterate([1, 2, 3], 0, fn(s, x) = 10 * s + x)", 123.0);
    value("iterate(10, 1, fn(s) = s * 2, while: fn(s) = s < 20)", 32.0);
    value("iterate(10, p.x, fn(s) = s * 2, while: fn(s) = s < 20)", 32.0);
    value("min(for i in 0..5 if i % 2 == 1: i)", 1.0);
    value("max([for i in 0..3: i * p.y])", 1.0);
    value("[for i in 0..4: i * i][2]", 4.0);
    value("[5, 6, 7, 8, 9][1..3][1]", 7.0);
    value("len([for x in [1, 2]: for y in [1, 2, 3]: x + y])", 6.0);
    value("-7 % 3", 2.0);
    value("p.zyx.x + vec3(p.xy, 2).z", 1.25);
    value("if p.x > 0 { p.y } else { 3 }", 0.5);
    value("{ let q = p * 2; let q = q.x + 1; q }", 1.5);
}

#[test]
fn a_loop_with_a_param_as_count_runs_to_its_range() {
    let text = "param n: int = 3 in 0..5\nsolid it() = iterate(n, 1, fn(s) = s * 2)\nit()";
    assert_at(text, &[([0.0; 3], 8.0)]);
}

#[test]
fn recursion_ends_at_compile_time() {
    let text = "fn tower(n: int) -> solid = if n == 0 { sphere(1) } else { tower(n - 1).translate(y: 2) }\ntower(5)";
    assert_at(text, &[([0.0, 10.0, 0.0], -1.0)]);
}

#[test]
fn colours_are_decoded_to_linear() {
    // A shape's formula can use a colour's channels like the components of a vector.
    let assert_color = |color: &str, expected: [f64; 4]| {
        for (lane, expected) in ["r", "g", "b", "a"].into_iter().zip(expected) {
            let found = Field::drawn(&format!("solid it() = {color}.{lane}\nit()")).at([0.0; 3]);
            assert!((found - expected).abs() < 1e-6, "{color}.{lane}: {found}, not {expected}");
        }
    };
    assert_color("#f80", [1.0, 0.246_201_3, 0.0, 1.0]);
    assert_color("rgb(1, 0.533333333, 0)", [1.0, 0.246_201_3, 0.0, 1.0]);
    assert_color("rgb(0.02, 0, 0, 0.5)", [0.02 / 12.92, 0.0, 0.0, 0.5]);
    assert_color("hsv(0, 1, 1)", [1.0, 0.0, 0.0, 1.0]);
    assert_color("hsv(1 / 3, 1, 1)", [0.0, 1.0, 0.0, 1.0]);
    assert_color("hsv(2 / 3, 1, 1)", [0.0, 0.0, 1.0, 1.0]);
    assert_color("hsv(s: 1, h: 120deg, v: 1)", [0.0, 1.0, 0.0, 1.0]);
    assert_color("hsl(l: 0.5, s: 1, h: 240deg)", [0.0, 0.0, 1.0, 1.0]);
    assert_color("hsv(0.2, 0, 1)", [1.0, 1.0, 1.0, 1.0]);
    assert_color("hsv(1 / 6, 1, 0.5)", [0.214_041_1, 0.214_041_1, 0.0, 1.0]);
    // Ottosson's own table: the hue and chroma of sRGB red.
    assert_color("oklch(0.6279554, 0.2576833, 29.2338804deg)", [1.0, 0.0, 0.0, 1.0]);
    assert_color("oklch(1, 0, 0)", [1.0, 1.0, 1.0, 1.0]);
}

#[test]
fn hashes_are_spread_over_0_to_1_and_depend_on_every_argument() {
    let value =
        |expression: &str| Field::drawn(&format!("solid it() = {expression}\nit()")).at([0.0; 3]);
    let values: Vec<f64> = (0..100).map(|i| value(&format!("hash({i})"))).collect();
    assert!(values.iter().all(|value| (0.0..1.0).contains(value)));
    let mean = values.iter().sum::<f64>() / 100.0;
    assert!((mean - 0.5).abs() < 0.1, "{mean}");
    assert_eq!(value("hash(1.9)"), value("hash(1)"), "the whole part counts");
    assert_ne!(value("hash(1, 2)"), value("hash(2, 1)"));
    assert_ne!(value("hash3(1).x"), value("hash3(1).y"));
    assert_ne!(value("hash3(1).x"), value("hash3(2).y"));
    assert_eq!(value("hash(p.x + 3.5, [p.y, p.z] - 0.5)"), value("hash(3, -1, -1)"));
    assert_eq!(value("hash3(p.x + 3).z"), value("hash3(3).z"));
}

#[test]
fn ten_thousand_shapes_become_one_union() {
    let text = "union(for i in 0..10000: sphere(0.1).translate(x: i))";
    assert_at(text, &[([9999.0, 0.0, 0.0], -0.1)]);
}

/// Copies of shapes without an end along an axis on which nothing is repeated.
#[test]
fn endless_shapes_are_repeated_along_the_other_axes() {
    let bars = |half: f64, copies: &str| {
        format!(
            "solid bar() bounds [-{half}, -{half}, -inf]..[{half}, {half}, inf]
             = max(abs(p.x), abs(p.y)) - {half}
             bar().{copies}"
        )
    };
    let within = [([0.0, 0.0, 5.0], -0.2), ([0.25, 0.0, -3.0], 0.05), ([0.5, 0.0, 7.0], 0.3)];
    assert_at(&bars(0.2, "repeat([1, 1, 0])"), &within);
    assert_at(&bars(0.48, "repeat([1, 1, 0])"), &[([0.5, 0.0, 3.0], 0.02)]);
    let limited = "limited_repeat([1, 1, 0], count: [3, 3, 1])";
    assert_at(&bars(0.2, limited), &[([0.0, 0.0, 5.0], -0.2), ([2.0, 0.0, 5.0], 0.8)]);
    assert_at(&bars(0.48, limited), &[([0.5, 0.0, 3.0], 0.02), ([2.0, 0.0, 5.0], 0.52)]);
    let strips = |copies: &str| {
        let strip = "region strip() bounds [-0.2, -inf]..[0.2, inf] = abs(p.x) - 0.2";
        format!("{strip}\nstrip().{copies}.extrude(2)")
    };
    assert_at(&strips("repeat([1, 0])"), &[([0.0, 9.0, 0.0], -0.2), ([0.5, 9.0, 0.0], 0.3)]);
    let limited = "limited_repeat([1, 0], count: [3, 1])";
    assert_at(&strips(limited), &[([0.0, 9.0, 0.0], -0.2), ([2.0, 9.0, 0.0], 0.8)]);
}
