//! Progress of long work, reported to the calling program.

use std::ffi::{c_int, c_void};
use std::ops::ControlFlow;

/// Callback that receives how far a call is: `done` of `total` units of its current step. It runs
/// in the thread of the call, and returns 0 to go on. Any other value stops the work, and the call
/// fails with `SDFC_STATUS_STOPPED`. `context` is the pointer that was passed to the call.
pub type Progress =
    Option<unsafe extern "C" fn(context: *mut c_void, done: u64, total: u64) -> c_int>;

/// The progress callback of a call.
pub(crate) struct Reporter {
    progress: Progress,
    context: *mut c_void,
}

impl Reporter {
    /// Creates the reporter for a callback.
    ///
    /// # Safety
    ///
    /// `progress` may be called with `context` as long as the reporter lives.
    pub(crate) unsafe fn new(progress: Progress, context: *mut c_void) -> Self {
        Self { progress, context }
    }

    /// Calls the callback.
    pub(crate) fn report(&self, done: u64, total: u64) -> ControlFlow<()> {
        let Some(progress) = self.progress else { return ControlFlow::Continue(()) };
        // SAFETY: guaranteed by the caller of `new`.
        let answer = unsafe { progress(self.context, done, total) };
        if answer == 0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}
