//! `check` reports scenes with wrong clauses. The test `uncertified` of `sdfc-measure` has wrong
//! clauses that samples do not find.

use sdfc::{Compiler, Diagnostic, Severity};

/// Returns each diagnostic's code, the source at its span, and its severity.
fn diagnostics(text: &str) -> Vec<(String, String, Severity)> {
    let found = Compiler::new().verify(true).check("wrong.sdf", text);
    let located = |diagnostic: &Diagnostic| {
        let span = diagnostic.span;
        let source = text.get(span.start as usize..span.end as usize).unwrap_or_default();
        (diagnostic.code.0.to_owned(), source.to_owned(), diagnostic.severity)
    };
    found.iter().map(located).collect()
}

/// Checks that the code is reported at this part of the source.
fn expect(text: &str, code: &str, source: &str) {
    let found = diagnostics(text);
    let is_expected = |(c, s, _): &(String, String, Severity)| c == code && s == source;
    assert!(
        found.iter().any(is_expected),
        "{code} at `{source}` is expected in\n{text}\n{found:?}"
    );
}

#[test]
fn a_constant_that_is_too_small_is_refuted() {
    let text = "solid a() lipschitz 1 bounds -1..1 = 3 * (length(p) - 0.5)\na()";
    expect(text, "E0502", "1");
}

#[test]
fn a_field_that_is_no_distance_is_refuted() {
    expect("solid a() bound = 3 * (length(p) - 0.5)\na()", "E0502", "bound");
    expect("solid a() exact = 0.5 * (length(p) - 0.5)\na()", "E0502", "exact");
}

#[test]
fn a_constant_of_a_field_with_a_jump_is_refuted() {
    let text = "solid a() lipschitz 1 = length([p.x - floor(p.x), p.y, p.z]) - 0.3\na()";
    expect(text, "E0502", "1");
}

#[test]
fn a_jump_without_clauses_is_reported() {
    let text = "solid a() = length([p.x - floor(p.x), p.y, p.z]) - 0.3\na()";
    expect(text, "W0602", "a()");
}

#[test]
fn an_unbounded_slope_is_reported() {
    expect("solid a() = exp(p.x) - 2 * p.y\na()", "W0602", "a()");
    expect("solid a() = p.y - p.x * p.x * p.x\na()", "W0602", "a()");
}

#[test]
fn a_negative_constant_is_refused() {
    expect("solid a() lipschitz -1 = p.y\na()", "E0309", "-1");
    expect("fn f(x: number) lipschitz -3 = 2 * x\nsolid a() = f(p.y)\na()", "E0309", "-3");
}

#[test]
fn bounds_that_cut_the_surface_off_are_refuted() {
    expect("solid a() lipschitz 1 bounds -0.4..0.4 = length(p) - 0.5\na()", "E0502", "-0.4..0.4");
}

#[test]
fn a_shell_of_a_field_that_is_no_distance_is_reported() {
    expect("ellipsoid([1, 0.4, 0.4]).shell(0.05)", "W0601", "ellipsoid([1, 0.4, 0.4]).shell(0.05)");
}

#[test]
fn a_function_that_understates_its_slope_is_refuted() {
    let text = "fn steep(t) lipschitz 1 = if t > 0 { 4 * t } else { t }\nsolid a() = steep(length(p) - 0.5)\na()";
    expect(text, "E0502", "1");
    let text = "fn steps(t) lipschitz 1.5 = floor(5 * t) / 5\nsolid a() = max(length(p.xz) - 1, steps(p.y))\na()";
    expect(text, "E0502", "1.5");
    // The constant is wrong only at one end of a param's range.
    let text = "param k = 1 in 0..3\nfn steep(t) lipschitz 1 = k * t\nsolid a() = -steep(0.5 - length(p))\na()";
    expect(text, "E0502", "1");
    // A function of points of a plane, and one whose result simplification merges with others.
    for shape in ["circle(0.3)", "sphere(0.3)"] {
        let wave = "displace(fn(q) lipschitz 0.1 = 0.1 * sin(40 * q.x))";
        expect(&format!("{shape}.{wave}"), "E0502", "0.1");
    }
    // A blend that the scene defines, and a function without a name.
    let text = "fn ridge(k: length) -> blend = fn(a, b) lipschitz 1 = min(a, b) + 2 * max(k - abs(a - b), 0)\n\
                union(sphere(0.5), box(0.8), blend: ridge(0.1))";
    expect(text, "E0502", "1");
}

#[test]
fn wrong_copies_clauses_are_refuted() {
    let row = |limit: &str| {
        format!(
            "solid row(a: solid)\n  copies\n  = {{\n    let t = p.x - round(p.x)\n    \
             min(a([t, p.y, p.z]), {limit})\n  }}\nrow(sphere(0.3)) & box([9, 2, 2])"
        )
    };
    let copies = |text: &str| {
        diagnostics(text)
            .into_iter()
            .filter(|(_, source, _)| source == "copies")
            .collect::<Vec<_>>()
    };
    assert_eq!(copies(&row("0.7 - abs(t)")), []);
    expect(&row("0.75 - abs(t)"), "E0502", "copies");
    // The limit has nothing to do with the shape.
    expect(&row("p.y"), "E0502", "copies");
    // A copy that is cut by something other than its box.
    expect(
        &row("0.7 - abs(t)").replace("a([t, p.y, p.z])", "max(a([t, p.y, p.z]), p.y)"),
        "E0502",
        "copies",
    );
}
