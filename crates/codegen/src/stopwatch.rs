//! A clock that also compiles where there is none.

use std::time::Duration;

/// Measures elapsed time. In WebAssembly there is no clock, and all times are 0.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    #[cfg(not(target_family = "wasm"))]
    start: std::time::Instant,
}

impl Stopwatch {
    /// Starts measuring.
    pub fn start() -> Self {
        Self {
            #[cfg(not(target_family = "wasm"))]
            start: std::time::Instant::now(),
        }
    }

    /// Time since the start.
    pub fn elapsed(self) -> Duration {
        #[cfg(not(target_family = "wasm"))]
        return self.start.elapsed();
        #[cfg(target_family = "wasm")]
        return Duration::ZERO;
    }

    /// Time since the start, in milliseconds.
    pub fn milliseconds(self) -> f64 {
        self.elapsed().as_secs_f64() * 1e3
    }
}
