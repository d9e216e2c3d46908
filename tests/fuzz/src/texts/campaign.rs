//! Judges one damaged text after the other.

use std::sync::Arc;
use std::time::{Duration, Instant};

use fastrand::Rng;

use super::oracles::TextOracle;
use super::{damaged, files, shrink};
use crate::campaign::{Event, Limits, SLOW, found, in_turn, within_limit};
use crate::oracles::{Finding, Verdict};
use crate::table::{Answer, Judged, Table};

/// The time for shrinking a finding.
const SHRINKING: Duration = Duration::from_secs(30);
/// The most texts that are tried while one is shrunk.
const TRIES: usize = 2000;

/// Runs a campaign over damaged texts. The oracles judge each.
///
/// # Errors
///
/// The scenes of the repository cannot be read.
pub fn run(
    limits: Limits,
    oracles: &[TextOracle],
    on: &mut dyn FnMut(&Event<'_>),
) -> Result<Table, String> {
    let files = files().map_err(|e| e.to_string())?;
    let table = Table::new(oracles.iter().map(|oracle| (oracle.name, oracle.summary)));
    Ok(in_turn(limits, table, on, &mut |seed, on| {
        let text = damaged(&files, &mut Rng::with_seed(seed));
        on(&Event::Program(seed, &text));
        judge(seed, &text, oracles, limits.patience)
    }))
}

fn judge(seed: u64, text: &str, oracles: &[TextOracle], patience: Duration) -> Judged {
    let mut result = Judged { seed, bytes: text.len(), ..Judged::default() };
    for oracle in oracles {
        let start = Instant::now();
        let outcome = judged(text, *oracle, patience);
        let milliseconds = start.elapsed().as_millis() as u64;
        let answer = match outcome {
            Ok(Verdict::LeftOut) => Answer::LeftOut,
            Ok(Verdict::Holds) => Answer::Holds,
            Err(finding) => {
                let (text, finding) = shortest(text, *oracle, finding, patience);
                result.found.push(found(oracle.name, seed, finding, text));
                Answer::Fails
            }
        };
        result.answers.push((answer, milliseconds));
    }
    result
}

/// Asks an oracle on a thread of its own: a panic and a long wait are findings.
fn judged(text: &str, oracle: TextOracle, patience: Duration) -> Result<Verdict, Finding> {
    let text = Arc::<str>::from(text);
    within_limit(patience, move || (oracle.holds)(&text)).and_then(|outcome| outcome)
}

/// Shrinks a text that has a fault, for a limited time.
fn shortest(
    text: &str,
    oracle: TextOracle,
    found: Finding,
    patience: Duration,
) -> (String, Finding) {
    if found.kind == SLOW {
        return (text.to_owned(), found);
    }
    let end = Instant::now() + SHRINKING;
    let mut last = found.clone();
    let text = shrink(text, TRIES, &mut |text| {
        let again = if Instant::now() < end { judged(text, oracle, patience).err() } else { None };
        let again = again.filter(|again| again.kind == found.kind);
        again.map(|again| last = again).is_some()
    });
    (text, last)
}
