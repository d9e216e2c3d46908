//! `str` and `sum`, by the values that follow from them.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod support;

use support::Field;

/// The radius of the ball that a formula gives.
fn radius(formula: &str) -> f64 {
    -Field::drawn(&format!("sphere({formula})")).at([0.0; 3])
}

/// True if an expression is the string.
fn is_string(expression: &str, string: &str) -> bool {
    radius(&format!("if {expression} == \"{string}\" {{ 1 }} else {{ 2 }}")) == 1.0
}

#[test]
fn strings_and_numbers_are_joined() {
    assert!(is_string("str(\"No. \", 7)", "No. 7"));
    assert!(is_string("str(\"a\", \"b\", \"c\")", "abc"));
    assert!(is_string("str(0.5)", "0.5"));
    assert!(is_string("str(1 / 3)", "0.333333"));
    assert!(is_string("str(-2 * 2)", "-4"));
    assert!(!is_string("str(1, 2)", "3"));
}

#[test]
fn a_sum_adds_values_lists_and_components() {
    for (formula, sum) in [
        ("sum(1, 2, 3.5)", 6.5),
        ("sum([for i in 1..5: i * i])", 30.0),
        ("sum(1, [for i in 2..4: i], 4)", 10.0),
        ("sum([1, 2, 4])", 7.0),
        ("sum(vec3(1, 2, 4))", 7.0),
        ("1 + sum([for i in 0..0: i])", 1.0),
        ("length(sum([[3, 0], [0, 4]]))", 5.0),
    ] {
        assert!(
            (radius(formula) - sum).abs() < 1e-12,
            "{formula} is {}, not {sum}",
            radius(formula)
        );
    }
}

/// The expected values are the published conversion, evaluated with numpy.
#[test]
fn colours_mix_in_oklab() {
    for (channel, expected) in [("r", 0.173_100_05), ("g", 0.364_816_7), ("b", 1.083_745_44)] {
        let found = radius(&format!("mix_oklab(#ffffff, #0000ff, 0.5).{channel}"));
        assert!((found - expected).abs() < 1e-6, "{channel}: {found}, not {expected}");
    }
    assert!((radius("mix_oklab(#ff8000, #0000ff, 0).g") - 0.215_860_5).abs() < 1e-6);
    assert!((radius("mix_oklab(#ff800080, #0000ff00, 0.5).a") - 0.25).abs() < 2e-3);
}
