//! `iterate`: when it becomes a loop, when it is unrolled, and that both give the same values.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod support;

use sdfc_graph::Node;
use support::{Field, elaborated, root};

/// Distances of a formula at a few points.
fn values(formula: &str) -> Vec<f64> {
    let field =
        Field::drawn(&format!("param count: int = 7 in 0..40\nsolid it() = {formula}\nit()"));
    let places = [-1.3, -0.4, 0.0, 0.2, 0.9, 2.5];
    places.iter().map(|&x| field.at([x, 0.5 * x + 0.1, 0.3 - x])).collect()
}

/// The number of loops in a formula.
fn loops(formula: &str) -> usize {
    let scene =
        elaborated(&format!("param count: int = 7 in 0..40\nsolid it() = {formula}\nit()")).scene;
    let mut found: Vec<_> = sdfc_graph::reachable(&scene.graph, &[root(&scene).formula])
        .into_iter()
        .filter_map(
            |id| if let Node::Loop(id, ..) = scene.graph.node(id) { Some(id) } else { None },
        )
        .collect();
    found.sort_unstable();
    found.dedup();
    found.len()
}

#[track_caller]
fn same(looped: &str, written: &str) {
    assert_eq!((loops(looped), loops(written)), (1, 0), "{looped}");
    for (a, b) in values(looped).into_iter().zip(values(written)) {
        assert!((a - b).abs() <= 1e-12 * (1.0 + b.abs()), "{looped}: {a}, not {b}");
    }
}

#[test]
fn long_counts_and_ranges_become_loops() {
    same(
        "iterate(20, p.x, fn(s, i) = sin(s) + i * p.y)",
        "iterate(10..20, iterate(10, p.x, fn(s, i) = sin(s) + i * p.y), fn(s, i) = sin(s) + i * p.y)",
    );
    same(
        "iterate(-9..9, p.x, fn(s, i) = 0.9 * s + i)",
        "iterate(0..9, iterate(-9..0, p.x, fn(s, i) = 0.9 * s + i), fn(s, i) = 0.9 * s + i)",
    );
}

#[test]
fn a_record_is_the_state_of_one_loop() {
    // An orbit with its least distance to a point, and whether it was ever near.
    let step = "fn(s) = {
        let q = 1.1 * s.at.yzx - 0.2 * p
        let d = length(q - [0.3, 0, 0])
        (at: q, trap: (least: min(s.trap.least, d), near: s.trap.near || d < 0.5), n: s.n + 1)
    }, while: fn(s) = length(s.at) < 4";
    let start = "(at: p, trap: (least: 9, near: false), n: 0)";
    let result = "s.at.x + s.trap.least + s.n + if s.trap.near { 3 } else { 0 }";
    let written = (0..5).fold(start.to_owned(), |s, _| format!("iterate(4, {s}, {step})"));
    same(
        &format!("{{ let s = iterate(20, {start}, {step}); {result} }}"),
        &format!("{{ let s = {written}; {result} }}"),
    );
}

#[test]
fn a_condition_ends_a_loop() {
    same(
        "iterate(8, p, fn(q) = 1.5 * q.yzx + 0.1, while: fn(q) = length(q) < 3).x",
        "iterate(4, iterate(4, p, fn(q) = 1.5 * q.yzx + 0.1, while: fn(q) = length(q) < 3), \
         fn(q) = 1.5 * q.yzx + 0.1, while: fn(q) = length(q) < 3).x",
    );
}

#[test]
fn a_list_of_constants_becomes_a_table() {
    let list = "[for i in 0..20: [sin(i), cos(3 * i), 0.1 * i]]";
    same(
        &format!("iterate({list}, 100, fn(s, c) = min(s, length(p - c)))"),
        &format!("min([for c in {list}: length(p - c)])"),
    );
    // The neighbour in the list is found by the index of the iteration.
    same(
        &format!(
            "{{ let l = {list}\n iterate(len(l), 0, fn(s, i) = s + dot(l[i], l[(i + 1) % len(l)] - p)) }}"
        ),
        &format!(
            "{{ let l = {list}\n let all = [for i in 0..20: dot(l[i], l[(i + 1) % 20] - p)]\n \
                  iterate(all, 0, fn(s, x) = s + x) }}"
        ),
    );
}

