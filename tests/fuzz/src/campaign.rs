//! Runs programs through oracles for some time.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use sdfc::Compiler;

use crate::catalogue::Catalogue;
use crate::oracles::{Finding, Oracle, Outcome, Subject, Verdict};
use crate::repair::NAME;
use crate::tree::Program;
use crate::{generate, repair, shrink};

/// An oracle that takes longer has found a fault.
const LIMIT: Duration = Duration::from_secs(60);
/// The time for shrinking a finding, and one that looks like many before.
const SHRINKING: [Duration; 2] = [Duration::from_secs(60), Duration::from_secs(5)];
/// So many findings of one kind get the longer time.
const WORTH_SHRINKING: usize = 3;
/// The most programs that are tried while one is shrunk.
const TRIES: usize = 2000;

/// The limits of a campaign.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// The campaign ends after this time, or after the finding that it is shrinking then.
    pub time: Duration,
    /// The number of programs, if the time allows for them.
    pub programs: u64,
    /// The seed of the first program. The next programs have the next seeds.
    pub seed: u64,
}

/// The counts of a campaign.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// The programs that were generated.
    pub programs: u64,
    /// Those that the checker accepts.
    pub valid: u64,
    /// The parts of accepted programs.
    pub parts: usize,
    /// The bytes of all programs.
    pub bytes: usize,
    /// One row for each oracle.
    pub rows: Vec<Row>,
    /// The faults, in the order in which they were found.
    pub found: Vec<Found>,
    /// The time it took.
    pub time: Duration,
}

/// The counts of one oracle.
#[derive(Clone, Debug)]
pub struct Row {
    /// The oracle's name.
    pub oracle: &'static str,
    /// The programs of which the statement holds, or does not.
    pub run: u64,
    /// The programs that the statement is not about.
    pub left_out: u64,
    /// The programs of which it does not hold.
    pub findings: u64,
}

/// A fault, with a program as small as could be.
#[derive(Clone, Debug)]
pub struct Found {
    /// The oracle's name, or `checker` for a program that is not accepted.
    pub oracle: &'static str,
    /// The seed of the program.
    pub seed: u64,
    /// The fault of the small program.
    pub finding: Finding,
    /// The small program.
    pub text: String,
}

