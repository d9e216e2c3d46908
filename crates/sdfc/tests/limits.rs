//! Scenes that would take all memory or time: each is compiled or refused with a code and the
//! limit's number, and none ends the process.
#![allow(missing_docs, clippy::panic, reason = "a test fails by panicking")]

use sdfc::Compiler;

/// Returns the codes of the errors, and the rendered messages.
fn refused(text: &str) -> (Vec<String>, String) {
    let Err(errors) = Compiler::new().compile("bomb.sdf", text) else { panic!("it was compiled") };
    let codes = errors.located().iter().map(|found| found.code.to_owned()).collect();
    (codes, errors.render(false))
}

/// Checks that the scene is refused with this error alone, which names the limit.
fn stopped(text: &str, code: &str, limit: &str) {
    let (codes, message) = refused(text);
    assert_eq!(codes, [code], "{message}");
    assert!(message.contains(limit), "no `{limit}` in {message}");
}

fn nested(open: &str, middle: &str, close: &str) -> String {
    format!("{}{middle}{}", open.repeat(10_000), close.repeat(10_000))
}

#[test]
fn deep_nesting_is_refused() {
    stopped(&format!("sphere({})", nested("(", "1", ")")), "E0107", "256 levels");
    stopped(&format!("let a = {}\nsphere(1)", nested("[", "1", "]")), "E0107", "256 levels");
    stopped(&nested("union(", "sphere(1)", ")"), "E0107", "256 levels");
}

#[test]
fn long_chains_are_refused() {
    stopped(&format!("sphere({}1)", "1 + ".repeat(100_000)), "E0107", "4096 links");
    stopped(&format!("sphere(1){}", " | sphere(2)".repeat(100_000)), "E0107", "4096 links");
    stopped(&format!("sphere(1){}", ".round(0.1)".repeat(100_000)), "E0107", "4096 links");
}

#[test]
fn a_union_over_a_long_list_is_compiled() {
    let text = "union(for i in 0..10000: sphere(0.01).translate(x: i))";
    let compiled = Compiler::new().compile("long.sdf", text);
    let scene = compiled.unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(scene.diagnostics().to_string(), "");
    assert_eq!(scene.report().leaves, 10_000);
}

#[test]
fn infinite_recursion_is_refused() {
    for text in [
        "fn f(n: number) -> number = f(n + 1)\nsphere(f(0))",
        "fn f(n: number) -> number = f(n + 1) + f(n + 2)\nsphere(f(0))",
        "fn f(n: int) -> solid = sphere(n) | f(n + 1)\nf(1)",
    ] {
        stopped(text, "E0405", "64 levels");
    }
}

#[test]
fn exponential_work_is_refused() {
    let limit = "40000000 evaluation steps";
    let twice =
        "fn f(n: int) -> number = if n == 0 { 1 } else { f(n - 1) + f(n - 1) }\nsphere(f(60))";
    stopped(twice, "E0406", limit);
    let lambdas: String =
        (1..60).map(|i| format!("let f{i} = fn(x) = f{0}(f{0}(x))\n", i - 1)).collect();
    stopped(&format!("let f0 = fn(x) = x\n{lambdas}sphere(f59(1))"), "E0406", limit);
}

#[test]
fn exponentially_many_shapes_are_refused() {
    let shapes: String = (1u64..50)
        .map(|i| format!("let s{i} = s{0} | s{0}.translate(x: {1})\n", i - 1, 1u64 << i))
        .collect();
    stopped(&format!("let s0 = sphere(1)\n{shapes}s49"), "E0406", "4000000 nodes");
}

#[test]
fn shared_shapes_at_few_points_are_compiled() {
    let shapes: String =
        (1..=40).map(|i| format!("let s{i} = s{0} | s{0}.translate(x: {i})\n", i - 1)).collect();
    let compiled =
        Compiler::new().compile("shared.sdf", &format!("let s0 = sphere(1)\n{shapes}s40"));
    let scene = compiled.unwrap_or_else(|errors| panic!("{errors}"));
    // The copies stand at 0, 1, ..., 820, in far more ways than there are copies.
    let report = scene.report();
    assert_eq!((report.leaves, report.analytic.len() + report.marched.len()), (821, 821));
}

#[test]
fn long_sequences_are_refused() {
    stopped("let a = [for i in 0..1000000000: i]\nsphere(a[0])", "E0406", "the limit is 1000000");
    let cube = "union(for i in 0..1000: union(for j in 0..1000: union(for k in 0..1000: sphere(i + j + k))))";
    stopped(cube, "E0406", "1000000 graph nodes");
}

#[test]
fn loops_with_too_many_iterations_are_refused() {
    let big = "solid s() = iterate(1000000000, p.x, fn(s) = sin(s) + p.y)\ns()";
    stopped(big, "E0410", "4096");
    let within = "iterate(1000, q, fn(u) = sin(u) + p.y)";
    let nest = format!("solid s() = iterate(1000, p.x, fn(q) = {within})\ns()");
    stopped(&nest, "E0410", "65536");
}

#[test]
fn too_many_copies_are_refused() {
    stopped("sphere(1).translate(x: 5).polar_repeat(1000000000)", "E0309", "1..1000");
}

#[test]
fn numbers_that_are_too_large_are_refused() {
    stopped("sphere(1e400)", "E0105", "too large");
    stopped(&format!("sphere({})", "9".repeat(100_000)), "E0105", "too large");
}
