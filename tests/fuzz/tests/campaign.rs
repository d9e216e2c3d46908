//! A slice of the campaign with a fixed seed, and a campaign that has something to find.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::time::Duration;

use sdfc_fuzz::campaign::{Limits, run};
use sdfc_fuzz::oracles::{Finding, ORACLES, Oracle, Outcome, Subject, Verdict};
use sdfc_fuzz::texts;
use sdfc_fuzz::texts::oracles::{TEXT_ORACLES, TextOracle};

/// The time allows for all programs.
const TIME: Duration = Duration::from_secs(3600);

#[test]
fn a_slice_of_the_campaign_finds_nothing() {
    let limits = Limits { time: TIME, programs: 6, seed: 2007 };
    let table = run(limits, &ORACLES, &mut |_| {}).unwrap();
    assert!(table.found.is_empty(), "{:#?}", table.found);
    assert_eq!(table.valid, limits.programs);
    let answers = |row: usize| table.rows[row].run + table.rows[row].left_out;
    assert!((0..ORACLES.len()).all(|row| answers(row) == table.valid), "{table:?}");
}

/// Finds a fault in every program with a box, and panics if it has a ball too.
fn planted(subject: &Subject) -> Outcome {
    assert!(!(subject.text.contains("box(") && subject.text.contains("sphere(")), "both");
    if subject.text.contains("box(") {
        return Err(Finding { kind: "box".to_owned(), message: String::new() });
    }
    Ok(Verdict::Holds)
}

#[test]
fn a_campaign_finds_planted_faults_and_shrinks_their_programs() {
    let oracle = Oracle { name: "planted", summary: "there is no box", holds: planted };
    let limits = Limits { time: TIME, programs: 40, seed: 0 };
    let table = run(limits, &[oracle], &mut |_| {}).unwrap();
    let kinds = ["box", "panic"];
    for kind in kinds {
        let found = table.found.iter().find(|found| found.finding.kind == kind).unwrap();
        assert!(found.text.len() < 40, "{}", found.text);
    }
    assert!(table.found.iter().all(|found| kinds.contains(&found.finding.kind.as_str())));
    assert_eq!(table.rows[0].findings, table.found.len() as u64);
}

#[test]
fn a_slice_of_damaged_texts_finds_nothing() {
    let limits = Limits { time: TIME, programs: 200, seed: 2007 };
    let table = texts::run(limits, &TEXT_ORACLES, &mut |_| {}).unwrap();
    assert!(table.found.is_empty(), "{:#?}", table.found);
    assert_eq!(table.programs, limits.programs);
}

/// Finds a fault in every text with a sphere, and panics at a box.
fn planted_in_text(text: &str) -> Outcome {
    assert!(!text.contains("box("), "a box");
    if text.contains("sphere(") {
        return Err(Finding { kind: "sphere".to_owned(), message: String::new() });
    }
    Ok(Verdict::Holds)
}

#[test]
fn planted_faults_of_texts_are_found_and_shrunk() {
    let holds = planted_in_text;
    let oracle = TextOracle { name: "planted", summary: "there is no sphere", holds };
    let limits = Limits { time: TIME, programs: 40, seed: 0 };
    let table = texts::run(limits, &[oracle], &mut |_| {}).unwrap();
    let texts: BTreeSet<_> = table.found.iter().map(|found| found.text.as_str()).collect();
    assert_eq!(texts, BTreeSet::from(["box(", "sphere("]));
}
