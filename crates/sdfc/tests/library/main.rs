//! Checks every entry of the library, without a list of entries here.
//!
//! - `drawn`: the example compiles, something is visible, and f32 and f64 agree on the CPU.
//! - `gpu`: the GPU agrees with both.
//! - `contract`: promises hold at samples of the example and of variants with other numbers. The
//!   oracle finds the surface by changes of sign alone. Every mutant of a clause is refuted.
//!
//! `cargo test -p sdfc-cli -p sdfc --test library -- --nocapture` prints the table of entries and
//! checks at the end.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test stops where it fails, and this one prints a table"
)]

mod claims;
mod contract;
mod examples;
mod field;
mod functions;
mod geometry;
mod mutants;
mod rays;
mod samples;
mod table;
mod variants;

use std::sync::Arc;

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc_lang::library::{self, Entry};
use sdfc_render::testing;
use sdfc_tests::agree;

use table::{Column, Table};

fn main() {
    let arguments = Arguments::from_args();
    let entries: Vec<Arc<Entry>> = library::entries().into_iter().map(Arc::new).collect();
    let table = Table::new(&entries);
    let without_gpu = testing::without_gpu();
    let mut trials = examples::trials();
    for (row, entry) in entries.iter().enumerate() {
        let trial = |column: Column, check: fn(&Entry) -> Result<String, Failed>| {
            let (entry, table) = (Arc::clone(entry), table.clone());
            let name = format!("{}/{} ({})", column.name(), entry.name, entry.kind);
            Trial::test(name, move || {
                let result = check(&entry);
                table.set(row, column, result.as_ref().map_or("FAILED", |cell| cell));
                result.map(drop)
            })
        };
        trials.push(trial(Column::Drawn, drawn));
        trials.push(trial(Column::Gpu, gpu).with_ignored_flag(without_gpu));
        trials.push(trial(Column::Contract, kept));
    }
    let conclusion = libtest_mimic::run(&arguments, trials);
    if arguments.nocapture {
        println!("\n{table}");
    }
    conclusion.exit();
}

/// The light of the pictures. The default look, with its soft shadow, is drawn elsewhere.
const LIGHT: &str = "\nsun()";

fn drawn(entry: &Entry) -> Result<String, Failed> {
    let (hit, found) = agree::precisions(&agree::scene(&entry.name, &lit(entry))?)?;
    Ok(format!("{hit:>4} px {:.0e}", found.depth))
}

fn lit(entry: &Entry) -> String {
    format!("{}{LIGHT}", entry.example)
}

fn gpu(entry: &Entry) -> Result<String, Failed> {
    let found = agree::devices(&agree::scene(&entry.name, &lit(entry))?)?;
    Ok(format!("{:.0e}, {}/255", found.depth, found.color))
}

fn kept(entry: &Entry) -> Result<String, Failed> {
    if entry.kind != "fn" {
        return Ok(contract::check(entry).map(|it| it.to_string())?);
    }
    if functions::states_something(entry) {
        return Ok(functions::check(entry).map(|it| it.to_string())?);
    }
    // Its result is drawn and checked with the shapes that use it.
    let name = &entry.name;
    contract::check_scene(&entry.example).map_err(|e| format!("{name}: {e}"))?;
    Ok("states nothing; its example keeps what is derived".to_owned())
}
