//! Records: their fields, copies, conversions and types.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod support;

use support::Field;

/// The value of a number of a scene, with declarations before it.
fn value(declarations: &str, number: &str) -> f64 {
    let field = Field::drawn(&format!("{declarations}\nsolid it() = p.x + ({number})\nit()"));
    field.at([0.0; 3])
}

#[track_caller]
fn is(declarations: &str, number: &str, expected: f64) {
    let found = value(declarations, number);
    assert!((found - expected).abs() < 1e-12, "{declarations}: {number} is {found}");
}

#[test]
fn fields_are_read_by_name() {
    is("let a = (size: 3, at: [1, 2, 4])", "a.size + a.at.z", 7.0);
    is("fn ends(x) = (lo: x - 1, hi: x + 1)", "10 * ends(2).lo + ends(2).hi", 13.0);
    is("let a = (inner: (x: 5),)", "a.inner.x", 5.0);
    is("let a = (f: fn(x) = 2 * x)", "(a.f)(4)", 8.0);
    is("let all = [for i in 0..5: (i: i, square: i * i)]", "all[3].square + len(all)", 14.0);
}

#[test]
fn a_copy_differs_in_the_fields_that_are_named() {
    let declarations = "let a = (x: 1, y: 2, z: 3)\nlet b = a.with(z: 7, x: 5)";
    is(declarations, "100 * b.x + 10 * b.y + b.z", 527.0);
    is(declarations, "100 * a.x + 10 * a.y + a.z", 123.0);
    is("let a = (x: 1).with(x: 4)", "a.x", 4.0);
}

#[test]
fn the_order_of_the_fields_does_not_matter() {
    is("fn f(a: (x: number, y: number)) = 10 * a.x + a.y", "f((y: 1, x: 2))", 21.0);
    is("fn f(a: (x: number, y: number)) = 10 * a.x + a.y\nlet a = (y: 1, x: 2)", "f(a)", 21.0);
    is("let a = if 1 < 2 { (x: 1, y: 2) } else { (y: 3, x: 4) }", "10 * a.x + a.y", 12.0);
    is("let all = [for i in 0..1: (x: 1, y: 2), (y: 3, x: 4)]", "10 * all[1].x + all[1].y", 43.0);
}

#[test]
fn the_fields_of_a_record_take_the_types_that_are_expected() {
    // A number becomes a vector, and a colour a pattern.
    is(
        "fn f(a: (at: vec3, paint: pattern)) = a.at.y + (a.paint)([0, 0, 0]).r",
        "f((at: 2, paint: #fff))",
        3.0,
    );
    is("fn f(a: (at: vec3)) = a.at.y\nlet a = (at: 2)", "f(a)", 2.0);
    is("fn f(all: [(n: number)]) = all[1].n\nlet all = [(n: 1), (n: 2)]", "f(all)", 2.0);
}

#[test]
fn a_condition_that_changes_selects_each_field() {
    let declarations = "param side = true";
    is(
        declarations,
        "{ let a = if side { (x: 1, y: [2, 3]) } else { (y: [4, 5], x: 6) }; a.x + a.y.y }",
        4.0,
    );
    is(
        "param at: int = 2 in 0..5",
        "{ let all = [for i in 0..6: (x: i, y: 10 * i)]; all[at].x + all[at].y }",
        22.0,
    );
}

#[test]
fn a_function_can_return_a_shape_and_its_parts() {
    let text = "fn arm(length: length) = (body: box([length, 1, 1]), tip: [length / 2, 0, 0])\n\
                let a = arm(4)\na.body\nsphere(1).translate(a.tip)";
    let field = Field::drawn(text);
    assert!((field.at([3.0, 0.0, 0.0])).abs() < 1e-12);
    assert!((field.at([0.0, 1.0, 0.0]) - 0.5).abs() < 1e-12);
}

#[test]
fn materials_have_fields() {
    let m = "let m = material(color: #ff8000, roughness: 0.3, metallic: 1, emission: #fff)";
    is(m, "m.color.r + m.color.a + m.roughness + m.metallic + m.emission.g + m.occlusion", 5.3);
    is("let m = material_at(sphere(1).roughness(0.25), [0, 0, 0])", "m.roughness", 0.25);
}
