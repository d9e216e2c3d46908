//! Comparison jobs and their results.

use std::sync::Arc;

use sdfc::{FrameValues, Method};
use sdfc_measure::{Counts, Metrics};
use sdfc_render::Pose;

use crate::scene::model::Model;

/// The most pixels that are compared. A proof of a ray takes far longer than marching it.
const MAX_PIXELS: f64 = 24_000.0;

/// A picture to compare with the oracle.
#[derive(Clone, Debug)]
pub struct ComparisonJob {
    /// The scene.
    pub model: Arc<Model>,
    /// Param values and time.
    pub frame: FrameValues,
    /// The camera.
    pub pose: Pose,
    /// Width and height of the shown picture in pixels.
    pub size: [u32; 2],
    /// The ray method's parameter as a multiple of the scene's.
    pub tolerance: f64,
    /// True if every ray method is compared, not only the one that draws.
    pub all_methods: bool,
}

impl ComparisonJob {
    /// Returns true if `other` shows the same scene from the same camera, whatever draws it. The
    /// oracle's answer is then the same.
    pub fn has_same_oracle(&self, other: &Self) -> bool {
        self.model.content_id == other.model.content_id
            && self.size == other.size
            && self.pose == other.pose
            && self.frame == other.frame
    }

    /// Returns true if `other` marches the same rays in the same way.
    pub fn has_same_picture(&self, other: &Self) -> bool {
        self.has_same_oracle(other)
            && self.model.serial == other.model.serial
            && self.tolerance == other.tolerance
    }

    /// Width and height at which the picture is compared: the same aspect ratio with at most
    /// `MAX_PIXELS`.
    pub fn compared_size(&self) -> [u32; 2] {
        let [width, height] = self.size.map(f64::from);
        let scale = (MAX_PIXELS / (width * height).max(1.0)).sqrt().min(1.0);
        [width, height].map(|side| ((side * scale).round() as u32).max(1))
    }
}

/// The errors and cost of a ray method at one setting.
#[derive(Clone, Debug)]
pub struct MethodResult {
    /// The method's name.
    pub method: Method,
    /// The method's parameter as a multiple of the scene's.
    pub setting: f64,
    /// The errors.
    pub metrics: Metrics,
    /// Operations of the field's formula per pixel.
    pub operations: f64,
    /// Milliseconds to draw the compared picture.
    pub milliseconds: f64,
}

impl MethodResult {
    /// The number of pixels that are wrong or whose ray ran out of steps.
    pub fn failed(&self) -> u64 {
        let metrics = &self.metrics;
        metrics.missed + metrics.false_hits + metrics.nan + metrics.capped
    }

    /// Returns true if it is at least as good in cost and errors, and better in one of them.
    fn beats(&self, other: &Self) -> bool {
        let criteria = |of: &Self| [of.operations, of.failed() as f64, of.metrics.depth.pixels.p99];
        let (mine, others) = (criteria(self), criteria(other));
        mine != others && mine.iter().zip(&others).all(|(a, b)| a <= b)
    }
}

/// The result of a comparison, so far.
#[derive(Clone, Debug)]
pub struct ComparisonResult {
    /// The job.
    pub job: Arc<ComparisonJob>,
    /// Width and height that were compared.
    pub size: [u32; 2],
    /// The oracle's counts of rays that hit, miss, pass an edge or are undecided.
    pub counts: Counts,
    /// The result of the shown picture.
    pub shown: MethodResult,
    /// The results of all methods and settings drawn so far.
    pub all: Vec<MethodResult>,
    /// Methods that could not draw the scene, each with the reason.
    pub refused: Vec<String>,
    /// Milliseconds since the job was received.
    pub milliseconds: f64,
    /// True if no further results follow.
    pub finished: bool,
}

impl ComparisonResult {
    /// Returns true if no other result of [`Self::all`] is better in both cost and errors.
    pub fn is_pareto_optimal(&self, result: &MethodResult) -> bool {
        !self.all.iter().any(|other| other.beats(result))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_is_beaten_by_one_that_is_nowhere_worse() {
        let result = |operations, p99| {
            let mut metrics = Metrics::default();
            metrics.depth.pixels.p99 = p99;
            let method = Method::Auto;
            MethodResult { method, setting: 1.0, metrics, operations, milliseconds: 0.0 }
        };
        let (cheap, dear, worse) = (result(1.0, 0.5), result(9.0, 0.1), result(9.0, 0.2));
        assert!(dear.beats(&worse) && !worse.beats(&dear));
        assert!(!cheap.beats(&dear) && !dear.beats(&cheap) && !dear.beats(&dear));
    }
}
