//! The counts of a campaign, and what one seed adds to them.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::oracles::Finding;

/// What an oracle says of one program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Answer {
    /// The statement is not about the program.
    LeftOut,
    /// The statement holds.
    Holds,
    /// It does not.
    Fails,
}

/// A fault, with a program as small as could be.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Found {
    /// The oracle's name, `checker` for a program that is not accepted, or `process` for one that
    /// ends the process.
    pub oracle: String,
    /// The seed of the program.
    pub seed: u64,
    /// The fault of the small program.
    pub finding: Finding,
    /// The small program.
    pub text: String,
}

/// The result of one seed.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Judged {
    /// The seed.
    pub seed: u64,
    /// True if the checker accepts the program.
    pub valid: bool,
    /// The parts of the program.
    pub parts: usize,
    /// The bytes of the program.
    pub bytes: usize,
    /// The answers of the oracles in their order, each with its time in milliseconds. There are
    /// fewer if one did not end.
    pub answers: Vec<(Answer, u64)>,
    /// The faults.
    pub found: Vec<Found>,
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
    /// Its statement.
    pub summary: &'static str,
    /// The programs of which the statement holds, or does not.
    pub run: u64,
    /// The programs that the statement is not about.
    pub left_out: u64,
    /// The programs of which it does not hold.
    pub findings: u64,
    /// The time of all its answers.
    pub time: Duration,
}

impl Table {
    /// A table without counts, with a row for each oracle: name and statement.
    pub fn new(oracles: impl Iterator<Item = (&'static str, &'static str)>) -> Self {
        let row = |(oracle, summary)| Row {
            oracle,
            summary,
            run: 0,
            left_out: 0,
            findings: 0,
            time: Duration::ZERO,
        };
        Self { rows: oracles.map(row).collect(), ..Self::default() }
    }

    /// Adds the result of a seed.
    pub fn add(&mut self, judged: Judged) {
        self.programs += 1;
        self.valid += u64::from(judged.valid);
        self.parts += judged.parts;
        self.bytes += judged.bytes;
        for (row, (answer, milliseconds)) in self.rows.iter_mut().zip(judged.answers) {
            row.time += Duration::from_millis(milliseconds);
            match answer {
                Answer::LeftOut => row.left_out += 1,
                Answer::Holds => row.run += 1,
                Answer::Fails => (row.run, row.findings) = (row.run + 1, row.findings + 1),
            }
        }
        self.found.extend(judged.found);
    }
}

impl std::fmt::Display for Table {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { programs, valid, parts, bytes, rows, found, time } = self;
        let (found, minutes) = (found.len(), time.as_secs_f64() / 60.0);
        writeln!(
            f,
            "{programs} programs of {bytes} bytes, {valid} valid with {parts} parts, {found} \
             findings, {minutes:.1} minutes\n"
        )?;
        writeln!(f, "| oracle | statement | run | left out | findings | seconds |")?;
        writeln!(f, "|---|---|---|---|---|---|")?;
        for Row { oracle, summary, run, left_out, findings, time } in rows {
            let seconds = time.as_secs_f64();
            writeln!(
                f,
                "| `{oracle}` | {summary} | {run} | {left_out} | {findings} | {seconds:.0} |"
            )?;
        }
        Ok(())
    }
}
