//! `docs/errors.md` lists all codes. `docs/errors/CODE.md` explains each code and shows a scene
//! that has it, the messages about that scene, and the scene fixed.
//!
//! Explanations come from the table of codes, scenes from `examples/CODE.txt`: the wrong scene, a
//! line of four dashes, the fixed scene. After a change,
//! `ERRORS_UPDATE=1 cargo test -p sdfc-tests --test errors_page` rewrites the pages.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod example;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

use example::Example;
use sdfc_diagnostics::ALL_CODES;
use sdfc_tests::{repository, wrapped};

const HEAD: &str = "\
# Errors and warnings

Every diagnostic has a code whose meaning never changes. `E` is an error: the scene does not
compile. `W` is a warning: the scene compiles, but may not mean what its author intended.

`sdfc check` shows all diagnostics of a scene at once. `sdfc doc E0104` explains a code in the
terminal. The page of a code here also shows a scene that has it, the message, and the scene fixed.

These pages are generated from the table in `crates/diagnostics/src/codes.rs` and the scenes in
`tests/errors_page/examples`. Edit those.
";

const GROUPS: [(&str, &str); 6] = [
    ("E01", "Syntax"),
    ("E02", "Names and calls"),
    ("E03", "Types and values"),
    ("E04", "Compile-time values and limits"),
    ("E05", "Violated clauses"),
    ("W06", "Warnings"),
];

fn docs() -> PathBuf {
    repository().join("docs")
}

/// Returns the list of all codes.
fn index() -> String {
    let mut text = HEAD.to_owned();
    for (prefix, title) in GROUPS {
        let _ = write!(text, "\n## {title}\n\n| code | meaning |\n|---|---|\n");
        for row in ALL_CODES.iter().filter(|row| row.code.0.starts_with(prefix)) {
            let code = row.code;
            let _ = writeln!(text, "| [{code}](errors/{code}.md) | {} |", row.title);
        }
    }
    text
}

fn page(example: &Example) -> String {
    let (code, title, meaning) = (example.code.code, example.code.title, example.code.page);
    let mut text = format!("# {code}: {title}\n\n{meaning}\n\n## Example\n\n");
    let _ = write!(text, "```sdf\n{}\n```\n\n", example.wrong);
    if let Some(placeholder) = example.placeholder() {
        let _ = write!(text, "{placeholder}\n\n");
    }
    let _ = write!(text, "`sdfc check` reports\n\n```text\n{}\n```\n", example.messages);
    let _ = write!(text, "\n## Fixed\n\n```sdf\n{}\n```\n", example.fixed);
    wrapped(&(text + "\n[All codes](../errors.md)\n"))
}

/// Returns all pages by their paths below `docs`.
fn pages() -> BTreeMap<String, String> {
    let of_codes = example::all().iter();
    let mut pages: BTreeMap<String, String> =
        of_codes.map(|it| (format!("errors/{}.md", it.code.code), page(it))).collect();
    pages.insert("errors.md".to_owned(), index());
    pages
}

#[test]
fn the_pages_of_codes_are_current() {
    let pages = pages();
    if std::env::var_os("ERRORS_UPDATE").is_some() {
        std::fs::create_dir_all(docs().join("errors")).unwrap();
        for (path, page) in &pages {
            std::fs::write(docs().join(path), page).unwrap();
        }
    }
    for (path, page) in &pages {
        let found = std::fs::read_to_string(docs().join(path)).unwrap_or_default();
        assert!(
            found.replace("\r\n", "\n") == *page,
            "docs/{path} is out of date; rewrite it with ERRORS_UPDATE=1"
        );
    }
    for entry in std::fs::read_dir(docs().join("errors")).unwrap() {
        let path = format!("errors/{}", entry.unwrap().file_name().to_str().unwrap());
        assert!(pages.contains_key(&path), "docs/{path} is the page of no code");
    }
}

#[test]
fn every_example_has_its_code_and_no_other() {
    let others = example::all().iter().filter(|example| {
        let codes = &example.codes;
        codes.is_empty() || codes.iter().any(|code| *code != example.code.code.0)
    });
    let others: Vec<_> = others.map(|example| (example.code.code.0, &example.codes)).collect();
    assert!(others.is_empty(), "these scenes have other codes, or none: {others:?}");
}

#[test]
fn every_message_has_a_position_and_a_suggestion() {
    let mut without_help = Vec::new();
    for example in example::all() {
        let (code, messages) = (example.code.code, &example.messages);
        let has_position = messages.contains("scene.sdf:") && messages.contains('^');
        assert!(has_position, "{code}: no position in\n{messages}");
        if !messages.contains("= help: ") {
            without_help.push(code.0);
        }
    }
    assert_eq!(without_help, [""; 0], "these have no suggestion");
}

#[test]
fn every_fixed_example_has_no_diagnostics() {
    for example in example::all() {
        assert_eq!(example.messages_of_fixed, "", "{}", example.code.code);
    }
}

#[test]
fn every_code_is_in_one_group() {
    for row in ALL_CODES {
        let groups = GROUPS.iter().filter(|(prefix, _)| row.code.0.starts_with(prefix)).count();
        assert_eq!(groups, 1, "{}", row.code);
    }
}
