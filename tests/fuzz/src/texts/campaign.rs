//! Runs texts through oracles for some time.

use std::sync::Arc;
use std::time::{Duration, Instant};

use fastrand::Rng;

use super::oracles::TextOracle;
use super::{damaged, files, shrink};
use crate::campaign::{Event, Limits, SLOW, Table, note, within_limit};
use crate::oracles::{Finding, Verdict};

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
    let start = Instant::now();
    let mut table = Table::new(oracles.iter().map(|oracle| oracle.name));
    for seed in (limits.seed..).take(limits.programs as usize) {
        if start.elapsed() >= limits.time {
            break;
        }
        let text = damaged(&files, &mut Rng::with_seed(seed));
        table.programs += 1;
        table.bytes += text.len();
        on(&Event::Program(seed, &text));
        for (row, oracle) in oracles.iter().enumerate() {
            let outcome = judged(&text, *oracle);
            let counts = &mut table.rows[row];
            match outcome {
                Ok(Verdict::LeftOut) => counts.left_out += 1,
                Ok(Verdict::Holds) => counts.run += 1,
                Err(found) => {
                    counts.run += 1;
                    counts.findings += 1;
                    let (text, found) = shortest(&text, *oracle, found);
                    note(&mut table, oracle.name, seed, found, text, on);
                }
            }
        }
    }
    table.time = start.elapsed();
    Ok(table)
}

/// Asks an oracle on a thread of its own: a panic and a long wait are findings.
fn judged(text: &str, oracle: TextOracle) -> Result<Verdict, Finding> {
    let text = Arc::<str>::from(text);
    within_limit(move || (oracle.holds)(&text)).and_then(|outcome| outcome)
}

/// Shrinks a text that has a fault, for a limited time.
fn shortest(text: &str, oracle: TextOracle, found: Finding) -> (String, Finding) {
    if found.kind == SLOW {
        return (text.to_owned(), found);
    }
    let end = Instant::now() + SHRINKING;
    let mut last = found.clone();
    let text = shrink(text, TRIES, &mut |text| {
        let again = if Instant::now() < end { judged(text, oracle).err() } else { None };
        let again = again.filter(|again| again.kind == found.kind);
        again.map(|again| last = again).is_some()
    });
    (text, last)
}
