//! `docs/errors.md` lists all codes, and `docs/errors/CODE.md` says of each what it means, shows a scene that has it, what
//! is said of that scene, and the scene mended.
//!
//! Meanings come from the table of codes, scenes from `examples/CODE.txt`: the wrong one, a line of dashes, the mended
//! one. After a change, `ERRORS_UPDATE=1 cargo test -p sdfc-tests --test errors_page` writes the pages anew.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod example;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

use example::Example;
use sdfc_diagnostics::ALL_CODES;
use sdfc_tests::repository;

const HEAD: &str = "\
# Errors and warnings

Every diagnostic has a code that never changes its meaning: `E` is an error, the scene does not compile; `W` is a
warning, it compiles and may not mean what was intended. `sdfc check` shows all of a scene's at once, `sdfc doc E0104` says in a
terminal what a code means, and the code's page here shows a scene that has it, what is said of it, and how it is mended.

These pages are written from the table in `crates/diagnostics/src/codes.rs` and the scenes in
`tests/errors_page/examples`; change those.
";

const GROUPS: [(&str, &str); 6] = [
    ("E01", "How a scene is written"),
    ("E02", "Names and calls"),
    ("E03", "Types and values"),
    ("E04", "What is known when, and limits"),
    ("E05", "Promises"),
    ("W06", "Warnings"),
];

fn docs() -> PathBuf {
    repository().join("docs")
}

/// The list of all codes.
fn index() -> String {
    let mut text = HEAD.to_owned();
    for (prefix, title) in GROUPS {
        let _ = write!(text, "\n## {title}\n\n| code | means |\n|---|---|\n");
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
    if let Some(key) = example.key() {
        let _ = write!(text, "{key}\n\n");
    }
    let _ = write!(text, "`sdfc check` says\n\n```text\n{}\n```\n", example.said);
    let _ = write!(text, "\n## Mended\n\n```sdf\n{}\n```\n", example.mended);
    text + "\n[All codes](../errors.md)\n"
}

/// All pages by their paths below `docs`.
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
            "docs/{path} is not what is said; write it anew with ERRORS_UPDATE=1"
        );
    }
    for entry in std::fs::read_dir(docs().join("errors")).unwrap() {
        let path = format!("errors/{}", entry.unwrap().file_name().to_str().unwrap());
        assert!(pages.contains_key(&path), "no code has the page docs/{path}");
    }
}

#[test]
fn every_code_is_shown_by_its_example_alone() {
    let others = example::all().iter().filter(|example| {
        let codes = &example.codes;
        codes.is_empty() || codes.iter().any(|code| *code != example.code.code.0)
    });
    let others: Vec<_> = others.map(|example| (example.code.code.0, &example.codes)).collect();
    assert!(others.is_empty(), "these scenes have other codes, or none: {others:?}");
}

#[test]
fn every_message_points_somewhere_and_says_how_to_mend_it() {
    let mut helpless = Vec::new();
    for example in example::all() {
        let (code, said) = (example.code.code, &example.said);
        assert!(said.contains("scene.sdf:") && said.contains('^'), "{code}: no place in\n{said}");
        if !said.contains("= help: ") {
            helpless.push(code.0);
        }
    }
    assert_eq!(helpless, [""; 0], "these do not say how to mend it");
}

#[test]
fn every_example_is_mended() {
    for example in example::all() {
        assert_eq!(example.said_of_mended, "", "{}", example.code.code);
    }
}

#[test]
fn every_code_is_in_one_group() {
    for row in ALL_CODES {
        let groups = GROUPS.iter().filter(|(prefix, _)| row.code.0.starts_with(prefix)).count();
        assert_eq!(groups, 1, "{}", row.code);
    }
}
