//! A slice of the campaign with a fixed seed, and a campaign that has something to find.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::time::Duration;

use sdfc_fuzz::campaign::{Limits, run};
use sdfc_fuzz::oracles::{Finding, ORACLES, Oracle, Outcome, Subject, Verdict};
use sdfc_fuzz::table::Table;
use sdfc_fuzz::texts;
use sdfc_fuzz::texts::oracles::{TEXT_ORACLES, TextOracle};
use sdfc_fuzz::workers::{self, Worker};

/// The time allows for all programs, also on a busy machine.
const LIMITS: Limits = Limits {
    time: Duration::from_secs(3600),
    programs: 1,
    seed: 1,
    stride: 1,
    patience: Duration::from_secs(1200),
};

#[test]
fn a_slice_of_the_campaign_finds_nothing() {
    let limits = Limits { programs: 6, seed: 2007, ..LIMITS };
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
    let limits = Limits { programs: 40, seed: 0, ..LIMITS };
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
    let limits = Limits { programs: 200, seed: 2007, ..LIMITS };
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
    let limits = Limits { programs: 40, seed: 0, ..LIMITS };
    let table = texts::run(limits, &[oracle], &mut |_| {}).unwrap();
    let texts: BTreeSet<_> = table.found.iter().map(|found| found.text.as_str()).collect();
    assert_eq!(texts, BTreeSet::from(["box(", "sphere("]));
}

/// Two processes judge the seeds of one, and one that is ended is replaced.
#[test]
fn workers_judge_each_seed_once() {
    let folder = std::env::temp_dir().join(format!("sdfc-fuzz-{}", std::process::id()));
    let worker = Worker {
        program: env!("CARGO_BIN_EXE_sdfc-fuzz").into(),
        arguments: ["--oracle", "format"].map(str::to_owned).to_vec(),
        folder: folder.clone(),
    };
    let limits = Limits { programs: 5, seed: 2007, ..LIMITS };
    let table = Table::new(std::iter::once(("format", "")));
    let mut seeds = BTreeSet::new();
    let table = workers::run(limits, 2, &worker, table, &mut |judged| {
        seeds.insert(judged.seed);
    });
    let table = table.unwrap();
    assert_eq!(seeds, (2007..2012).collect());
    assert_eq!((table.programs, table.rows[0].run), (5, 5));

    let ends = Worker { program: "false".into(), ..worker };
    let table = workers::run(limits, 2, &ends, Table::default(), &mut |_| {}).unwrap();
    assert!(table.found.iter().all(|found| found.finding.kind == "ended"));
    assert_eq!(table.found.len(), 5);
    std::fs::remove_dir_all(folder).unwrap();
}
