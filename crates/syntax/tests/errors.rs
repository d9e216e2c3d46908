//! Snapshots of the rendered errors beside their sources, one file for each theme.
//!
//! The cases are in `tests/errors/THEME.txt`, separated by lines of four dashes.

#![allow(clippy::unwrap_used, reason = "these are tests")]

use std::fmt::Write;

use sdfc_diagnostics::{Sources, has_errors, render};
use sdfc_syntax::parse;

fn rendered(cases: &str) -> String {
    let mut out = String::new();
    for case in cases.split("----\n") {
        let mut sources = Sources::new();
        let file = sources.add("scene.sdf", case);
        let (_, found) = parse(&sources, file);
        assert!(has_errors(&found), "no error in:\n{case}");
        let places: Vec<u32> = found.iter().map(|found| found.span.start).collect();
        assert!(places.is_sorted_by(|a, b| a < b), "two errors at one place in:\n{case}");
        let rule = "=".repeat(80);
        let text = render(&sources, &found, false);
        write!(out, "{rule}\n{case}{}\n{text}", "-".repeat(80)).unwrap();
    }
    out
}

macro_rules! themes {
    ($($theme:ident)*) => {
        $(#[test]
        fn $theme() {
            let cases = include_str!(concat!("errors/", stringify!($theme), ".txt"));
            insta::assert_snapshot!(stringify!($theme), rendered(cases));
        })*
    };
}

themes! {
    blocks_and_conditions
    brackets
    characters
    colours_and_strings
    declarations
    lines
    lists_and_arguments
    names
    numbers
    operators
    several
}
