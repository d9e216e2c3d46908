//! The checker on the library and on whole scenes.
#![allow(missing_docs)]

mod common;

use common::verify::verify;
use common::{Library, printed};
use sdfc_diagnostics::render;

#[test]
fn every_library_entry_checks_in_both_dimensions() {
    let library = Library::new();
    let (program, found) = library.check_all();
    assert!(found.is_empty(), "{}", render(&library.sources, &found, false));
    assert!(program.shapes.len() > 20);
    verify(&program);
}

#[test]
fn a_scene_uses_only_the_library_items_it_needs() {
    let (program, found, _) = Library::new().check("sphere(1)\n");
    assert!(found.is_empty());
    let names: Vec<&str> = program.shapes.iter().map(|shape| shape.name.as_str()).collect();
    assert_eq!(names, ["union", "sphere"]);
}

#[test]
fn all_example_scenes_check() {
    let library = Library::new();
    for (name, text) in sdfc_test_support::example_sources().expect("the examples") {
        let (program, found, rendered) = library.check(&text);
        assert!(found.is_empty(), "{name}\n{rendered}");
        verify(&program);
    }
}

#[test]
fn a_blend_becomes_a_typed_program() {
    insta::assert_snapshot!(printed(
        "param k = 0.4 in 0..1
let ball = sphere(0.8).translate(y: 1)
union(ball, box(2), blend: smooth(k)).rotate(y: 30deg) - ball
camera(eye: [4, 3, 5], fov: 35deg)"
    ));
}

#[test]
fn a_lambda_captures_through_every_level() {
    insta::assert_snapshot!(printed(
        "solid bumpy(a: solid, h = 0.1) = {
  let n = 8
  let out = fn(q: vec3) = {
    let wave = fn(t) = h * sin(n * t) + q.y
    wave(q.x) + p.z
  }
  a(p) - out(p)
}
bumpy(sphere())"
    ));
}

#[test]
fn coercions_are_explicit() {
    insta::assert_snapshot!(printed(
        "fn far(a: vec3 = 1, f: fn(vec3) -> vec3 = 2, l: [vec2] = [1, [2, 3]]) = length(a + 1 - f(0))
shape grow(a: shape, by: fn(point) -> length) bounds -1..bounds(a).hi = a(p) - by(p)
let list = [for i in 0..3: 0.1 * i]
let range = 0..2
fn ends(r: range) = r.lo
circle(far(l: [list[0], 1])).grow(fn(q) = q.x).grow(ends(range)).grow(length).extrude()
sphere(min(list)).color(#f00 * 0.5)"
    ));
}
