//! Spreads a campaign over processes. A program that ends its process, or does not end, is a
//! finding, and a new process goes on with the next seed.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Sender, channel};
use std::time::Instant;

use crate::campaign::{Limits, found};
use crate::oracles::Finding;
use crate::table::{Judged, Table};

/// The oracle of a program that ends its process.
const PROCESS: &str = "process";

/// How a worker is started: this program, with arguments that select the oracles.
#[derive(Clone, Debug)]
pub struct Worker {
    /// The program.
    pub program: PathBuf,
    /// Arguments beside those of seeds, limits and folder.
    pub arguments: Vec<String>,
    /// The folder for the program that is judged.
    pub folder: PathBuf,
}

/// Runs a campaign in processes, and calls `on` for each seed.
///
/// # Errors
///
/// A process cannot be started.
pub fn run(
    limits: Limits,
    count: u64,
    worker: &Worker,
    mut table: Table,
    on: &mut dyn FnMut(&Judged),
) -> Result<Table, String> {
    let start = Instant::now();
    let count = count.clamp(1, limits.programs.max(1));
    let (sender, receiver) = channel();
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..count)
            .map(|at| {
                let share = Limits {
                    seed: limits.seed.saturating_add(at),
                    stride: count,
                    programs: limits.programs.saturating_sub(at).div_ceil(count),
                    ..limits
                };
                let sender = sender.clone();
                scope.spawn(move || all_of(share, worker, at, &sender))
            })
            .collect();
        drop(sender);
        for judged in receiver {
            on(&judged);
            table.add(judged);
        }
        let mut results = workers.into_iter().map(|worker| worker.join());
        results.try_for_each(|result| result.unwrap_or(Ok(())))
    })?;
    table.time = start.elapsed();
    Ok(table)
}

/// Judges all seeds of one worker, with a new process after each that ends early.
fn all_of(
    mut limits: Limits,
    worker: &Worker,
    at: u64,
    results: &Sender<Judged>,
) -> Result<(), String> {
    let end = Instant::now() + limits.time;
    let folder = worker.folder.join(format!("worker{at}"));
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    while limits.programs > 0 && Instant::now() < end {
        limits.time = end - Instant::now();
        let mut child = started(limits, worker, &folder).map_err(|e| e.to_string())?;
        let (mut last, mut count) = (None, 0);
        let lines = child.stdout.take().map(|out| BufReader::new(out).lines());
        for line in lines.into_iter().flatten().map_while(Result::ok) {
            let Ok(judged) = serde_json::from_str::<Judged>(&line) else { continue };
            (last, count) = (Some(judged.seed), count + 1);
            // Nobody listens if another worker could not start.
            let _ = results.send(judged);
        }
        let status = child.wait().map_err(|e| e.to_string())?;
        let next = last.map_or(limits.seed, |last: u64| last.saturating_add(limits.stride));
        limits = Limits { seed: next, programs: limits.programs.saturating_sub(count), ..limits };
        if !status.success() {
            let _ = results.send(ended(next, status, &folder));
            limits.seed = next.saturating_add(limits.stride);
            limits.programs = limits.programs.saturating_sub(1);
        }
    }
    Ok(())
}

fn started(limits: Limits, worker: &Worker, folder: &Path) -> std::io::Result<Child> {
    let Limits { time, programs, seed, stride, patience } = limits;
    let minutes = time.as_secs_f64() / 60.0;
    Command::new(&worker.program)
        .args(&worker.arguments)
        .args(["--worker".to_owned(), stride.to_string()])
        .args(["--seed".to_owned(), seed.to_string()])
        .args(["--programs".to_owned(), programs.to_string()])
        .args(["--minutes".to_owned(), minutes.to_string()])
        .args(["--patience".to_owned(), patience.as_secs().to_string()])
        .arg("--out")
        .arg(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
}

/// The finding of a seed whose process ended.
fn ended(seed: u64, status: ExitStatus, folder: &Path) -> Judged {
    let text = std::fs::read_to_string(folder.join(RUNNING)).ok();
    // The process may have ended before it wrote the program of this seed.
    let text = text.filter(|text| text.starts_with(&first_line(seed))).unwrap_or_default();
    let finding = Finding { kind: "ended".to_owned(), message: status.to_string() };
    Judged { seed, found: vec![found(PROCESS, seed, finding, text)], ..Judged::default() }
}

/// The file with the program that is judged.
pub const RUNNING: &str = "running.sdf";

/// Returns the first line of that file.
pub fn first_line(seed: u64) -> String {
    format!("// seed {seed}\n")
}