#[test]
fn a_fractional_index_reads_the_element_below_it() {
    let field = Field::drawn("let l = [2, 3, 5, 7, 11, 13]\nsolid it() = l[floor(p.x)]\nit()");
    for (x, expected) in [(-7.5, 2.0), (0.0, 2.0), (2.9, 5.0), (5.0, 13.0), (1e9, 13.0)] {
        assert_eq!(field.at([x, 0.0, 0.0]), expected, "at {x}");
    }
}

#[test]
fn a_param_can_be_the_count_of_a_loop() {
    same("iterate(count, p.x, fn(s, i) = 0.5 * s + i)", "iterate(7, p.x, fn(s, i) = 0.5 * s + i)");
}

#[test]
fn loops_can_be_nested() {
    let nested =
        "iterate(20, p.x, fn(s, i) = 0.1 * iterate(18, s, fn(t, j) = 0.9 * t + j + i + p.y))";
    assert_eq!(loops(nested), 2);
    let written = "iterate([for i in 0..20: i + 0 * p.x], p.x, \
                   fn(s, i) = 0.1 * iterate([for j in 0..18: j + 0 * p.x], s, fn(t, j) = 0.9 * t + j + i + p.y))";
    for (a, b) in values(nested).into_iter().zip(values(written)) {
        assert!((a - b).abs() <= 1e-9 * (1.0 + b.abs()), "{a}, not {b}");
    }
}

#[test]
fn loops_can_sample_shapes() {
    let star = "polygon([for k in 0..20: (1 + k % 2) * [cos(k * 18deg), sin(k * 18deg)]])";
    let among_loops = format!("0.1 * iterate(18, s, fn(t, j) = 0.9 * t + {star}(p.yz - i - j))");
    // The loops of the formula itself. The star has one, too.
    for (of_shape, count) in
        [("sphere(0.5)(p - i)", 1), (&format!("{star}(p.xy - i)"), 1), (&among_loops, 2)]
    {
        let looped = format!("iterate(20, 9, fn(s, i) = min(s, {of_shape}))");
        assert_eq!(loops(&looped), count, "{looped}");
        let written = looped
            .replace("iterate(20,", "iterate([for i in 0..20: i + 0 * p.x],")
            .replace("iterate(18,", "iterate([for j in 0..18: j + 0 * p.x],");
        for (a, b) in values(&looped).into_iter().zip(values(&written)) {
            assert!((a - b).abs() <= 1e-9 * (1.0 + b.abs()), "{looped}: {a}, not {b}");
        }
    }
}

#[test]
fn loops_whose_iterations_differ_are_unrolled() {
    for formula in [
        // Shapes that change.
        "iterate(20, 9, fn(s, i) = min(s, sphere(0.1 * i)(p)))",
        // A list of shapes, and a list of numbers that depend on the point.
        "iterate([for i in 0..20: sphere(0.1 * i)], 9, fn(s, a) = min(s, a(p)))",
        "iterate([for i in 0..20: p.x * i], 9, min)",
        // A count that must be constant.
        "iterate(20, p.x, fn(s, i) = s + len([for k in 0..i: k]))",
        // A loop that does not depend on a point.
        "iterate(1000, 1, fn(s) = s * 0.5)",
        "iterate(count, 1, fn(s) = s * 0.5)",
    ] {
        assert_eq!(loops(formula), 0, "{formula}");
        assert!(values(formula).iter().all(|value| value.is_finite()), "{formula}");
    }
}

#[test]
fn an_error_in_a_loop_body_is_reported_once() {
    let (_, scene, found) =
        support::front("solid it() = iterate(20, p.x, fn(s) = s + 1 / 0)\nit()");
    assert!(scene.is_none());
    assert_eq!(found.len(), 1, "{found:?}");
}

#[test]
fn the_iterations_of_nested_loops_are_limited_together() {
    let nested = |inner: u32| {
        format!(
            "solid it() = iterate(4000, p.x, fn(s) = iterate({inner}, s, fn(t) = sin(t)))\nit()"
        )
    };
    assert!(support::front(&nested(16)).1.is_some());
    let (_, scene, found) = support::front(&nested(17));
    assert!(scene.is_none());
    assert!(found[0].message.contains("68000 iterations; the limit is 65536"), "{found:?}");
}
