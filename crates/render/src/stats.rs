//! The metrics of one rendering, as `render --stats` prints them.
//!
//! The keys are stable: new ones may be added, none is renamed. A metric that is not available is
//! null, and `why` of the object that contains it holds the reason under the metric's key.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::clock::FrameTimes;
use crate::frame::Frame;
use crate::image::{Image, PixelCounts};

/// The description of an adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterInfo {
    /// Its name.
    pub name: String,
    /// Its driver, with the version.
    pub driver: String,
    /// `vulkan`, `metal` or `dx12`.
    pub backend: String,
    /// True if it is a software adapter.
    pub software: bool,
}

/// Reasons for missing metrics, by their keys.
pub type Why = BTreeMap<&'static str, String>;

/// The metrics of one rendering.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stats {
    /// Name of the adapter; null on the CPU.
    pub adapter: Option<String>,
    /// Name and version of its driver; null on the CPU.
    pub driver: Option<String>,
    /// `vulkan`, `metal`, `dx12` or `cpu`.
    pub backend: String,
    /// Ray method.
    pub method: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The time of one frame without compilation.
    pub frame_ms: FrameTimes,
    /// The time of each stage of compilation.
    pub compile_ms: CompileTimes,
    /// The time from reading the scene to the first finished picture, in milliseconds.
    pub first_picture_ms: Option<f64>,
    /// Evaluations of the field, shadow rays included.
    pub evals_per_pixel: EvaluationCounts,
    /// Evaluations of primitives.
    pub leaf_evals_per_pixel: LeafEvaluations,
    /// The numbers of rays by how they ended.
    pub pixels: PixelCounts,
    /// Why metrics of this object are null, why the method is not the requested one, and why pixels
    /// are unproven.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub why: Why,
}

impl Stats {
    /// The metrics of a frame that was drawn in the given times by an adapter, or on the CPU
    /// without one. The renderer does not know `first_picture_ms` and primitives; they are null
    /// until the caller sets them.
    pub fn new(
        frame: &Frame,
        frame_ms: FrameTimes,
        adapter: Option<&AdapterInfo>,
        method: &str,
        compile_ms: CompileTimes,
    ) -> Self {
        let unmeasured = |key| (key, "not measured".to_owned());
        let mut why = Why::from([unmeasured("first_picture_ms")]);
        if adapter.is_none() {
            why.extend(["adapter", "driver"].map(|key| (key, "drawn on the CPU".to_owned())));
        }
        Self {
            adapter: adapter.map(|info| info.name.clone()),
            driver: adapter.map(|info| info.driver.clone()),
            backend: adapter.map_or_else(|| "cpu".to_owned(), |info| info.backend.clone()),
            method: method.to_owned(),
            size: frame.image.size(),
            frame_ms,
            compile_ms,
            first_picture_ms: None,
            evals_per_pixel: EvaluationCounts::of(&frame.image),
            leaf_evals_per_pixel: LeafEvaluations::unknown("not counted"),
            pixels: frame.image.counts(),
            why,
        }
    }

    /// Sets the time to the first picture, in milliseconds.
    pub fn set_first_picture(&mut self, milliseconds: f64) {
        self.first_picture_ms = Some(milliseconds);
        self.why.remove("first_picture_ms");
    }

    /// Sets the evaluations of primitives for a scene that evaluates all of its `leaves` each time.
    pub fn set_leaves(&mut self, leaves: usize) {
        self.leaf_evals_per_pixel = LeafEvaluations::of_all_leaves(self.evals_per_pixel, leaves);
    }
}

/// Times of the stages of compilation, in milliseconds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CompileTimes {
    /// Reading, parsing, elaborating.
    pub front: Option<f64>,
    /// Analyses and passes.
    pub analyze: Option<f64>,
    /// Lowering to the shader module and linking.
    pub lower: Option<f64>,
    /// Validating the module.
    pub validate: Option<f64>,
    /// Creating the pipeline, and a first dispatch of one workgroup, in which software drivers
    /// compile.
    pub pipeline: Option<f64>,
    /// Why metrics of this object are null.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub why: Why,
}

/// Evaluations of the field over the pixels of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EvaluationCounts {
    /// Mean.
    pub mean: f64,
    /// The 99th percentile.
    pub p99: u32,
    /// The maximum.
    pub max: u32,
}

