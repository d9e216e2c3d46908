//! `docs/reference` shows the doc comments of the library, the kernel, the settings and the types,
//! with a picture of every shape of the library.
//!
//! After a change, `REFERENCE_UPDATE=1 cargo test -p sdfc-tests --test reference` rewrites it. Text
//! must be the same to the letter, pictures as `is_same_picture` defines it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

mod pages;
mod pictures;

use std::collections::BTreeSet;
use std::path::PathBuf;

use sdfc_lang::reference;
use sdfc_tests::{is_same_picture, repository};

/// The files of the folder: path below it and content.
type Files = Vec<(String, Vec<u8>)>;

fn folder() -> PathBuf {
    repository().join("docs/reference")
}

/// Returns the files that the folder should have.
fn files() -> Files {
    let entries = reference::entries();
    let mut files = pages::files(&entries);
    files.extend(pictures::files(&entries));
    files
}

/// Returns the paths below the folder of the files that are there.
fn present() -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for below in ["", "pictures"] {
        for entry in std::fs::read_dir(folder().join(below)).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_file() {
                let path = path.strip_prefix(folder()).unwrap();
                found.insert(path.to_str().unwrap().replace('\\', "/"));
            }
        }
    }
    found
}

/// The playground's editor colours the words of the syntax and the names of types, and no others.
#[test]
fn the_playground_knows_the_words_of_the_language() {
    let source = std::fs::read_to_string(repository().join("playground/src/language.js")).unwrap();
    let list = |name: &str| -> BTreeSet<String> {
        let (_, behind) = source.split_once(&format!("const {name} = /^(?:")).unwrap();
        behind.split_once(')').unwrap().0.split('|').map(str::to_owned).collect()
    };
    let entries = reference::entries();
    let named = |kind: &str| -> BTreeSet<String> {
        entries.iter().filter(|it| it.kind == kind).map(|it| it.name.clone()).collect()
    };
    let (keywords, clauses) = (list("KEYWORDS"), list("CLAUSES"));
    let words: BTreeSet<String> = keywords.union(&clauses).cloned().collect();
    let parts = ["from", "as", "else", "in"].map(str::to_owned);
    // The page has a row for records, which are written without a word.
    let without_word = BTreeSet::from(["record".to_owned()]);
    assert_eq!(words, &(&named("syntax") - &without_word) | &BTreeSet::from(parts));
    assert_eq!(&list("TYPES") - &words, &named("type") - &words);
}

#[test]
fn the_reference_is_current() {
    let files = files();
    let wanted: BTreeSet<String> = files.iter().map(|(path, _)| path.clone()).collect();
    if std::env::var_os("REFERENCE_UPDATE").is_some() {
        std::fs::create_dir_all(folder().join("pictures")).unwrap();
        for stray in present().difference(&wanted) {
            std::fs::remove_file(folder().join(stray)).unwrap();
        }
        for (path, bytes) in &files {
            let file = folder().join(path);
            // A picture within the tolerance stays, so that another machine changes nothing.
            if !same(path, &std::fs::read(&file).unwrap_or_default(), bytes) {
                std::fs::write(file, bytes).unwrap();
            }
        }
    }
    let mut wrong: Vec<String> = present().symmetric_difference(&wanted).cloned().collect();
    let differs = |(path, bytes): &&(String, Vec<u8>)| {
        std::fs::read(folder().join(path)).is_ok_and(|found| !same(path, &found, bytes))
    };
    wrong.extend(files.iter().filter(differs).map(|(path, _)| path.clone()));
    assert!(
        wrong.is_empty(),
        "docs/reference is out of date; rewrite it with REFERENCE_UPDATE=1: {wrong:?}"
    );
}

fn same(path: &str, found: &[u8], wanted: &[u8]) -> bool {
    if path.ends_with(".png") {
        return is_same_picture(found, wanted);
    }
    String::from_utf8_lossy(found).replace("\r\n", "\n").as_bytes() == wanted
}
