//! `docs/errors.md` holds every code's page, as the table of codes has it.
//!
//! After a change to the table, `ERRORS_UPDATE=1 cargo test -p sdfc-cli --test errors_page` writes it anew.

use std::fmt::Write;
use std::path::Path;

use sdfc_diagnostics::ALL_CODES;

const HEAD: &str = "\
# Errors and warnings

Every diagnostic has a code that never changes its meaning: `E` is an error, the scene does not compile; `W` is a
warning, it compiles and may not mean what was intended. `sdfc check` shows all of a scene's at once.

This page is written from the table in `crates/diagnostics/src/codes.rs`; change it there.
";

const GROUPS: [(&str, &str); 6] = [
    ("E01", "How a scene is written"),
    ("E02", "Names and calls"),
    ("E03", "Types and values"),
    ("E04", "What is known when, and limits"),
    ("E05", "Promises"),
    ("W06", "Warnings"),
];

fn page() -> String {
    let mut text = HEAD.to_owned();
    for (prefix, title) in GROUPS {
        let _ = write!(text, "\n## {title}\n");
        for row in ALL_CODES.iter().filter(|row| row.code.0.starts_with(prefix)) {
            let anchor = row.code.0.to_lowercase();
            let _ = write!(
                text,
                "\n<a id=\"{anchor}\"></a>\n### {}: {}\n\n{}\n",
                row.code, row.title, row.page
            );
        }
    }
    text
}

#[test]
fn the_page_of_codes_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/errors.md");
    let page = page();
    if std::env::var_os("ERRORS_UPDATE").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    assert!(
        found == page,
        "docs/errors.md is not what the table says; write it anew with ERRORS_UPDATE=1"
    );
}

#[test]
fn every_code_is_in_one_group() {
    for row in ALL_CODES {
        let groups = GROUPS.iter().filter(|(prefix, _)| row.code.0.starts_with(prefix)).count();
        assert_eq!(groups, 1, "{}", row.code);
    }
}
