//! A visitor who works in the playground for as long as [`MINUTES`] says: scenes are typed, broken
//! and repaired, sliders move, examples are opened, the window changes its size. At the end, page
//! and browser are as large as in the first half. It runs only if the variable is set.

#![expect(clippy::print_stdout, reason = "people read the sizes")]

use std::collections::HashMap;
use std::time::{Duration, Instant};

use libtest_mimic::Failed;
use sdfc_test_support::Resources;

use crate::Session;
use crate::measure::scene;
use crate::playground::{self, BALL, MISSPELT, PARAMS, Page, compiled};

/// The environment variable that runs this: the minutes that it takes.
pub const MINUTES: &str = "SDFC_SOAK_MINUTES";
/// Rounds between two measurements.
const BATCH: u32 = 5;
/// How much larger the last size may be than the largest of the first half. A browser collects its
/// garbage when it likes.
const SLACK: f64 = 1.25;
const WINDOWS: [[u32; 2]; 2] = [[900, 420], [1400, 560]];

/// What the page and the browser hold.
#[derive(Clone, Copy, Debug)]
struct Sample {
    nodes: u64,
    /// The objects of the page in KiB.
    heap: u64,
    /// Resident memory of all processes of the browser in MiB, with what they share.
    memory: u64,
    workers: u64,
}

/// Works in the page until the time is over.
pub fn stays_small(session: &mut Session, backend: &str) -> Result<(), Failed> {
    let minutes: f64 = std::env::var(MINUTES)?.parse()?;
    let mut page = Page::open(&mut session.chromium, &format!("?backend={backend}&time=0"))?;
    let start = Instant::now();
    let (mut samples, mut shown) = (Vec::new(), None);
    println!("| minutes | rounds | nodes | heap in KiB | memory in MiB | workers |");
    println!("|---|---|---|---|---|---|");
    for round in 0.. {
        if start.elapsed() > Duration::from_secs_f64(60.0 * minutes) {
            break;
        }
        work(&mut page, round).map_err(|e| format!("round {round}: {}", said(&e)))?;
        if round % BATCH == BATCH - 1 {
            page.write(BALL, "drawn")?;
            let sample = measure(&mut page)?;
            samples.push(sample);
            let minute = start.elapsed().as_secs() / 60;
            if shown.replace(minute) != Some(minute) {
                let Sample { nodes, heap, memory, workers } = sample;
                println!("| {minute} | {round} | {nodes} | {heap} | {memory} | {workers} |");
            }
        }
    }
    has_not_grown(&samples)
}

fn said(error: &Failed) -> &str {
    error.message().unwrap_or_default()
}

/// One round: an edit, an error with its fix, a slider, now and then a large scene, an example and
/// another window.
fn work(page: &mut Page, round: u32) -> Result<(), Failed> {
    let size = 0.5 + f64::from(round % 50) / 100.0;
    let text = BALL.replace("sphere(1)", &format!("sphere({size})"));
    page.write(&text, "drawn")?;
    if round.is_multiple_of(BATCH) {
        page.expect_picture(&compiled(&text)?, None, "the scene of the round")?;
    }
    page.write(MISSPELT, "errors")?;
    page.after("drawn", |chromium| chromium.click("#problems .fix", [0.5, 0.5]))?;
    page.write(PARAMS, "drawn")?;
    let at = 0.1 + 0.8 * f64::from(round % 9) / 8.0;
    page.after("drawn", |chromium| chromium.click("#params [name=r]", [at, 0.5]))?;
    match round % 8 {
        2 => page.write(&scene(10 + round as usize % 20), "drawn")?,
        4 => playground::open_example(page, round as usize % 4)?,
        6 => {
            let window = WINDOWS[round as usize / 8 % WINDOWS.len()];
            page.chromium.resize(window)?;
            page.write(&text, "drawn")?;
        }
        _ => {}
    }
    page.expect_no_complaint()
}

fn measure(page: &mut Page) -> Result<Sample, Failed> {
    let size = page.chromium.size()?;
    let processes = descendants(page.chromium.process());
    let memory = processes.iter().map(|it| Resources::of(it).memory).sum();
    let (heap, workers) = (size.heap / 1024, size.workers as u64);
    Ok(Sample { nodes: size.nodes, heap, memory, workers })
}

/// The numbers of a process, its children, their children and so on.
fn descendants(process: u32) -> Vec<String> {
    let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let mut children: HashMap<String, Vec<String>> = HashMap::new();
    for name in entries.map(|entry| entry.file_name().to_string_lossy().into_owned()) {
        let status = std::fs::read_to_string(format!("/proc/{name}/status")).unwrap_or_default();
        if let Some(parent) = status.lines().find_map(|line| line.strip_prefix("PPid:")) {
            children.entry(parent.trim().to_owned()).or_default().push(name);
        }
    }
    let mut found = vec![process.to_string()];
    let mut at = 0;
    while let Some(parent) = found.get(at) {
        found.extend(children.remove(parent).unwrap_or_default());
        at += 1;
    }
    found
}

fn has_not_grown(samples: &[Sample]) -> Result<(), Failed> {
    let Some(last) = samples.last() else { return Err("no time for a measurement".into()) };
    let rows: [fn(&Sample) -> u64; 4] =
        [|it| it.nodes, |it| it.heap, |it| it.memory, |it| it.workers];
    let half = &samples[..=samples.len() / 2];
    let grew = |of: &fn(&Sample) -> u64| {
        let most = half.iter().map(of).max().unwrap_or(0);
        of(last) as f64 > SLACK * most as f64
    };
    if rows.iter().any(|of| grew(of)) {
        return Err(format!("the page grew: {samples:?}").into());
    }
    Ok(())
}