/// An event of a campaign.
#[derive(Debug)]
pub enum Event<'e> {
    /// A program with this seed and text is about to be judged.
    Program(u64, &'e str),
    /// A fault was found.
    Found(&'e Found),
}

impl Table {
    /// A table without counts, with a row for each oracle.
    pub(crate) fn new(oracles: impl Iterator<Item = &'static str>) -> Self {
        let rows = oracles.map(|oracle| Row { oracle, run: 0, left_out: 0, findings: 0 });
        Self { rows: rows.collect(), ..Self::default() }
    }
}

/// Runs a campaign over generated programs. The oracles judge each.
///
/// # Errors
///
/// The reference has an entry that the generator does not understand.
pub fn run(
    limits: Limits,
    oracles: &[Oracle],
    on: &mut dyn FnMut(&Event<'_>),
) -> Result<Table, String> {
    let catalogue = Arc::new(Catalogue::read()?);
    let start = Instant::now();
    let mut table = Table::new(oracles.iter().map(|oracle| oracle.name));
    for seed in (limits.seed..).take(limits.programs as usize) {
        if start.elapsed() >= limits.time {
            break;
        }
        table.programs += 1;
        let catalogue = Arc::clone(&catalogue);
        let made = within_limit(move || repair(generate(&catalogue, seed)));
        let program = match made {
            Ok(Ok(accepted)) => accepted.program,
            Ok(Err((program, errors))) => {
                let finding = Finding { kind: "not accepted".to_owned(), message: errors };
                note(&mut table, "checker", seed, finding, program.text(), on);
                continue;
            }
            Err(finding) => {
                note(&mut table, "checker", seed, finding, String::new(), on);
                continue;
            }
        };
        table.valid += 1;
        table.parts += program.size();
        table.bytes += program.text().len();
        on(&Event::Program(seed, &program.text()));
        judge(&mut table, oracles, seed, &program, on);
    }
    table.time = start.elapsed();
    Ok(table)
}

/// Asks all oracles about one program, and shrinks it for each that finds a fault.
fn judge(
    table: &mut Table,
    oracles: &[Oracle],
    seed: u64,
    program: &Program,
    on: &mut dyn FnMut(&Event<'_>),
) {
    let answers = asked(program.text(), oracles.to_vec());
    for (row, oracle) in oracles.iter().enumerate() {
        let outcome = next(&answers);
        let Some(outcome) = outcome else { return };
        let counts = &mut table.rows[row];
        match outcome {
            Ok(Verdict::LeftOut) => counts.left_out += 1,
            Ok(Verdict::Holds) => counts.run += 1,
            Err(finding) => {
                counts.run += 1;
                counts.findings += 1;
                let is_slow = finding.kind == SLOW;
                let (program, finding) = smallest(table, oracle, program, finding);
                note(table, oracle.name, seed, finding, program.text(), on);
                if is_slow {
                    return;
                }
            }
        }
    }
}

pub(crate) fn note(
    table: &mut Table,
    oracle: &'static str,
    seed: u64,
    finding: Finding,
    text: String,
    on: &mut dyn FnMut(&Event<'_>),
) {
    let found = Found { oracle, seed, finding, text };
    on(&Event::Found(&found));
    table.found.push(found);
}

/// Shrinks a program that has a fault, for a limited time.
fn smallest(
    table: &Table,
    oracle: &Oracle,
    program: &Program,
    finding: Finding,
) -> (Program, Finding) {
    if finding.kind == SLOW {
        return (program.clone(), finding);
    }
    let alike = |found: &&Found| found.oracle == oracle.name && found.finding.kind == finding.kind;
    let many = table.found.iter().filter(alike).count() >= WORTH_SHRINKING;
    let end = Instant::now() + SHRINKING[usize::from(many)];
    let mut smallest = finding.clone();
    let program = shrink(program, TRIES, &mut |program| {
        if Instant::now() >= end {
            return false;
        }
        let answers = asked(program.text(), vec![*oracle]);
        match next(&answers) {
            Some(Err(found)) if found.kind == finding.kind => {
                smallest = found;
                true
            }
            Some(_) | None => false,
        }
    });
    (program, smallest)
}

/// The kind of the finding that an oracle does not end in time.
pub(crate) const SLOW: &str = "slow";
/// The kind of the finding that an oracle panics.
const PANIC: &str = "panic";

/// Asks oracles about a program on a thread of its own. The answers come in the order of the
/// oracles; there are none if the program has errors or draws nothing.
fn asked(text: String, oracles: Vec<Oracle>) -> Receiver<Outcome> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || answer(text, &oracles, &sender));
    receiver
}

fn answer(text: String, oracles: &[Oracle], sender: &Sender<Outcome>) {
    let Ok(scene) = Compiler::new().compile(NAME, &text) else { return };
    if !scene.draws() {
        return;
    }
    let subject = Subject { text, scene };
    for oracle in oracles {
        let outcome = catch_unwind(AssertUnwindSafe(|| (oracle.holds)(&subject)));
        let outcome = outcome.unwrap_or_else(|panic| Err(panicked(panic.as_ref())));
        if sender.send(outcome).is_err() {
            return;
        }
    }
}

/// Waits for the next answer. `None` if there are no more.
fn next(answers: &Receiver<Outcome>) -> Option<Outcome> {
    match answers.recv_timeout(LIMIT) {
        Ok(outcome) => Some(outcome),
        Err(RecvTimeoutError::Disconnected) => None,
        Err(RecvTimeoutError::Timeout) => Some(Err(slow())),
    }
}

/// Calls a function on a thread of its own, with a limited time.
pub(crate) fn within_limit<T: Send + 'static>(
    make: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Finding> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        let made = catch_unwind(AssertUnwindSafe(make));
        // Nobody waits for the result after the limit.
        let _ = sender.send(made.map_err(|panic| panicked(panic.as_ref())));
    });
    receiver.recv_timeout(LIMIT).unwrap_or_else(|_| Err(slow()))
}

fn slow() -> Finding {
    let message = format!("not done after {} s", LIMIT.as_secs());
    Finding { kind: SLOW.to_owned(), message }
}

fn panicked(panic: &(dyn std::any::Any + Send)) -> Finding {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    Finding { kind: PANIC.to_owned(), message: text.unwrap_or("no message").to_owned() }
}
