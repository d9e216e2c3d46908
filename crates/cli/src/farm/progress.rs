//! Progress as lines of JSON, for programs that watch.

use std::cell::Cell;
use std::path::Path;
use std::time::Instant;

use serde::Serialize;

use super::options::ProgressForm;
use crate::failure::Failure;
use crate::output;

/// A picture that is finished.
#[derive(Debug, Serialize)]
struct Line<'a> {
    /// The number of the frame; null for a single picture.
    frame: Option<u32>,
    /// The region as `X,Y,WxH`; null for a whole picture.
    region: Option<String>,
    /// `drawn`, or `skipped` if it was finished before.
    state: &'static str,
    /// Its file; null for stdout.
    file: Option<&'a Path>,
    /// How many pictures of this call are finished, and how many there are.
    done: u32,
    total: u32,
    /// The number of unproven pixels.
    unproven: u64,
    /// Seconds since the last line, or since the start.
    seconds: f64,
}

/// Writes one line for each finished picture, if that is asked for.
pub struct Reporter {
    form: ProgressForm,
    last: Cell<Instant>,
}

/// What a line says.
pub struct Finished<'a> {
    /// The number of the frame.
    pub frame: Option<u32>,
    /// The region.
    pub region: Option<String>,
    /// True if the picture was finished before.
    pub skipped: bool,
    /// Its file.
    pub file: Option<&'a Path>,
    /// How many pictures are finished, and how many there are.
    pub position: [u32; 2],
    /// The number of unproven pixels.
    pub unproven: u64,
}

impl Reporter {
    /// Starts the clock.
    pub fn new(form: ProgressForm) -> Self {
        Self { form, last: Cell::new(Instant::now()) }
    }

    /// Writes a line.
    ///
    /// # Errors
    ///
    /// Stdout cannot be written.
    pub fn finished(&self, finished: Finished<'_>) -> Result<(), Failure> {
        let seconds = self.last.replace(Instant::now()).elapsed().as_secs_f64();
        if self.form != ProgressForm::Json {
            return Ok(());
        }
        let Finished { frame, region, skipped, file, position: [done, total], unproven } = finished;
        let state = if skipped { "skipped" } else { "drawn" };
        let seconds = (seconds * 1e3).round() / 1e3;
        let line = Line { frame, region, state, file, done, total, unproven, seconds };
        let line = serde_json::to_string(&line)
            .map_err(|error| Failure::Machine(format!("cannot write JSON: {error}")))?;
        output::to_stdout(format!("{line}\n").as_bytes())
    }
}
