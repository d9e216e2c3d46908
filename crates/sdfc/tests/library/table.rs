//! The table of entries and checks. No cell is blank: a check that did not run has `not run`.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use sdfc_lang::library::Entry;

use crate::contract::Outcome;

/// The checks.
#[derive(Clone, Copy, Debug)]
pub enum Column {
    Drawn,
    Gpu,
    Contract,
}

impl Column {
    const ALL: [Self; 3] = [Self::Drawn, Self::Gpu, Self::Contract];

    pub fn name(self) -> &'static str {
        match self {
            Self::Drawn => "drawn",
            Self::Gpu => "gpu",
            Self::Contract => "contract",
        }
    }

    /// Returns the heading of the column.
    fn title(self) -> &'static str {
        match self {
            Self::Drawn => "seen, f32-f64",
            Self::Gpu => "GPU-CPU",
            Self::Contract => Outcome::TITLE,
        }
    }
}

struct Row {
    name: String,
    cells: [String; Column::ALL.len()],
}

/// The table; clones share its rows.
#[derive(Clone)]
pub struct Table(Arc<Mutex<Vec<Row>>>);

impl Table {
    pub fn new(entries: &[Arc<Entry>]) -> Self {
        let row = |entry: &Arc<Entry>| Row {
            name: format!("{} ({})", entry.name, entry.kind),
            cells: Column::ALL.map(|_| "not run".to_owned()),
        };
        Self(Arc::new(Mutex::new(entries.iter().map(row).collect())))
    }

    pub fn set(&self, row: usize, column: Column, cell: &str) {
        let mut rows = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        rows[row].cells[column as usize] = cell.to_owned();
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut write = |name: &str, cells: [&str; 3]| {
            writeln!(f, "{name:<28} {:<16} {:<16} {}", cells[0], cells[1], cells[2])
        };
        write("entry", Column::ALL.map(Column::title))?;
        for row in rows.iter() {
            write(&row.name, [&row.cells[0], &row.cells[1], &row.cells[2]])?;
        }
        Ok(())
    }
}

impl Outcome {
    const TITLE: &'static str = "outside inside lipschitz steepest bounds  scenes faults caught";
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [outside, inside] = &self.sides;
        let constant = self.lipschitz.map_or("none".to_owned(), |it| format!("{it:.4}"));
        let steepest = self.steepest;
        let bounds = if self.bounds { "stated" } else { "derived" };
        let caught = self.mutants.values().filter(|caught| **caught).count();
        write!(f, "{outside:<7} {inside:<6} {constant:<9} {steepest:<8.4} {bounds:<7} ")?;
        match self.mutants.len() {
            0 => write!(f, "{:<6} no clause can be exaggerated", self.scenes),
            all => write!(f, "{:<6} {caught}/{all}", self.scenes),
        }
    }
}
