//! Inputs that are deep, long or broken.
#![allow(missing_docs)]

mod common;

use common::Library;
use common::verify::verify;
use proptest::prelude::*;

fn codes(text: &str) -> Vec<&'static str> {
    let (program, found, _) = Library::new().check(text);
    if found.is_empty() {
        verify(&program);
    }
    found.iter().map(|found| found.code.0).collect()
}

fn repeat(open: &str, middle: &str, close: &str, times: usize) -> String {
    format!("{}{middle}{}", open.repeat(times), close.repeat(times))
}

#[test]
fn long_chains_do_not_overflow_the_stack() {
    let none: [&str; 0] = [];
    assert_eq!(codes(&format!("sphere({}1)", "1 + ".repeat(4000))), none);
    assert_eq!(codes(&format!("sphere(1){}", " | sphere(2)".repeat(4000))), none);
    assert_eq!(codes(&format!("sphere(1){}", " - sphere(2) & box(1)".repeat(2000))), none);
    assert_eq!(codes(&format!("sphere(1){}", ".round(0.1)".repeat(2000))), none);
    assert_eq!(codes(&format!("let v = [1, 2]\nsphere(v{}.x)", ".yx".repeat(4000))), none);
}

#[test]
fn one_operator_in_a_chain_makes_one_shape() {
    let (program, ..) = Library::new().check(&format!("sphere(1){}", " | sphere(2)".repeat(4000)));
    let text = format!("{:?}", program.drawn[0].kind);
    assert_eq!(text.matches("Build(").count(), 4002);
}

#[test]
fn deep_nesting_does_not_overflow_the_stack() {
    let none: [&str; 0] = [];
    assert_eq!(codes(&format!("sphere({})", repeat("(", "1", ")", 200))), none);
    assert_eq!(codes(&format!("sphere({})", repeat("{ let a = 1\n a + ", "1", "}", 200))), none);
    assert_eq!(codes(&format!("sphere({})", repeat("if true {", "1", "} else { 2 }", 200))), none);
    assert_eq!(codes(&repeat("union(", "sphere(1)", ")", 200)), none);
    assert_eq!(codes(&format!("let a = {}\nsphere(1)", repeat("[", "1", "]", 200))), none);
    assert_eq!(codes(&format!("let f = {}1\nsphere(1)", "fn(a) = ".repeat(200))), none);
}

#[test]
fn the_depth_of_inferred_types_is_limited() {
    let lets: Vec<String> =
        (1..2000).map(|at| format!("let f{at} = fn(x) = f{}", at - 1)).collect();
    assert_eq!(codes(&format!("let f0 = 1\n{}\nsphere(1)", lets.join("\n"))), ["E0107"]);
    let fns: Vec<String> = (1..2000).map(|at| format!("fn f{at}() = f{}", at - 1)).collect();
    assert_eq!(codes(&format!("fn f0() = 1\n{}\nsphere(1)", fns.join("\n"))), ["E0107"]);
    let lists: Vec<String> = (1..2000).map(|at| format!("let l{at} = [l{}]", at - 1)).collect();
    assert_eq!(codes(&format!("let l0 = 1\n{}\nsphere(1)", lists.join("\n"))), ["E0107"]);
}

#[test]
fn a_long_row_of_calls_does_not_overflow_the_stack() {
    let fns: Vec<String> = (1..5000).map(|at| format!("fn f{at}() = f{}() + 1", at - 1)).collect();
    let none: [&str; 0] = [];
    assert_eq!(codes(&format!("sphere(f4999())\nfn f0() = 1\n{}", fns.join("\n"))), none);
}

#[test]
fn nested_lambdas_are_not_checked_exponentially_often() {
    // `pick` takes a lambda for either dimension, and each body has an error in both.
    let pick = "solid pick(a: fn(vec3) -> solid) = 1\nregion pick(a: fn(vec2) -> region) = 1\n";
    let scene = format!("{pick}{}", repeat("pick(fn(c) = ", "1", ")", 100));
    assert_eq!(codes(&scene), ["E0303"]);
}

const SCENE: &str = include_str!("scenes/everything.sdf");

#[test]
fn the_scene_that_is_mutated_below_has_no_errors() {
    let (program, _, rendered) = Library::new().check(SCENE);
    assert_eq!(rendered, "");
    verify(&program);
}

/// Pieces that are inserted into a scene.
const PIECES: &[&str] = &[
    "sphere(1)",
    "circle(1)",
    "p",
    "q.x",
    "1",
    "0.5",
    "30deg",
    "true",
    "\"a\"",
    "#f00",
    "[1, 2]",
    "[1, 2, 3]",
    "[]",
    "fn(q) = q",
    "fn(a, b) = a",
    "min",
    "union",
    "smooth(0.1)",
    "for i in 0..3: i",
    "0..1",
    "|",
    "+",
    "*",
    "-",
    "(",
    ")",
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "=",
    ".x",
    ".translate(x: 1)",
    "if true { 1 } else { 2 }",
    "let a = 1\n",
    "solid",
    "shape",
    "fn",
    "int",
    "shape...",
    "->",
    "exact",
    "bounds",
    "material",
    "iterate(3, 0, fn(s) = s)",
    "a",
    "blend",
    "time",
    "camera",
];

/// The words of a scene and the characters between them.
fn pieces(text: &str) -> Vec<String> {
    let mut pieces = vec![String::new()];
    let mut word = false;
    for c in text.chars() {
        let is_word = c.is_alphanumeric() || c == '_';
        if !is_word || !word {
            pieces.push(String::new());
        }
        word = is_word;
        if let Some(last) = pieces.last_mut() {
            last.push(c);
        }
    }
    pieces
}

#[derive(Clone, Debug)]
enum Change {
    Drop(usize),
    Put(usize, usize),
    Copy(usize, usize),
}

fn change() -> impl Strategy<Value = Change> {
    let at = 0..10_000usize;
    prop_oneof![
        at.clone().prop_map(Change::Drop),
        (at.clone(), 0..PIECES.len()).prop_map(|(at, piece)| Change::Put(at, piece)),
        (at.clone(), at).prop_map(|(from, to)| Change::Copy(from, to)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// The checker handles every mutation of a scene. If it reports no error, the program keeps all
    /// guarantees.
    #[test]
    fn mangled_scenes_are_answered(changes in proptest::collection::vec(change(), 1..6)) {
        let mut text = pieces(SCENE);
        for change in changes {
            let count = text.len();
            match change {
                Change::Drop(at) => text[at % count].clear(),
                Change::Put(at, piece) => text[at % count] = format!(" {} ", PIECES[piece]),
                Change::Copy(from, to) => text[to % count] = text[from % count].clone(),
            }
        }
        let (program, found, _) = Library::new().check(&text.concat());
        if !sdfc_diagnostics::has_errors(&found) {
            verify(&program);
        }
    }
}
