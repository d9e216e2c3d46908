//! Judges one generated program after the other.

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use sdfc::Compiler;

use crate::catalogue::Catalogue;
use crate::oracles::{Finding, Oracle, Outcome, Subject, Verdict};
use crate::repair::NAME;
use crate::table::{Answer, Found, Judged, Table};
use crate::tree::Program;
use crate::{generate, repair, shrink};

/// The time for shrinking a finding, and one that looks like many before.
const SHRINKING: [Duration; 2] = [Duration::from_secs(60), Duration::from_secs(5)];
/// So many findings of one kind get the longer time.
const WORTH_SHRINKING: u32 = 3;
/// The most programs that are tried while one is shrunk.
const TRIES: usize = 2000;

/// The limits of a campaign.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// The campaign ends after this time, or after the finding that it is shrinking then.
    pub time: Duration,
    /// The number of programs, if the time allows for them.
    pub programs: u64,
    /// The seed of the first program.
    pub seed: u64,
    /// The difference between the seeds of two programs.
    pub stride: u64,
    /// An oracle that takes longer has found a fault.
    pub patience: Duration,
}

/// An event of a campaign.
#[derive(Debug)]
pub enum Event<'e> {
    /// A program with this seed and text is about to be judged.
    Program(u64, &'e str),
    /// It has been judged.
    Judged(&'e Judged),
}

/// A callback for events.
pub(crate) type OnEvent<'e> = dyn FnMut(&Event<'_>) + 'e;

/// Runs a campaign over generated programs. The oracles judge each.
///
/// It ends early after an oracle that did not end in time, because its thread goes on; a new
/// process can go on with the next seed.
///
/// # Errors
///
/// The reference has an entry that the generator does not understand.
pub fn run(limits: Limits, oracles: &[Oracle], on: &mut OnEvent<'_>) -> Result<Table, String> {
    let catalogue = Arc::new(Catalogue::read()?);
    let table = Table::new(oracles.iter().map(|oracle| (oracle.name, oracle.summary)));
    let mut judge = Judge {
        catalogue,
        oracles: oracles.to_vec(),
        patience: limits.patience,
        seen: HashMap::new(),
    };
    Ok(in_turn(limits, table, on, &mut |seed, on| judge.judged(seed, on)))
}

/// Judges seed after seed while the limits allow it, and adds up the results.
pub(crate) fn in_turn(
    limits: Limits,
    mut table: Table,
    on: &mut OnEvent<'_>,
    judge: &mut dyn FnMut(u64, &mut OnEvent<'_>) -> Judged,
) -> Table {
    let start = Instant::now();
    let mut seed = limits.seed;
    while table.programs < limits.programs && start.elapsed() < limits.time {
        let judged = judge(seed, on);
        on(&Event::Judged(&judged));
        let is_slow = judged.found.iter().any(|found| found.finding.kind == SLOW);
        table.add(judged);
        if is_slow {
            break;
        }
        seed = seed.saturating_add(limits.stride);
    }
    table.time = start.elapsed();
    table
}

/// Judges programs, and knows the kinds of findings so far.
struct Judge {
    catalogue: Arc<Catalogue>,
    oracles: Vec<Oracle>,
    patience: Duration,
    seen: HashMap<(&'static str, String), u32>,
}

impl Judge {
    fn judged(&mut self, seed: u64, on: &mut OnEvent<'_>) -> Judged {
        let catalogue = Arc::clone(&self.catalogue);
        let mut judged = Judged { seed, ..Judged::default() };
        let program = match within_limit(self.patience, move || repair(generate(&catalogue, seed)))
        {
            Ok(Ok(accepted)) => accepted.program,
            Ok(Err((program, errors))) => {
                let finding = Finding { kind: "not accepted".to_owned(), message: errors };
                judged.found.push(found("checker", seed, finding, program.text()));
                return judged;
            }
            Err(finding) => {
                judged.found.push(found("checker", seed, finding, String::new()));
                return judged;
            }
        };
        judged.valid = true;
        (judged.parts, judged.bytes) = (program.size(), program.text().len());
        on(&Event::Program(seed, &program.text()));
        self.ask(&program, &mut judged);
        judged
    }

    /// Asks all oracles about a program, and shrinks it for each that finds a fault.
    fn ask(&mut self, program: &Program, judged: &mut Judged) {
        let answers = asked(program.text(), self.oracles.clone());
        let mut start = Instant::now();
        for oracle in self.oracles.clone() {
            let Some(outcome) = next(&answers, self.patience) else { return };
            let milliseconds = start.elapsed().as_millis() as u64;
            let answer = match &outcome {
                Ok(Verdict::LeftOut) => Answer::LeftOut,
                Ok(Verdict::Holds) => Answer::Holds,
                Err(_) => Answer::Fails,
            };
            judged.answers.push((answer, milliseconds));
            if let Err(finding) = outcome {
                let is_slow = finding.kind == SLOW;
                let (program, finding) = self.smallest(&oracle, program, finding);
                judged.found.push(found(oracle.name, judged.seed, finding, program.text()));
                if is_slow {
                    return;
                }
            }
            start = Instant::now();
        }
    }

    /// Shrinks a program that has a fault, for a limited time.
    fn smallest(
        &mut self,
        oracle: &Oracle,
        program: &Program,
        finding: Finding,
    ) -> (Program, Finding) {
        if finding.kind == SLOW {
            return (program.clone(), finding);
        }
        let seen = self.seen.entry((oracle.name, finding.kind.clone())).or_default();
        *seen += 1;
        let end = Instant::now() + SHRINKING[usize::from(*seen > WORTH_SHRINKING)];
        let mut smallest = finding.clone();
        let patience = self.patience;
        let program = shrink(program, TRIES, &mut |program| {
            if Instant::now() >= end {
                return false;
            }
            let answers = asked(program.text(), vec![*oracle]);
            match next(&answers, patience) {
                Some(Err(found)) if found.kind == finding.kind => {
                    smallest = found;
                    true
                }
                Some(_) | None => false,
            }
        });
        (program, smallest)
    }
}

pub(crate) fn found(oracle: &str, seed: u64, finding: Finding, text: String) -> Found {
    Found { oracle: oracle.to_owned(), seed, finding, text }
}

/// The kind of the finding that an oracle does not end in time.
pub const SLOW: &str = "slow";
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
fn next(answers: &Receiver<Outcome>, patience: Duration) -> Option<Outcome> {
    match answers.recv_timeout(patience) {
        Ok(outcome) => Some(outcome),
        Err(RecvTimeoutError::Disconnected) => None,
        Err(RecvTimeoutError::Timeout) => Some(Err(slow(patience))),
    }
}

/// Calls a function on a thread of its own, with a limited time.
pub(crate) fn within_limit<T: Send + 'static>(
    patience: Duration,
    make: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Finding> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        let made = catch_unwind(AssertUnwindSafe(make));
        // Nobody waits for the result after the limit.
        let _ = sender.send(made.map_err(|panic| panicked(panic.as_ref())));
    });
    receiver.recv_timeout(patience).unwrap_or_else(|_| Err(slow(patience)))
}

fn slow(patience: Duration) -> Finding {
    let message = format!("not done after {} s", patience.as_secs());
    Finding { kind: SLOW.to_owned(), message }
}

fn panicked(panic: &(dyn std::any::Any + Send)) -> Finding {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    Finding { kind: PANIC.to_owned(), message: text.unwrap_or("no message").to_owned() }
}
