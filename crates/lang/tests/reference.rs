//! The reference is complete, and its examples compile.

#![allow(clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod support;

use sdfc_lang::{library, reference, settings};
use support::front;

/// A shape that the entry is about: a region for a setting that only regions have.
fn drawn(entry: &library::Entry) -> &'static str {
    let rows = settings::table();
    let row = rows.iter().find(|row| entry.kind == "setting" && row.name == entry.name);
    if row.is_some_and(|row| !row.kind.is_for_solids()) { "circle(1)" } else { "sphere(1)" }
}

/// A scene with an entry's example.
fn scene(entry: &library::Entry) -> String {
    match entry.kind {
        "kernel" => format!("let it = {}\nsphere(1)", entry.example),
        "setting" | "type" => format!("{}\n{}", drawn(entry), entry.example),
        _ => entry.example.clone(),
    }
}

#[test]
fn every_example_compiles() {
    for entry in reference::entries() {
        let text = scene(&entry);
        let (sources, _, found) = front(&text);
        let shown = sdfc_diagnostics::render(&sources, &found, false);
        assert!(found.is_empty(), "{}: {text}\n{shown}", entry.name);
    }
}

#[test]
fn every_example_uses_its_entry() {
    for entry in reference::entries() {
        let (name, example) = (&entry.name, &entry.example);
        assert!(example.contains(name), "the example of `{name}` does not use it: {example:?}");
    }
}

#[test]
fn every_summary_is_a_sentence() {
    for entry in reference::entries() {
        let (name, summary) = (&entry.name, &entry.summary);
        assert!(summary.ends_with('.'), "the first line on `{name}` has no full stop: {summary:?}");
        assert!(!entry.signature.is_empty() && !entry.topic.is_empty(), "{}", entry.name);
    }
}

#[test]
fn every_library_entry_names_its_source() {
    for entry in library::entries() {
        assert!(!entry.source.is_empty(), "`{}` needs a line `source: ...`", entry.name);
    }
}

#[test]
fn every_setting_has_an_entry_with_its_parameters() {
    let entries = reference::entries();
    for row in settings::table() {
        let entry = entries.iter().find(|it| it.kind == "setting" && it.name == row.name);
        let entry = entry.expect("every row has an entry");
        assert_eq!(entry.parameters.len(), row.parameters.len(), "{}", row.name);
    }
}

#[test]
fn a_misspelt_name_gets_a_suggestion() {
    let entries = reference::entries();
    assert_eq!(reference::meant(&entries, "spere").as_deref(), Some("did you mean `sphere`?"));
    assert_eq!(reference::meant(&entries, "cube").as_deref(), Some("that is `box` here"));
    assert_eq!(reference::meant(&entries, "Camera").as_deref(), Some("did you mean `camera`?"));
    assert_eq!(reference::meant(&entries, "teapot"), None);
}
