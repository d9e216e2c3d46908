//! Checks `intersect` and `copies`: in both precisions rays are inside where `intersect` says so,
//! and they hit nothing but the sampled copies where `copies` says so.

use sdfc::FrameValues;
use sdfc_analyze::{copies_obstacle, refute_copies, refute_intersect};
use sdfc_graph::{Scene, ShapeId};

/// Relative error that is allowed in the ends of intervals, for f64 and f32.
const ROUNDING: [f64; 2] = [1e-8, 4e-6];

/// Returns a ray that refutes the shape's `intersect`.
pub fn fault(scene: &Scene, id: ShapeId) -> Option<String> {
    let frame = FrameValues::defaults(&scene.params);
    let double =
        refute_intersect::<f64>(scene, id, &frame, ROUNDING[0]).map(|fault| ("f64", fault));
    let fault = double.or_else(|| {
        refute_intersect::<f32>(scene, id, &frame, ROUNDING[1]).map(|fault| ("f32", fault))
    });
    fault.map(|(number, fault)| format!("hits in {number}: {fault:?}"))
}

/// A mutant of `copies`.
pub const FARTHER: &str = "copies said of balls a quarter larger";

/// Returns a point that refutes the shape's `copies`, with balls `farther` times as large, or the
/// reason why the clause has no effect.
pub fn copies_fault(scene: &Scene, id: ShapeId, farther: f64) -> Option<String> {
    let idle = copies_obstacle(&scene.graph, id);
    let fault = refute_copies(scene, id, &FrameValues::defaults(&scene.params), farther);
    let idle = idle.map(|reason| format!("copies does nothing: {reason:?}"));
    idle.or_else(|| fault.map(|fault| format!("copies: {fault:?}")))
}
