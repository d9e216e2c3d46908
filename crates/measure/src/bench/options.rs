//! Options of a benchmark.

use sdfc::Method;

/// Options of [`bench()`](crate::bench).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BenchOptions {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Number of timed frames per variant, after one that is not timed; at least 1. Only one if
    /// frames take longer than ten seconds.
    pub repetitions: u32,
    /// Ray method of all variants.
    pub method: Method,
    /// True if interpreters and live literals are measured too. Then all variants draw without
    /// materials and take normals by differences, as interpreters must; otherwise each draws the
    /// picture of `sdfc render`.
    pub baselines: bool,
}

impl BenchOptions {
    /// The default options: 640 by 360 pixels, five frames, the method `sphere`, with baselines.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets width and height in pixels.
    #[must_use]
    pub fn size(self, size: [u32; 2]) -> Self {
        Self { size, ..self }
    }

    /// Sets the number of timed frames.
    #[must_use]
    pub fn repetitions(self, repetitions: u32) -> Self {
        Self { repetitions, ..self }
    }

    /// Sets if interpreters and live literals are measured too.
    #[must_use]
    pub fn baselines(self, baselines: bool) -> Self {
        Self { baselines, ..self }
    }
}

impl Default for BenchOptions {
    /// As [`BenchOptions::new`]; `sphere` is the method of the op-unit interpreter.
    fn default() -> Self {
        Self { size: [640, 360], repetitions: 5, method: Method::Sphere, baselines: true }
    }
}
