//! The limits of a frame's rays.

use glam::DVec3;
use sdfc_graph::March;
use sdfc_march::MethodParameter;

use super::error::ViewError;
use super::pose::Pose;
use super::values::{Bounds, stated};

/// Length of a ray in distances from eye to target, if neither scene nor bounds limit it.
const DEFAULT_DISTANCE: f64 = 200.0;
/// Factor by which a ray limited by the bounds goes past them, for the rounding of the bounds.
const DISTANCE_MARGIN: f64 = 1.01;

/// The length and precision of rays.
pub(super) struct Limits {
    pub(super) t_max: f64,
    pub(super) epsilon: f64,
    pub(super) tolerance: f64,
    pub(super) steps: u32,
}

impl Limits {
    pub(super) fn new(
        march: &March,
        pose: &Pose,
        bounds: Option<Bounds>,
    ) -> Result<Self, ViewError> {
        let reach = (pose.target - pose.eye).length();
        let steps = march.steps.unwrap_or(MethodParameter::Steps.default_value() as u32);
        if steps == 0 {
            return Err(ViewError::NotPositive("march's steps", 0.0));
        }
        Ok(Self {
            t_max: stated(march.distance, "march's distance")?
                .unwrap_or_else(|| derived_distance(pose.eye, reach, bounds)),
            epsilon: stated(march.epsilon, "march's epsilon")?
                .unwrap_or(MethodParameter::Epsilon.default_value() * reach),
            tolerance: stated(march.tolerance, "march's tolerance")?
                .unwrap_or(MethodParameter::Tolerance.default_value()),
            steps,
        })
    }
}

/// The distance to the farthest corner of the bounds, or their diagonal if that is longer, for
/// shadow rays, if they are finite and not empty.
fn derived_distance(eye: DVec3, reach: f64, bounds: Option<Bounds>) -> f64 {
    let farthest = bounds.map(|[lo, hi]| {
        let (lo, hi) = (DVec3::from(lo), DVec3::from(hi));
        let farthest = (lo - eye).abs().max((hi - eye).abs()).length();
        if lo.cmple(hi).all() { farthest.max((hi - lo).length()) } else { f64::NAN }
    });
    match farthest {
        Some(distance) if distance.is_finite() && distance > 0.0 => distance * DISTANCE_MARGIN,
        _ => reach * DEFAULT_DISTANCE,
    }
}
