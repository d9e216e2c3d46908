//! The campaign as a program.

#![allow(clippy::print_stdout, reason = "a program prints")]

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;
use sdfc_fuzz::campaign::{Event, Limits};
use sdfc_fuzz::catalogue::Catalogue;
use sdfc_fuzz::oracles::{GROUPS, ORACLES, Oracle};
use sdfc_fuzz::table::{Found, Judged, Table};
use sdfc_fuzz::texts::oracles::{TEXT_ORACLES, TextOracle};
use sdfc_fuzz::workers::{RUNNING, Worker, first_line};
use sdfc_fuzz::{campaign, generate, repair, texts, workers};

/// Generates programs and tests what must hold of each. Ends with status 1 if something does not.
#[derive(Debug, Parser)]
struct Arguments {
    /// The time that the campaign runs for, in minutes
    #[arg(long, value_name = "NUMBER", default_value_t = 3.0)]
    minutes: f64,
    /// The most programs
    #[arg(long, value_name = "COUNT", default_value_t = u64::MAX)]
    programs: u64,
    /// The seed of the first program; the next programs have the next seeds. `new` takes the time
    #[arg(long, value_name = "NUMBER", default_value = "1", value_parser = seed)]
    seed: u64,
    /// The name of an oracle to ask, or of a group: quick, shaders, pictures; may be given several
    /// times [default: all oracles]
    #[arg(long, value_name = "NAME")]
    oracle: Vec<String>,
    /// The number of processes
    #[arg(long, value_name = "COUNT", default_value_t = 1)]
    jobs: u64,
    /// The seconds after which an oracle that is not done has found a fault
    #[arg(long, value_name = "SECONDS", default_value_t = 60)]
    patience: u64,
    /// The folder for the programs with faults
    #[arg(long, value_name = "FOLDER", default_value = "target/fuzz")]
    out: PathBuf,
    /// Judges texts with mistakes in them, instead of programs
    #[arg(long)]
    texts: bool,
    /// Only prints the program of the seed
    #[arg(long, conflicts_with = "texts")]
    print: bool,
    /// Judges every program of this many, and prints a line of JSON for each
    #[arg(long, value_name = "STRIDE", hide = true)]
    worker: Option<u64>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match (arguments.print, arguments.worker) {
        (true, _) => print(arguments.seed),
        (false, Some(stride)) => work(&arguments, stride),
        (false, None) => run(&arguments),
    };
    match result {
        Ok(code) => code,
        Err(error) => {
            println!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn seed(text: &str) -> Result<u64, String> {
    if text == "new" {
        let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
        return Ok(now.map_or(0, |now| now.as_secs()));
    }
    text.parse().map_err(|_| "expected a number, or `new`".to_owned())
}

fn print(seed: u64) -> Result<ExitCode, String> {
    let accepted = repair(generate(&Catalogue::read()?, seed));
    let accepted = accepted.map_err(|(program, errors)| program.text() + &errors)?;
    print!("{}", accepted.program.text());
    Ok(ExitCode::SUCCESS)
}

/// The oracles that were asked for.
enum Asked {
    Programs(Vec<Oracle>),
    Texts(Vec<TextOracle>),
}

impl Asked {
    fn of(arguments: &Arguments) -> Result<Self, String> {
        let names = &arguments.oracle;
        Ok(match arguments.texts {
            true => Self::Texts(named(names, &TEXT_ORACLES, |oracle| oracle.name)?),
            false => Self::Programs(named(names, &ORACLES, |oracle| oracle.name)?),
        })
    }

    fn table(&self) -> Table {
        match self {
            Self::Programs(all) => Table::new(all.iter().map(|it| (it.name, it.summary))),
            Self::Texts(all) => Table::new(all.iter().map(|it| (it.name, it.summary))),
        }
    }
}

/// The oracles with these names or of these groups; all if there are no names.
fn named<O: Copy>(
    names: &[String],
    oracles: &[O],
    name_of: fn(&O) -> &'static str,
) -> Result<Vec<O>, String> {
    let group = |name: &str| GROUPS.iter().find(|group| group.0 == name).map(|group| group.1);
    let known: Vec<&str> = oracles.iter().map(name_of).collect();
    let is_known = |name: &&String| {
        let has_some = |of: &[&str]| of.iter().any(|it| known.contains(it));
        known.contains(&name.as_str()) || group(name).is_some_and(has_some)
    };
    if let Some(name) = names.iter().find(|name| !is_known(name)) {
        return Err(format!("there is no oracle `{name}`; there are {}", known.join(", ")));
    }
    let is_asked = |oracle: &&O| {
        let name = name_of(oracle);
        let has = |it: &String| it == name || group(it).is_some_and(|of| of.contains(&name));
        names.is_empty() || names.iter().any(has)
    };
    Ok(oracles.iter().filter(is_asked).copied().collect())
}

fn limits(arguments: &Arguments, stride: u64) -> Result<Limits, String> {
    let time = Duration::try_from_secs_f64(60.0 * arguments.minutes).map_err(|e| e.to_string())?;
    let patience = Duration::from_secs(arguments.patience);
    Ok(Limits { time, programs: arguments.programs, seed: arguments.seed, stride, patience })
}

/// Runs the campaign in processes of their own.
fn run(arguments: &Arguments) -> Result<ExitCode, String> {
    let asked = Asked::of(arguments)?;
    let folder = &arguments.out;
    let oracles = arguments.oracle.iter().flat_map(|name| ["--oracle".to_owned(), name.clone()]);
    let worker = Worker {
        program: std::env::current_exe().map_err(|e| e.to_string())?,
        arguments: oracles.chain(arguments.texts.then(|| "--texts".to_owned())).collect(),
        folder: folder.clone(),
    };
    println!("the first seed is {}", arguments.seed);
    let mut failed = None;
    let mut on = |judged: &Judged| {
        for found in &judged.found {
            println!("{}, seed {}: {}", found.oracle, found.seed, found.finding.kind);
            if let Err(error) = save(folder, found) {
                failed.get_or_insert(error);
            }
        }
    };
    let limits = limits(arguments, 1)?;
    let table = workers::run(limits, arguments.jobs, &worker, asked.table(), &mut on)?;
    println!("{table}");
    match failed {
        Some(error) => Err(format!("{}: {error}", folder.display())),
        None if table.found.is_empty() => Ok(ExitCode::SUCCESS),
        None => Ok(ExitCode::FAILURE),
    }
}

/// Writes a finding.
fn save(folder: &Path, found: &Found) -> std::io::Result<()> {
    let Found { oracle, seed, finding, text } = found;
    let message = finding.message.replace('\n', "\n// ");
    let head = format!("// {oracle}, seed {seed}: {}\n// {message}\n", finding.kind);
    std::fs::write(folder.join(format!("{oracle}_{seed}.sdf")), head + text)
}

/// Judges the programs of one process. Before each it writes the program to a file, in case it ends
/// the process.
fn work(arguments: &Arguments, stride: u64) -> Result<ExitCode, String> {
    let limits = limits(arguments, stride)?;
    let running = arguments.out.join(RUNNING);
    let mut on = |event: &Event<'_>| match event {
        Event::Program(seed, text) => {
            // Without the file, a program that ends the process is known by its seed alone.
            let _ = std::fs::write(&running, first_line(*seed) + text);
        }
        Event::Judged(judged) => {
            if let Ok(line) = serde_json::to_string(judged) {
                println!("{line}");
            }
        }
    };
    match Asked::of(arguments)? {
        Asked::Programs(oracles) => campaign::run(limits, &oracles, &mut on)?,
        Asked::Texts(oracles) => texts::run(limits, &oracles, &mut on)?,
    };
    Ok(ExitCode::SUCCESS)
}
