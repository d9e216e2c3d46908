//! The results of a benchmark.

use sdfc_render::{CompileTimes, EvaluationCounts, FrameTimes, LeafEvaluations, Why};
use serde::Serialize;

/// The results, as `bench --json` writes them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchReport {
    /// Name of the GPU.
    pub adapter: String,
    /// Name and version of its driver.
    pub driver: String,
    /// One for each scene.
    pub rows: Vec<BenchRow>,
}

/// All variants of one scene; they share everything but the field.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchRow {
    /// Name of the scene.
    pub scene: String,
    /// Leaves of the scene.
    pub leaves: usize,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Ray method.
    pub method: String,
    /// The variant that `sdfc render` uses by default.
    pub auto: &'static str,
    /// Its frame time relative to the fastest variant (CPU time where measured).
    pub auto_times_best_frame: Option<f64>,
    /// Its time to the first picture relative to the fastest variant.
    pub auto_times_best_first_picture: Option<f64>,
    /// One for each way to evaluate the field.
    pub variants: Vec<BenchVariant>,
}

/// One way to evaluate the field. A value that is not available is null, with the reason in `why`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchVariant {
    /// `units`, `tape`, `specialized`, `live-literals`, `loops` or `culled`.
    pub name: &'static str,
    /// Time of one frame without compilation.
    pub frame_ms: Option<FrameTimes>,
    /// Median frame time relative to `specialized`.
    pub times_specialized: Option<f64>,
    /// Median CPU time of this process per frame, for a software GPU. Other processes do not count.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cpu_ms: Option<f64>,
    /// CPU time relative to `specialized`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cpu_times_specialized: Option<f64>,
    /// Stages of compilation; encoding the tables is part of `lower`.
    pub compile_ms: Option<CompileTimes>,
    /// From reading the scene to its first finished picture, in milliseconds.
    pub first_picture_ms: Option<f64>,
    /// Field evaluations, including shadows, without normals.
    pub evals_per_pixel: Option<EvaluationCounts>,
    /// Evaluations of leaves.
    pub leaf_evals_per_pixel: Option<LeafEvaluations>,
    /// Iterations of the interpreter's loop per evaluation; null without an interpreter.
    pub iterations_per_eval: Option<usize>,
    /// Number of live literals, for `live-literals` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub live_literals: Option<usize>,
    /// Pixels that differ from those of `specialized`, without edges.
    pub differing_pixels: Option<usize>,
    /// Why values are null, by their keys.
    #[serde(skip_serializing_if = "Why::is_empty")]
    pub why: Why,
}

impl BenchVariant {
    /// Returns a variant without results, for one reason.
    pub(super) fn missing(name: &'static str, reason: &str) -> Self {
        let keys = [
            "frame_ms",
            "times_specialized",
            "compile_ms",
            "first_picture_ms",
            "evals_per_pixel",
            "leaf_evals_per_pixel",
            "iterations_per_eval",
            "differing_pixels",
        ];
        Self {
            name,
            frame_ms: None,
            times_specialized: None,
            cpu_ms: None,
            cpu_times_specialized: None,
            compile_ms: None,
            first_picture_ms: None,
            evals_per_pixel: None,
            leaf_evals_per_pixel: None,
            iterations_per_eval: None,
            live_literals: None,
            differing_pixels: None,
            why: keys.map(|key| (key, reason.to_owned())).into(),
        }
    }

    /// Removes meaningless results.
    pub(super) fn refuse(&mut self, reason: &str) {
        (self.frame_ms, self.times_specialized, self.first_picture_ms) = (None, None, None);
        (self.cpu_ms, self.cpu_times_specialized) = (None, None);
        (self.evals_per_pixel, self.leaf_evals_per_pixel) = (None, None);
        for key in [
            "frame_ms",
            "times_specialized",
            "first_picture_ms",
            "evals_per_pixel",
            "leaf_evals_per_pixel",
        ] {
            self.why.insert(key, reason.to_owned());
        }
    }
}

/// Returns a metric of a variant relative to the smallest of all variants.
pub(super) fn times_best(
    variants: &[BenchVariant],
    name: &str,
    metric: impl Fn(&BenchVariant) -> Option<f64>,
) -> Option<f64> {
    let own = metric(variants.iter().find(|variant| variant.name == name)?)?;
    let best = variants.iter().filter_map(&metric).reduce(f64::min)?;
    Some(own / best)
}
