//! The tables in `docs/gpu.md`.

use std::fmt::Write;

use crate::radv::{Chip, Statistics};

const END: &str = "<!-- End of the table. -->\n";

/// By how much the estimated cost may grow unnoticed, in percent.
const MOST_COST: u64 = 3;

/// A part of the shader of an example, which has a table of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The complete picture.
    Render,
    /// The functions for distance and gradient.
    Field,
}

impl Part {
    /// All parts.
    pub const ALL: [Self; 2] = [Self::Render, Self::Field];

    /// The name, as in `--emit`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Render => "render",
            Self::Field => "field",
        }
    }

    /// The line before the table.
    fn begin(self) -> String {
        format!("<!-- The table of {} is written by tests/occupancy. -->\n", self.name())
    }
}

/// What the compilers of all chips made of the examples.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Name and version of the driver.
    pub driver: String,
    /// The examples, sorted by name.
    pub rows: Vec<Row>,
}

/// One example.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Row {
    /// Its path below `examples`.
    pub name: String,
    /// What was made of it, in the order of [`Chip::ALL`].
    pub chips: [Statistics; 3],
}

impl Table {
    /// Reads the table of the page.
    ///
    /// # Errors
    ///
    /// The page has no table, or one of another form.
    pub fn read(page: &str, part: Part) -> Result<Self, String> {
        let [_, table, _] = split(page, part)?;
        let mut table_rows = Vec::new();
        let mut driver = String::new();
        for line in table.lines() {
            if let Some(name) = line.strip_prefix("Driver: ") {
                driver = name.trim_end_matches('.').to_owned();
            }
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            let is_row = cells.first().is_some_and(|name| name.ends_with(".sdf"));
            if is_row {
                table_rows.push(row(&cells).ok_or_else(|| format!("not understood: {line}"))?);
            }
        }
        Ok(Self { driver, rows: table_rows })
    }

    /// The page with this table.
    ///
    /// # Errors
    ///
    /// The page has no table.
    pub fn written_into(&self, page: &str, part: Part) -> Result<String, String> {
        let [head, _, tail] = split(page, part)?;
        let mut text = format!("Driver: {}.\n\n", self.driver);
        let other = |chip: Chip| format!("{0} registers | spilled | waves", chip.name());
        let [first, second, third] = Chip::ALL;
        let titles = format!(
            "| example | {} registers | spilled | waves | instructions | cost | {} | {} |",
            first.name(),
            other(second),
            other(third),
        );
        let _ = writeln!(text, "{titles}\n|---{}|", "|--:".repeat(11));
        for Row { name, chips: [a, b, c] } in &self.rows {
            let short = |s: &Statistics| format!("{} | {} | {}", s.registers, s.spilled, s.waves);
            let (instructions, cost) = (a.instructions, a.cost);
            let [a, b, c] = [a, b, c].map(short);
            let _ = writeln!(text, "| {name} | {a} | {instructions} | {cost} | {b} | {c} |");
        }
        let _ = writeln!(text, "\n{}", self.summary());
        Ok(format!("{head}{}{text}{END}{tail}", part.begin()))
    }

    /// How many examples spill, and how many run with few waves.
    fn summary(&self) -> String {
        let count = |keep: &dyn Fn(&Row) -> bool| self.rows.iter().filter(|row| keep(row)).count();
        let spill = count(&|row| row.chips.iter().any(|chip| chip.spilled > 0));
        let ten = count(&|row| row.chips[0].waves >= 10);
        let eight = count(&|row| row.chips[0].waves >= 8);
        let cost: u64 = self.rows.iter().map(|row| row.chips[0].cost).sum();
        format!(
            "{spill} of {} examples spill on one of the chips. On {}, {ten} run at 10 waves or\n\
             more and {eight} at 8 or more; the costs sum up to {cost}.",
            self.rows.len(),
            Chip::ALL[0].name(),
        )
    }

    /// What is worse than in another table, one line each.
    pub fn worse_than(&self, known: &Self) -> Vec<String> {
        let mut problems = Vec::new();
        for row in &self.rows {
            let Some(before) = known.rows.iter().find(|known| known.name == row.name) else {
                problems.push(format!("{} is not in docs/gpu.md", row.name));
                continue;
            };
            for ((chip, now), before) in Chip::ALL.into_iter().zip(row.chips).zip(before.chips) {
                let what = format!("{} on {}", row.name, chip.name());
                if now.spilled > before.spilled {
                    problems.push(format!(
                        "{what}: {} spilled registers, {} before",
                        now.spilled, before.spilled
                    ));
                }
                if now.waves < before.waves {
                    problems.push(format!("{what}: {} waves, {} before", now.waves, before.waves));
                }
                let is_known = before.cost > 0;
                if is_known && now.cost * 100 > before.cost * (100 + MOST_COST) {
                    problems.push(format!("{what}: cost {}, {} before", now.cost, before.cost));
                }
            }
        }
        for before in &known.rows {
            if !self.rows.iter().any(|row| row.name == before.name) {
                problems.push(format!("{} is no example, but in docs/gpu.md", before.name));
            }
        }
        problems
    }
}

/// The page before, in and after the table.
fn split(page: &str, part: Part) -> Result<[&str; 3], String> {
    let parts = page.split_once(&part.begin()).and_then(|(head, rest)| {
        let (table, tail) = rest.split_once(END)?;
        Some([head, table, tail])
    });
    parts.ok_or_else(|| format!("docs/gpu.md has no comments around its table of {}", part.name()))
}

fn row(cells: &[&str]) -> Option<Row> {
    let (name, numbers) = cells.split_first()?;
    let numbers: Vec<u64> = numbers.iter().map(|n| n.parse()).collect::<Result<_, _>>().ok()?;
    let [a, b, c, instructions, cost, d, e, f, g, h, i] = numbers[..] else { return None };
    let short = |registers, spilled, waves| Statistics {
        registers,
        spilled,
        waves,
        instructions: 0,
        cost: 0,
    };
    let first = Statistics { registers: a, spilled: b, waves: c, instructions, cost };
    Some(Row { name: (*name).to_owned(), chips: [first, short(d, e, f), short(g, h, i)] })
}
