//! Every file under `tests/inputs` parses, also with other line ends, and truncating it never
//! panics.

#![allow(clippy::unwrap_used, reason = "these are tests")]

use std::fs;
use std::path::PathBuf;

use sdfc_diagnostics::{Sources, render};
use sdfc_syntax::ast::{ExprKind, Item};
use sdfc_syntax::parse;

fn inputs() -> Vec<(String, String)> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/inputs");
    let mut found = Vec::new();
    for folder in ["scenes", "std"] {
        for entry in fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            found.push((name, fs::read_to_string(path).unwrap()));
        }
    }
    found.sort();
    assert!(found.len() >= 22, "the inputs are missing");
    found
}

#[test]
fn every_input_parses() {
    for (name, text) in inputs() {
        let mut sources = Sources::new();
        let file = sources.add(&name, &text);
        let (tree, found) = parse(&sources, file);
        assert!(found.is_empty(), "{}", render(&sources, &found, false));
        assert!(!tree.items.is_empty(), "{name}");
    }
}

#[test]
fn line_ends_and_byte_order_marks_change_nothing() {
    for (name, text) in inputs() {
        let mut sources = Sources::new();
        let plain = sources.add(&name, &text);
        let windows = sources.add(&name, format!("\u{feff}{}", text.replace('\n', "\r\n")));
        let (plain, windows) = (parse(&sources, plain), parse(&sources, windows));
        assert_eq!(windows.1, [], "{name}");
        assert_eq!(plain.0.items.len(), windows.0.items.len(), "{name}");
    }
}

#[test]
fn a_truncated_file_parses_or_has_errors() {
    for (name, text) in inputs() {
        for (cut, _) in text.char_indices() {
            let mut sources = Sources::new();
            let file = sources.add(&name, &text[..cut]);
            let (tree, found) = parse(&sources, file);
            let broken = tree.items.iter().any(|item| match item {
                Item::Expr(expr) => expr.kind == ExprKind::Error,
                Item::Let(binding) => binding.value.kind == ExprKind::Error,
                Item::Param(param) => param.default.kind == ExprKind::Error,
                Item::Decl(decl) => decl.body.kind == ExprKind::Error,
                Item::Import(_) => false,
            });
            assert!(!broken || !found.is_empty(), "{name} cut at {cut} is silently broken");
        }
    }
}
