//! A slice of the campaign with a fixed seed, and a campaign that has something to find.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::time::Duration;

use sdfc_fuzz::campaign::{Options, run};
use sdfc_fuzz::oracles::{Finding, ORACLES, Oracle, Outcome, Subject, Verdict};

/// The time allows for all programs.
const TIME: Duration = Duration::from_secs(3600);

#[test]
fn a_slice_of_the_campaign_finds_nothing() {
    let options = Options { time: TIME, programs: 6, seed: 2007, oracles: ORACLES.to_vec() };
    let table = run(&options, &mut |_| {}).unwrap();
    assert!(table.found.is_empty(), "{:#?}", table.found);
    assert_eq!(table.valid, options.programs);
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
    let options = Options { time: TIME, programs: 40, seed: 0, oracles: vec![oracle] };
    let table = run(&options, &mut |_| {}).unwrap();
    let kinds = ["box", "panic"];
    for kind in kinds {
        let found = table.found.iter().find(|found| found.finding.kind == kind).unwrap();
        assert!(found.text.len() < 40, "{}", found.text);
    }
    assert!(table.found.iter().all(|found| kinds.contains(&found.finding.kind.as_str())));
    assert_eq!(table.rows[0].findings, table.found.len() as u64);
}
