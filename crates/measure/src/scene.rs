//! The hits of a view's rays with a scene, found by the oracle.

use std::sync::atomic::{AtomicUsize, Ordering};

use sdfc::{Error, Scene};
use sdfc_analyze::cost;
use sdfc_graph::NodeId;
use sdfc_graph::eval::FrameValues;
use sdfc_march::stubs;
use sdfc_render::{Progress, View};

use crate::camera::Camera;
use crate::oracle::{Oracle, OracleError};
use crate::store::TruthStore;
use crate::truth::Truth;

/// How the oracle is asked.
#[derive(Clone, Copy)]
pub struct OracleOptions<'a> {
    /// Called with the number of finished pixels, from any thread. It cannot cancel.
    pub progress: &'a (dyn Fn(Progress) + Sync),
    /// Storage of truths between runs. With `None` the oracle computes every pixel again.
    pub store: Option<&'a dyn TruthStore>,
}

impl Default for OracleOptions<'_> {
    /// No store and no progress reports.
    fn default() -> Self {
        Self { progress: &|_| (), store: None }
    }
}

/// Returns the oracle for the scene's field.
///
/// # Errors
///
/// [`Error::NothingDrawn`], [`Error::Planar`], [`Error::Evaluate`].
pub fn oracle(scene: &Scene) -> Result<Oracle, Error> {
    scene.needs_solids("the oracle")?;
    Oracle::new(scene.drawn()).map_err(|error| match error {
        OracleError::NothingDrawn => Error::NothingDrawn,
        OracleError::NotFlat(error) => Error::Evaluate(error),
    })
}

/// Returns the oracle's verdict on every pixel of a view of the scene.
///
/// # Errors
///
/// [`Error::NothingDrawn`], [`Error::Evaluate`].
pub fn truth(
    scene: &Scene,
    view: &View,
    frame: &FrameValues,
    options: OracleOptions<'_>,
) -> Result<Truth, Error> {
    let camera = Camera::of(view);
    let (total, done) = (camera.pixels() as u64, AtomicUsize::new(0));
    let report = |pixels| {
        let done = done.fetch_add(pixels, Ordering::Relaxed) + pixels;
        (options.progress)(Progress { done: done as u64, total });
    };
    let oracle = oracle(scene)?;
    Ok(match options.store {
        Some(store) => Truth::load_or_find(store, &oracle, frame, camera, &report),
        None => Truth::find(&oracle, frame, camera, &report),
    })
}

/// Returns the number of operations that `evaluations` evaluations take, as a method marches the
/// field.
///
/// For a method that bounds the field along segments of a ray, an evaluation is the field and these
/// bounds; operations that they share count once. If the method pre-intersects, the first
/// evaluation is that, and the others are of the marched part.
pub fn operations(scene: &Scene, marched: &sdfc::Marched<'_>, evaluations: f64) -> f64 {
    let method = marched.method.definition();
    let program = &marched.program;
    let bounds = [(stubs::RANGE, program.range), (stubs::SLOPE_RANGE, program.slope_range)];
    let called = bounds.into_iter().filter(|(stub, _)| method.calls(stub));
    let called: Vec<NodeId> = called.filter_map(|bound| bound.1).collect();
    if called.is_empty() {
        return scene.report().operations_per_ray(evaluations, method.pre_intersects);
    }
    let field = if method.pre_intersects { program.marched_field() } else { program.distance };
    let roots: Vec<NodeId> = field.into_iter().chain(called).collect();
    let step = cost(&program.graph, &roots).operations as f64;
    match scene.report().ray_cost.operations as f64 {
        first if method.pre_intersects && first > 0.0 => {
            first + (evaluations - 1.0).max(0.0) * step
        }
        _ => evaluations * step,
    }
}
