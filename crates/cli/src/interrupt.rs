//! Ctrl-C: the first ends the work at the next tile, the second at once.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::SIGINT;
use signal_hook::flag;

/// Whether ctrl-C has been pressed.
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Watches from now on. Where the system refuses, ctrl-C ends the process as it always does.
    pub fn watch() -> Self {
        let pressed = Arc::new(AtomicBool::new(false));
        // In this order: the second one finds the flag set.
        let _ = flag::register_conditional_shutdown(SIGINT, 130, Arc::clone(&pressed));
        let _ = flag::register(SIGINT, Arc::clone(&pressed));
        Self(pressed)
    }

    /// Whether to go on.
    pub fn flow(&self) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
