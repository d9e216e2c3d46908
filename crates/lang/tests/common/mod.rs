//! Shared code of the checker's tests.
#![allow(
    dead_code,
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    clippy::wildcard_enum_match_arm,
    reason = "helpers of tests: each test uses some, and a panic is how a test fails"
)]

pub mod print;
pub mod verify;

use sdfc_diagnostics::{Diagnostic, FileId, Sources, render};
use sdfc_lang::hir::Program;
use sdfc_lang::{check, check_library, library};
use sdfc_syntax::{ast, parse};

/// The library, parsed.
pub struct Library {
    pub sources: Sources,
    pub files: Vec<(FileId, ast::File)>,
}

impl Library {
    pub fn new() -> Self {
        Self::of(library::FILES)
    }

    pub fn of(texts: &[(&str, &str)]) -> Self {
        let mut sources = Sources::new();
        let mut files = Vec::new();
        for (name, text) in texts {
            let file = sources.add(*name, *text);
            let (tree, found) = parse(&sources, file);
            assert!(found.is_empty(), "{}", render(&sources, &found, false));
            files.push((file, tree));
        }
        Self { sources, files }
    }

    /// Checks the whole library.
    pub fn check_all(&self) -> (Program, Vec<Diagnostic>) {
        check_library(&self.files)
    }

    /// Checks a scene. Also returns the rendered diagnostics, those of the parser first.
    pub fn check(&self, text: &str) -> (Program, Vec<Diagnostic>, String) {
        let mut sources = self.sources.clone();
        let file = sources.add("scene.sdf", text);
        let (tree, mut found) = parse(&sources, file);
        let (program, more) = check(&self.files, (file, &tree));
        found.extend(more);
        let rendered = render(&sources, &found, false);
        (program, found, rendered)
    }
}

/// A scene with its rendered diagnostics below it.
pub fn findings(text: &str) -> String {
    let (_, _, rendered) = Library::new().check(text);
    format!("{}\n----\n{}", text.trim_end(), rendered.trim_end())
}

/// The typed program of a scene as short text.
pub fn printed(text: &str) -> String {
    let (program, _, rendered) = Library::new().check(text);
    assert_eq!(rendered, "");
    verify::verify(&program);
    print::print(&program)
}
