//! Scenes that would take all memory or time: each is compiled whole or refused with a code and the limit's
//! number, and none ends the program.
#![allow(missing_docs, clippy::panic, reason = "a test fails by panicking")]

use sdfc::Compiler;

/// The codes of the errors, and all text that people see.
fn refused(text: &str) -> (Vec<String>, String) {
    let Err(errors) = Compiler::new().compile("bomb.sdf", text) else { panic!("it was compiled") };
    let codes = errors.located().iter().map(|found| found.code.to_owned()).collect();
    (codes, errors.render(false))
}

/// Refused with this error alone, which says what the limit is.
fn stopped(text: &str, code: &str, limit: &str) {
    let (codes, message) = refused(text);
    assert_eq!(codes, [code], "{message}");
    assert!(message.contains(limit), "no `{limit}` in {message}");
}

fn nested(open: &str, middle: &str, close: &str) -> String {
    format!("{}{middle}{}", open.repeat(10_000), close.repeat(10_000))
}

#[test]
fn nesting() {
    stopped(&format!("sphere({})", nested("(", "1", ")")), "E0107", "256 levels");
    stopped(&format!("let a = {}\nsphere(1)", nested("[", "1", "]")), "E0107", "256 levels");
    stopped(&nested("union(", "sphere(1)", ")"), "E0107", "256 levels");
}

#[test]
fn chains() {
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
fn recursion_without_an_end() {
    for text in [
        "fn f(n: number) -> number = f(n + 1)\nsphere(f(0))",
        "fn f(n: number) -> number = f(n + 1) + f(n + 2)\nsphere(f(0))",
        "fn f(n: int) -> solid = sphere(n) | f(n + 1)\nf(1)",
    ] {
        stopped(text, "E0405", "64 levels");
    }
}

#[test]
fn work_that_grows_exponentially() {
    let limit = "10000000 evaluation steps";
    let twice =
        "fn f(n: int) -> number = if n == 0 { 1 } else { f(n - 1) + f(n - 1) }\nsphere(f(60))";
    stopped(twice, "E0406", limit);
    let lambdas: String =
        (1..60).map(|i| format!("let f{i} = fn(x) = f{0}(f{0}(x))\n", i - 1)).collect();
    stopped(&format!("let f0 = fn(x) = x\n{lambdas}sphere(f59(1))"), "E0406", limit);
}

#[test]
fn shapes_that_grow_exponentially() {
    let shapes: String = (1u64..50)
        .map(|i| format!("let s{i} = s{0} | s{0}.translate(x: {1})\n", i - 1, 1u64 << i))
        .collect();
    stopped(&format!("let s0 = sphere(1)\n{shapes}s49"), "E0406", "1000000 nodes");
}

#[test]
fn sequences() {
    stopped("let a = [for i in 0..1000000000: i]\nsphere(a[0])", "E0406", "the limit is 1000000");
    let cube = "union(for i in 0..1000: union(for j in 0..1000: union(for k in 0..1000: sphere(i + j + k))))";
    stopped(cube, "E0406", "10000000 evaluation steps");
}

#[test]
fn loops() {
    let big = "solid s() = iterate(1000000000, p.x, fn(s) = sin(s) + p.y)\ns()";
    stopped(big, "E0410", "4096");
    let within = "iterate(1000, q, fn(u) = sin(u) + p.y)";
    let nest = format!("solid s() = iterate(1000, p.x, fn(q) = {within})\ns()");
    stopped(&nest, "E0410", "65536");
}

#[test]
fn copies() {
    stopped("sphere(1).translate(x: 5).polar_repeat(1000000000)", "E0309", "1..1000");
}

#[test]
fn numbers() {
    stopped("sphere(1e400)", "E0105", "too large");
    stopped(&format!("sphere({})", "9".repeat(100_000)), "E0105", "too large");
}
