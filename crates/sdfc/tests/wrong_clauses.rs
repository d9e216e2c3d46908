//! Scenes with wrong clauses: `check` reports them. The test `uncertified` of `sdfc-measure` has those
//! that samples do not find.

use sdfc::{Compiler, Diagnostic, Severity};

/// Each finding's code, and the text that it points at.
fn findings(text: &str) -> Vec<(String, String, Severity)> {
    let found = Compiler::new().verify(true).check("lie.sdf", text);
    let told = |diagnostic: &Diagnostic| {
        let span = diagnostic.span;
        let place = text.get(span.start as usize..span.end as usize).unwrap_or_default();
        (diagnostic.code.0.to_owned(), place.to_owned(), diagnostic.severity)
    };
    found.iter().map(told).collect()
}

/// The one finding, its code and where it points.
fn told(text: &str, code: &str, place: &str) {
    let found = findings(text);
    let is_told = |(c, p, _): &(String, String, Severity)| c == code && p == place;
    assert!(found.iter().any(is_told), "{code} at `{place}` is wanted in\n{text}\n{found:?}");
}

#[test]
fn a_constant_stated_too_small() {
    let text = "solid a() lipschitz 1 bounds -1..1 = 3 * (length(p) - 0.5)\na()";
    told(text, "E0502", "1");
}

#[test]
fn a_field_that_exceeds_the_distance() {
    told("solid a() bound = 3 * (length(p) - 0.5)\na()", "E0502", "bound");
    told("solid a() exact = 0.5 * (length(p) - 0.5)\na()", "E0502", "exact");
}

#[test]
fn a_jump_that_is_stated_not_to_be_one() {
    let text = "solid a() lipschitz 1 = length([p.x - floor(p.x), p.y, p.z]) - 0.3\na()";
    told(text, "E0502", "1");
}

#[test]
fn a_jump_of_which_nothing_is_stated() {
    let text = "solid a() = length([p.x - floor(p.x), p.y, p.z]) - 0.3\na()";
    told(text, "W0602", "a()");
}

#[test]
fn a_slope_without_end() {
    told("solid a() = exp(p.x) - 2 * p.y\na()", "W0602", "a()");
    told("solid a() = p.y - p.x * p.x * p.x\na()", "W0602", "a()");
}

#[test]
fn a_constant_below_zero() {
    told("solid a() lipschitz -1 = p.y\na()", "E0309", "-1");
    told("fn f(x: number) lipschitz -3 = 2 * x\nsolid a() = f(p.y)\na()", "E0309", "-3");
}

#[test]
fn bounds_that_cut_the_surface_off() {
    told("solid a() lipschitz 1 bounds -0.4..0.4 = length(p) - 0.5\na()", "E0502", "-0.4..0.4");
}

#[test]
fn an_even_wall_of_a_field_that_is_no_distance() {
    told("ellipsoid([1, 0.4, 0.4]).shell(0.05)", "W0601", "ellipsoid([1, 0.4, 0.4]).shell(0.05)");
}

#[test]
fn a_function_that_understates_its_slope() {
    let text = "fn steep(t) lipschitz 1 = if t > 0 { 4 * t } else { t }\nsolid a() = steep(length(p) - 0.5)\na()";
    told(text, "E0502", "1");
    let text = "fn steps(t) lipschitz 1.5 = floor(5 * t) / 5\nsolid a() = max(length(p.xz) - 1, steps(p.y))\na()";
    told(text, "E0502", "1.5");
    // Only at an end of a param's range.
    let text = "param k = 1 in 0..3\nfn steep(t) lipschitz 1 = k * t\nsolid a() = -steep(0.5 - length(p))\na()";
    told(text, "E0502", "1");
    // A blend of one's own, and a function without a name.
    let text = "fn ridge(k: length) -> blend = fn(a, b) lipschitz 1 = min(a, b) + 2 * max(k - abs(a - b), 0)\n\
                union(sphere(0.5), box(0.8), blend: ridge(0.1))";
    told(text, "E0502", "1");
}

#[test]
fn copies_that_reach_farther_than_is_said() {
    let row = |limit: &str| {
        format!(
            "solid row(a: solid)\n  copies\n  = {{\n    let t = p.x - round(p.x)\n    \
             min(a([t, p.y, p.z]), {limit})\n  }}\nrow(sphere(0.3)) & box([9, 2, 2])"
        )
    };
    let copies = |text: &str| {
        findings(text).into_iter().filter(|(_, place, _)| place == "copies").collect::<Vec<_>>()
    };
    assert_eq!(copies(&row("0.7 - abs(t)")), []);
    told(&row("0.75 - abs(t)"), "E0502", "copies");
    // The limit is no part of the shape.
    told(&row("p.y"), "E0502", "copies");
    // What cuts a copy is not its box.
    told(
        &row("0.7 - abs(t)").replace("a([t, p.y, p.z])", "max(a([t, p.y, p.z]), p.y)"),
        "E0502",
        "copies",
    );
}