impl EvaluationCounts {
    /// Counts the evaluations of a picture.
    pub fn of(image: &Image) -> Self {
        let mut counts: Vec<u32> = image.pixels().iter().map(|pixel| pixel.evaluations).collect();
        let sum: u64 = counts.iter().map(|count| u64::from(*count)).sum();
        let max = counts.iter().copied().max().unwrap_or(0);
        let rank = (counts.len() * 99).div_ceil(100).saturating_sub(1);
        let p99 = match counts.get(rank) {
            Some(_) => *counts.select_nth_unstable(rank).1,
            None => 0,
        };
        Self { mean: sum as f64 / counts.len().max(1) as f64, p99, max }
    }
}

/// Evaluations of primitives over the pixels of a picture.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LeafEvaluations {
    /// Mean.
    pub mean: Option<f64>,
    /// Why `mean` is null.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub why: Why,
}

impl LeafEvaluations {
    /// For a scene in which each evaluation of the field evaluates all of its `leaves`.
    pub fn of_all_leaves(evaluations: EvaluationCounts, leaves: usize) -> Self {
        Self { mean: Some(evaluations.mean * leaves as f64), why: Why::new() }
    }

    /// The evaluations were not counted.
    pub fn unknown(why: &str) -> Self {
        Self { mean: None, why: Why::from([("mean", why.to_owned())]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::Clock;
    use crate::view::footprint::Footprint;

    #[test]
    fn evaluations_of_a_hundred_pixels() {
        let mut image = Image::new([10, 10], Footprint::default()).unwrap();
        for (index, pixel) in image.pixels_mut().iter_mut().enumerate() {
            pixel.evaluations = 100 - index as u32;
        }
        let counts = EvaluationCounts::of(&image);
        assert_eq!(counts, EvaluationCounts { mean: 50.5, p99: 99, max: 100 });
        let one = EvaluationCounts::of(&Image::new([1, 1], Footprint::default()).unwrap());
        assert_eq!(one, EvaluationCounts { mean: 0.0, p99: 0, max: 0 });
    }

    #[test]
    fn keys_are_those_that_tools_read() {
        let mut image = Image::new([2, 1], Footprint::default()).unwrap();
        image.pixels_mut()[0].status = crate::HIT;
        image.pixels_mut()[0].evaluations = 9;
        image.pixels_mut()[1].evaluations = 6;
        let frame = Frame {
            image,
            milliseconds: 2.0,
            clock: Clock::Wall,
            tiles: 1,
            culling_evaluations: 0,
        };
        let times = FrameTimes::of(&[frame.milliseconds], frame.clock).unwrap();
        let compile_ms = CompileTimes {
            front: Some(1.0),
            why: Why::from([("pipeline", "drawn on the CPU".to_owned())]),
            ..CompileTimes::default()
        };
        let mut stats = Stats::new(&frame, times, None, "sphere", compile_ms);
        let expected = serde_json::json!({
            "adapter": null, "driver": null, "backend": "cpu", "method": "sphere", "size": [2, 1],
            "frame_ms": {"median": 2.0, "min": 2.0, "max": 2.0, "n": 1, "clock": "wall"},
            "compile_ms": {
                "front": 1.0, "analyze": null, "lower": null, "validate": null, "pipeline": null,
                "why": {"pipeline": "drawn on the CPU"},
            },
            "first_picture_ms": null,
            "evals_per_pixel": {"mean": 7.5, "p99": 9, "max": 9},
            "leaf_evals_per_pixel": {"mean": null, "why": {"mean": "not counted"}},
            "pixels": {"hit": 1, "miss": 1, "capped": 0, "nan": 0, "unproven": 0, "loops_ended": 0},
            "why": {
                "adapter": "drawn on the CPU", "driver": "drawn on the CPU",
                "first_picture_ms": "not measured",
            },
        });
        assert_eq!(serde_json::to_value(&stats).unwrap(), expected);

        stats.set_first_picture(3.5);
        stats.set_leaves(2);
        let value = serde_json::to_value(&stats).unwrap();
        assert_eq!(value["first_picture_ms"], 3.5);
        assert_eq!(value["why"].get("first_picture_ms"), None);
        assert_eq!(value["leaf_evals_per_pixel"], serde_json::json!({"mean": 15.0}));
    }
}
