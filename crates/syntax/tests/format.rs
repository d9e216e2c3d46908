//! Snapshots of the formatter, and checks that it changes only the layout.

#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests")]

use std::fs;
use std::path::PathBuf;

use proptest::prelude::*;
use sdfc_diagnostics::{Sources, has_errors, render};
use sdfc_syntax::{format, parse};

fn formatted(text: &str) -> Option<String> {
    let mut sources = Sources::new();
    let file = sources.add("scene.sdf", text);
    format(&sources, file).ok()
}

/// Returns the printed tree without spans, or `None` if the text does not parse.
fn tree(text: &str) -> Option<String> {
    let mut sources = Sources::new();
    let file = sources.add("scene.sdf", text);
    let (tree, found) = parse(&sources, file);
    if has_errors(&found) {
        return None;
    }
    let printed = format!("{tree:?}");
    let mut parts = printed.split("Span {");
    let first = parts.next().unwrap_or_default().to_owned();
    Some(parts.fold(first, |all, part| all + part.split_once('}').map_or("", |(_, rest)| rest)))
}

/// Returns the comments in order.
fn comments(text: &str) -> Vec<String> {
    let of_line = |line: &str| line.split_once("//").map(|(_, rest)| rest.trim().to_owned());
    let one_by_one =
        |rest: String| rest.split("//").map(|c| c.trim().to_owned()).collect::<Vec<_>>();
    text.lines().filter_map(of_line).flat_map(one_by_one).collect()
}

/// Checks the properties that hold for every text that parses. Returns true if it parses.
fn check(text: &str) -> bool {
    let Some(before) = tree(text) else {
        assert_eq!(formatted(text), None);
        return false;
    };
    let once = formatted(text).unwrap();
    let after = tree(&once);
    assert_eq!(after.as_ref(), Some(&before), "meaning changed:\n{text}\n---\n{once}");
    let twice = formatted(&once).unwrap();
    assert_eq!(twice, once, "not settled:\n{text}");
    assert_eq!(comments(&once), comments(text), "comments changed:\n{text}\n---\n{once}");
    assert!(once.lines().all(|line| line.trim_end() == line), "white line ends in:\n{once}");
    assert!(!once.contains("\n\n\n") && !once.starts_with('\n'), "blank lines in:\n{once}");
    true
}

fn inputs() -> Vec<(String, String)> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/inputs");
    let mut found = Vec::new();
    for folder in ["scenes", "std"] {
        for entry in fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            found.push((name, fs::read_to_string(path).unwrap()));
        }
    }
    found.sort();
    found
}

#[test]
fn formatting_keeps_the_tree_and_is_idempotent() {
    for (name, text) in inputs() {
        assert!(check(&text), "{name}");
        let long = |text: &str| text.lines().any(|line| line.chars().count() > 100);
        assert!(!long(&formatted(&text).unwrap()) || long(&text), "{name} has long lines");
    }
}

#[test]
fn inputs_in_the_one_layout() {
    for (name, text) in inputs() {
        insta::assert_snapshot!(format!("input_{name}"), formatted(&text).unwrap());
    }
}

#[test]
fn rules() {
    let cases = include_str!("format/rules.txt");
    let mut out = String::new();
    for case in cases.split("----\n") {
        assert!(check(case), "{case}");
        out += &format!(
            "{}\n{case}{}\n{}",
            "=".repeat(100),
            "-".repeat(100),
            formatted(case).unwrap()
        );
    }
    insta::assert_snapshot!(out);
}

#[test]
fn a_file_with_errors_is_not_formatted() {
    let mut sources = Sources::new();
    let file = sources.add("scene.sdf", "let a = 1\nlet b =\n");
    let found = format(&sources, file).unwrap_err();
    assert!(render(&sources, &found, false).contains("E0104"));
}

