//! Ctrl-C: the first one stops the work after the current tile, the second one at once.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::SIGINT;
use signal_hook::flag;

/// Tells if Ctrl-C has been pressed.
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Handles Ctrl-C from now on. If the system refuses, Ctrl-C ends the process as usual.
    pub fn watch() -> Self {
        let pressed = Arc::new(AtomicBool::new(false));
        // The order matters: the handlers run in it, and the first must find the flag unset once.
        let _ = flag::register_conditional_shutdown(SIGINT, 130, Arc::clone(&pressed));
        let _ = flag::register(SIGINT, Arc::clone(&pressed));
        Self(pressed)
    }

    /// `Break` after Ctrl-C.
    pub fn flow(&self) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
