//! Ctrl-C: the first one stops the work, the second one ends the process at once.
//!
//! Work that reports progress stops by itself. A driver that compiles a shader, or an analysis,
//! reports none, so the process ends anyway after [`GRACE`]. A file is written under a temporary
//! name and renamed, so no partial file is left under its final name.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use signal_hook::consts::SIGINT;
use signal_hook::{flag, low_level};

use crate::console::Console;
use crate::failure::{Failure, INTERRUPTED};
use crate::output;

/// How long the work may take to stop by itself.
const GRACE: Duration = Duration::from_millis(700);
/// How often the flag is read.
const PERIOD: Duration = Duration::from_millis(50);

/// Tells if Ctrl-C has been pressed.
pub struct Interrupt {
    pressed: Arc<AtomicBool>,
    message: Arc<Mutex<String>>,
}

impl Interrupt {
    /// Handles Ctrl-C from now on. `message` says what was done when it is pressed. If the system
    /// refuses, Ctrl-C ends the process as usual.
    pub fn watch(message: &str, console: &Console) -> Self {
        let pressed = Arc::new(AtomicBool::new(false));
        // The order matters: the handlers run in it, and the first must find the flag unset once.
        let _ =
            flag::register_conditional_shutdown(SIGINT, INTERRUPTED.into(), Arc::clone(&pressed));
        let _ = flag::register(SIGINT, Arc::clone(&pressed));
        let interrupt = Self { pressed, message: Arc::new(Mutex::new(message.to_owned())) };
        interrupt.end_in_time(console.clone());
        interrupt
    }

    /// Changes what is said when Ctrl-C is pressed.
    pub fn set_message(&self, message: String) {
        *self.message.lock().unwrap_or_else(PoisonError::into_inner) = message;
    }

    /// `Break` after Ctrl-C.
    pub fn flow(&self) -> ControlFlow<()> {
        if self.is_pressed() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// The failure of a command that Ctrl-C stopped.
    pub fn failure(&self) -> Failure {
        Failure::Interrupted(self.message())
    }

    /// Returns the failure, with the message of this command if Ctrl-C caused it.
    pub fn explained(&self, failure: Failure) -> Failure {
        if matches!(failure, Failure::Interrupted(_)) { self.failure() } else { failure }
    }

    fn message(&self) -> String {
        self.message.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn is_pressed(&self) -> bool {
        self.pressed.load(Ordering::Relaxed)
    }

    /// Ends the process if the work does not stop by itself.
    fn end_in_time(&self, console: Console) {
        let watched =
            Self { pressed: Arc::clone(&self.pressed), message: Arc::clone(&self.message) };
        let watch = move || {
            while !watched.is_pressed() {
                thread::sleep(PERIOD);
            }
            thread::sleep(GRACE);
            // A file that is being written at once is finished first.
            output::while_nothing_is_written(|| {
                console.failure(&watched.failure());
                // Threads of a driver may be running, so nothing is destroyed.
                low_level::exit(INTERRUPTED.into());
            });
        };
        // Without a thread, Ctrl-C waits for the next progress report.
        let _ = thread::Builder::new().name("interrupt".to_owned()).spawn(watch);
    }
}
