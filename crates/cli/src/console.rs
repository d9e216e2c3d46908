//! What is said on stderr: errors, warnings, notes and progress.

use std::io::{IsTerminal, Write, stderr, stdout};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args::{ColorChoice, Global};
use crate::failure::Failure;

/// How much to say, and whether in colour.
pub struct Console {
    /// Whether diagnostics and errors are coloured.
    pub color: bool,
    choice: ColorChoice,
    quiet: bool,
    verbose: bool,
}

impl Console {
    /// As the global options ask. `auto` is colour on a terminal unless `NO_COLOR` is set.
    pub fn new(global: &Global) -> Self {
        let color = colored(global.color, &stderr());
        Self { color, choice: global.color, quiet: global.quiet, verbose: global.verbose }
    }

    /// Whether what goes to stdout for people is coloured.
    pub fn output_color(&self) -> bool {
        colored(self.choice, &stdout())
    }

    /// Why the command ends. Diagnostics of a scene have been shown already and need no further line.
    pub fn failure(&self, failure: &Failure) {
        match failure {
            Failure::Scene => {}
            Failure::Call(message) | Failure::Machine(message) | Failure::Interrupted(message) => {
                self.error(message)
            }
        }
    }

    /// An error that has no place in a scene.
    pub fn error(&self, message: &str) {
        let word = if self.color { "\x1b[1;31merror\x1b[0m" } else { "error" };
        self.text(&format!("{word}: {message}\n"));
    }

    /// One line that says what was done; not with `-q`.
    pub fn note(&self, line: &str) {
        if !self.quiet {
            self.text(&format!("{line}\n"));
        }
    }

    /// One line for those who want to know more; only with `-v`.
    pub fn detail(&self, line: impl FnOnce() -> String) {
        if self.verbose {
            self.text(&format!("{}\n", line()));
        }
    }

    /// Whether warnings are shown.
    pub fn shows_warnings(&self) -> bool {
        !self.quiet
    }

    /// Text as it stands. That stderr is closed is no reason to fail.
    pub fn text(&self, text: &str) {
        let _ = stderr().write_all(text.as_bytes());
    }

    /// A progress bar: on a terminal, and not with `-q`; work shorter than half a second shows none.
    pub fn progress(&self, what: &str) -> Progress {
        let shown = !self.quiet && stderr().is_terminal();
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{prefix} {wide_bar} {percent}% {eta}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.set_prefix(what.to_owned());
        Progress { bar, shown }
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

/// A bar that appears when the work turns out to be long.
pub struct Progress {
    bar: ProgressBar,
    shown: bool,
}

impl Progress {
    const PATIENCE: Duration = Duration::from_millis(500);

    /// `done` of `all` parts are done.
    pub fn set(&self, done: u64, all: u64) {
        if self.shown && self.bar.is_hidden() && self.bar.elapsed() > Self::PATIENCE {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_length(all);
        self.bar.set_position(done);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
