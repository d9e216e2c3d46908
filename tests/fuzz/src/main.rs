//! The campaign as a program.

#![allow(clippy::print_stdout, reason = "a program prints")]

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;
use sdfc_fuzz::campaign::{Event, Found, Limits, Table};
use sdfc_fuzz::catalogue::Catalogue;
use sdfc_fuzz::oracles::ORACLES;
use sdfc_fuzz::texts::oracles::TEXT_ORACLES;
use sdfc_fuzz::{campaign, generate, repair, texts};

/// Generates programs and tests what must hold of each. Ends with status 1 if something does not.
#[derive(Debug, Parser)]
struct Arguments {
    /// The time that the campaign runs for, in minutes
    #[arg(long, value_name = "NUMBER", default_value_t = 3.0)]
    minutes: f64,
    /// The most programs
    #[arg(long, value_name = "COUNT", default_value_t = u64::MAX)]
    programs: u64,
    /// The seed of the first program; the next programs have the next seeds
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// The name of an oracle to ask; may be given several times [default: all oracles]
    #[arg(long, value_name = "NAME")]
    oracle: Vec<String>,
    /// The folder for the programs with faults
    #[arg(long, value_name = "FOLDER", default_value = "target/fuzz")]
    out: PathBuf,
    /// Judges texts with mistakes in them, instead of programs
    #[arg(long)]
    texts: bool,
    /// Only prints the program of the seed
    #[arg(long, conflicts_with = "texts")]
    print: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = if arguments.print { print(arguments.seed) } else { run(&arguments) };
    match result {
        Ok(code) => code,
        Err(error) => {
            println!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn print(seed: u64) -> Result<ExitCode, String> {
    let accepted = repair(generate(&Catalogue::read()?, seed));
    let accepted = accepted.map_err(|(program, errors)| program.text() + &errors)?;
    print!("{}", accepted.program.text());
    Ok(ExitCode::SUCCESS)
}

fn run(arguments: &Arguments) -> Result<ExitCode, String> {
    let limits = Limits {
        time: Duration::try_from_secs_f64(60.0 * arguments.minutes).map_err(|e| e.to_string())?,
        programs: arguments.programs,
        seed: arguments.seed,
    };
    let folder = &arguments.out;
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut failed = None;
    let mut on = |event: &Event<'_>| {
        if let Err(error) = save(folder, event) {
            failed.get_or_insert(error);
        }
    };
    let table = if arguments.texts {
        let oracles = asked(&arguments.oracle, &TEXT_ORACLES, |oracle| oracle.name)?;
        texts::run(limits, &oracles, &mut on)?
    } else {
        let oracles = asked(&arguments.oracle, &ORACLES, |oracle| oracle.name)?;
        campaign::run(limits, &oracles, &mut on)?
    };
    println!("{}", as_text(&table));
    match failed {
        Some(error) => Err(format!("{}: {error}", folder.display())),
        None if table.found.is_empty() => Ok(ExitCode::SUCCESS),
        None => Ok(ExitCode::FAILURE),
    }
}

/// The oracles with these names; all if there are no names.
fn asked<O: Copy>(
    names: &[String],
    oracles: &[O],
    name_of: fn(&O) -> &'static str,
) -> Result<Vec<O>, String> {
    let known: Vec<&str> = oracles.iter().map(name_of).collect();
    if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(format!("there is no oracle `{name}`; there are {}", known.join(", ")));
    }
    let is_asked = |oracle: &&O| names.is_empty() || names.iter().any(|it| it == name_of(oracle));
    Ok(oracles.iter().filter(is_asked).copied().collect())
}

/// Keeps the program that is judged, in case it ends the process, and writes findings.
fn save(folder: &Path, event: &Event<'_>) -> std::io::Result<()> {
    match event {
        Event::Program(seed, text) => {
            std::fs::write(folder.join("running.sdf"), format!("// seed {seed}\n{text}"))
        }
        Event::Found(found) => {
            let Found { oracle, seed, finding, text } = found;
            println!("{oracle}, seed {seed}: {}", finding.kind);
            let message = finding.message.replace('\n', "\n// ");
            let head = format!("// {oracle}, seed {seed}: {}\n// {message}\n", finding.kind);
            std::fs::write(folder.join(format!("{oracle}_{seed}.sdf")), head + text)
        }
    }
}

/// The table of a campaign, as documents show it.
fn as_text(table: &Table) -> String {
    let Table { programs, valid, parts, bytes, rows, found, time } = table;
    let mut text = format!(
        "{programs} programs of {bytes} bytes, {valid} valid with {parts} parts, {} findings, \
         {:.1} minutes\n\n\
         | oracle | statement | run | left out | findings |\n|---|---|---|---|---|\n",
        found.len(),
        time.as_secs_f64() / 60.0
    );
    for row in rows {
        let programs = ORACLES.iter().map(|oracle| (oracle.name, oracle.summary));
        let texts = TEXT_ORACLES.iter().map(|oracle| (oracle.name, oracle.summary));
        let summary = programs.chain(texts).find(|(name, _)| *name == row.oracle);
        let summary = summary.map_or("", |(_, summary)| summary);
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "| `{}` | {summary} | {} | {} | {} |",
            row.oracle, row.run, row.left_out, row.findings
        );
    }
    text
}
