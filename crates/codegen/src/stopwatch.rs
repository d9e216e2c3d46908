//! A clock, where there is one.

use std::time::Duration;

/// Measures how long something takes. In WebAssembly there is no clock, and nothing takes any time.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    #[cfg(not(target_family = "wasm"))]
    start: std::time::Instant,
}

impl Stopwatch {
    /// Begins to measure.
    pub fn start() -> Self {
        Self {
            #[cfg(not(target_family = "wasm"))]
            start: std::time::Instant::now(),
        }
    }

    /// Time since then.
    pub fn elapsed(self) -> Duration {
        #[cfg(not(target_family = "wasm"))]
        return self.start.elapsed();
        #[cfg(target_family = "wasm")]
        return Duration::ZERO;
    }

    /// The same in milliseconds.
    pub fn milliseconds(self) -> f64 {
        self.elapsed().as_secs_f64() * 1e3
    }
}