#[test]
fn a_comment_anywhere_is_kept() {
    let mut kept = 0;
    for (_, text) in inputs() {
        let behind = text.char_indices().filter(|(_, c)| " (,.".contains(*c));
        let places: Vec<usize> = behind.map(|(at, _)| at + 1).collect();
        for (place, comment) in places.iter().step_by(7).zip(COMMENTS.iter().cycle()) {
            let (before, after) = text.split_at(*place);
            kept += usize::from(check(&[before, comment, after].concat()));
        }
    }
    assert!(kept > 100, "only {kept} places for a comment");
}

const COMMENTS: &[&str] = &["// here\n", "\n// here\n", "\n\n  // here\n\n", "// a\n  // b\n"];

#[test]
fn an_input_cut_at_any_line_keeps_its_meaning() {
    for (name, text) in inputs() {
        let ends = text.match_indices('\n').map(|(at, _)| at + 1);
        let checked = ends.filter(|&end| check(&text[..end])).count();
        assert!(checked > 0, "{name}");
    }
}

/// Random combinations of lines of the inputs.
fn recombined() -> impl Strategy<Value = String> {
    let inputs: Vec<String> = inputs().into_iter().map(|(_, text)| text).collect();
    let lines: Vec<String> =
        inputs.iter().flat_map(|text| text.split_inclusive('\n')).map(str::to_owned).collect();
    let paragraphs: Vec<String> = inputs
        .iter()
        .flat_map(|text| text.split("\n\n"))
        .map(|part| part.to_owned() + "\n")
        .collect();
    let part = prop_oneof![prop::sample::select(lines), prop::sample::select(paragraphs)];
    prop::collection::vec(part, 1..6).prop_map(|parts| parts.concat())
}

/// A random expression with irregular layout.
fn expression() -> impl Strategy<Value = String> {
    let leaf = prop::sample::select(
        [
            "a",
            "sphere(1)",
            "0.5",
            "#FFF",
            "90deg",
            "p.xyz",
            "a_rather_long_name_for_a_value",
            "1",
            "f()",
            "true",
        ]
        .to_vec(),
    );
    leaf.prop_map(str::to_owned).prop_recursive(5, 60, 4, |inner| {
        let several = prop::collection::vec(inner.clone(), 0..5);
        let op = prop::sample::select(
            ["+", "-", "*", "/", "|", "&", "&&", "||", "%", "\n| ", " // c\n - "].to_vec(),
        );
        prop_oneof![
            (inner.clone(), op, inner.clone()).prop_map(|(a, op, b)| format!("{a}{op}{b}")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a}) .. ({b})")),
            several.clone().prop_map(|all| format!("union( {} )", all.join(" ,\n"))),
            several.clone().prop_map(|all| format!("[{}]", all.join(","))),
            (inner.clone(), several.clone())
                .prop_map(|(a, all)| format!("({a}).g({})", all.join(", "))),
            inner.clone().prop_map(|a| format!("-{a}")),
            inner.clone().prop_map(|a| format!("h(fn(q)= {a}, x: {a})")),
            (inner.clone(), several, inner.clone()).prop_map(|(a, all, b)| {
                format!("{a}.k({}, size: {{ let t = {b}; {b} }})", all.join(", "))
            }),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("{{ let v = {a}\n\n{b} }}")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("{{let v={a};-{b}}}")),
            (inner.clone(), inner.clone())
                .prop_map(|(a, b)| format!("if {a} {{ {b} }} else {{{a}}}")),
            inner.clone().prop_map(|a| format!("f(for i in 0..3 if i>1: {a}, // c\n2,)")),
            (inner.clone(), inner)
                .prop_map(|(a, b)| format!("fn(u, v: vec3=1) lipschitz {a} = {b}")),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn recombined_inputs(text in recombined()) {
        check(&text);
    }

    #[test]
    fn careless_expressions(a in expression(), b in expression()) {
        check(&format!("let x = {a}; {b}\nfn f(r) = {a}\nsolid s(r: length = 1) exact if {a} = {b}"));
    }
}
