//! Output to stderr: errors, warnings, notes and progress bars.

use std::io::{IsTerminal, Write, stderr, stdout};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args::{ColorChoice, Global};
use crate::failure::Failure;

/// Verbosity and colour of messages.
#[derive(Clone)]
pub struct Console {
    /// True if diagnostics and errors are coloured.
    pub color: bool,
    choice: ColorChoice,
    quiet: bool,
    verbose: bool,
}

impl Console {
    /// Applies the global options. `auto` is colour on a terminal unless `NO_COLOR` is set.
    pub fn new(global: &Global) -> Self {
        let color = colored(global.color, &stderr());
        Self { color, choice: global.color, quiet: global.quiet, verbose: global.verbose }
    }

    /// True if text on stdout is coloured.
    pub fn output_color(&self) -> bool {
        colored(self.choice, &stdout())
    }

    /// Prints why the command failed. Diagnostics of a scene have already been printed.
    pub fn failure(&self, failure: &Failure) {
        match failure {
            Failure::Scene => {}
            Failure::Call(message) | Failure::Machine(message) | Failure::Interrupted(message) => {
                self.error(message)
            }
        }
    }

    /// Prints an error that has no location in a scene.
    pub fn error(&self, message: &str) {
        let word = if self.color { "\x1b[1;31merror\x1b[0m" } else { "error" };
        self.text(&format!("{word}: {message}\n"));
    }

    /// Prints a warning that has no location in a scene, except with `-q`.
    pub fn warning(&self, message: &str) {
        let word = if self.color { "\x1b[1;33mwarning\x1b[0m" } else { "warning" };
        self.note(&format!("{word}: {message}"));
    }

    /// Prints one line about the result, except with `-q`.
    pub fn note(&self, line: &str) {
        if !self.quiet {
            self.text(&format!("{line}\n"));
        }
    }

    /// Prints one line of details, with `-v` only.
    pub fn detail(&self, line: impl FnOnce() -> String) {
        if self.verbose {
            self.text(&format!("{}\n", line()));
        }
    }

    /// True if warnings are printed.
    pub fn shows_warnings(&self) -> bool {
        !self.quiet
    }

    /// Prints text unchanged. A closed stderr is ignored.
    pub fn text(&self, text: &str) {
        let _ = stderr().write_all(text.as_bytes());
    }

    /// A progress bar for work that takes more than half a second, on a terminal and without `-q`.
    /// Until the first report, as while a driver compiles a shader, it shows the time so far.
    /// Elsewhere, as in a log, it is a line from time to time, so that work does not look like a
    /// hang.
    pub fn progress(&self, what: &str) -> Progress {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{prefix}: preparing, {elapsed} so far");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.set_prefix(what.to_owned());
        match (self.quiet, stderr().is_terminal()) {
            (true, _) => {}
            (false, true) => Progress::show_later(bar.clone()),
            (false, false) => Progress::log_later(bar.clone()),
        }
        Progress { bar, reported: AtomicBool::new(false) }
    }
}

fn colored(choice: ColorChoice, stream: &impl IsTerminal) -> bool {
    match choice {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        ColorChoice::Auto => {
            let refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
            stream.is_terminal() && !refused
        }
    }
}

/// A progress bar that appears after [`Self::DELAY`], or lines in a log.
pub struct Progress {
    bar: ProgressBar,
    reported: AtomicBool,
}

impl Progress {
    const DELAY: Duration = Duration::from_millis(500);
    /// How often the time is drawn.
    const TICK: Duration = Duration::from_millis(250);

    /// When a log has its first line, and the longest time between two lines. It doubles from line
    /// to line.
    const LOG_TIMES: [Duration; 2] = [Duration::from_secs(10), Duration::from_secs(80)];

    /// Draws the bar from a thread, because the work may not report for minutes.
    fn show_later(bar: ProgressBar) {
        let show = move || {
            thread::sleep(Self::DELAY);
            if !bar.is_finished() {
                bar.set_draw_target(ProgressDrawTarget::stderr());
                bar.enable_steady_tick(Self::TICK);
            }
        };
        // Without a thread there is no bar.
        let _ = thread::Builder::new().name("progress".to_owned()).spawn(show);
    }

    /// Writes lines from a thread until the work ends.
    fn log_later(bar: ProgressBar) {
        let log = move || {
            let [mut wait, longest] = Self::LOG_TIMES;
            loop {
                thread::sleep(wait);
                if bar.is_finished() {
                    return;
                }
                let (what, seconds) = (bar.prefix(), bar.elapsed().as_secs());
                let line = match bar.length() {
                    Some(total) => {
                        let percent = 100 * bar.position() / total.max(1);
                        format!("{what}: {percent} % after {seconds} s\n")
                    }
                    None => format!("{what}: preparing, {seconds} s so far\n"),
                };
                let _ = stderr().write_all(line.as_bytes());
                wait = (2 * wait).min(longest);
            }
        };
        // Without a thread there are no lines.
        let _ = thread::Builder::new().name("progress".to_owned()).spawn(log);
    }

    /// Shows that `done` of `total` units of work are done.
    pub fn set(&self, done: u64, total: u64) {
        if !self.reported.swap(true, Ordering::Relaxed) {
            let style = ProgressStyle::with_template("{prefix} {wide_bar} {percent}% {eta}");
            self.bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        }
        self.bar.set_length(total);
        self.bar.set_position(done);
    }

    /// Begins another part of the work.
    pub fn rename(&self, what: &str) {
        self.bar.set_prefix(what.to_owned());
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
