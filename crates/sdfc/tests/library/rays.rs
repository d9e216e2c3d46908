//! Whether rays are inside where an entry's `intersect` says so, in both precisions, and whether they meet nothing else than copies where
//! `copies` says so.

use sdfc::FrameValues;
use sdfc_analyze::{copies_obstacle, refute_copies, refute_intersect};
use sdfc_graph::{Scene, ShapeId};

/// What the intervals may be off, in parts of the lengths that they are computed from.
const ROUNDING: [f64; 2] = [1e-8, 4e-6];

/// A ray that refutes what a shape states of rays.
pub fn fault(scene: &Scene, id: ShapeId) -> Option<String> {
    let frame = FrameValues::defaults(&scene.params);
    let double =
        refute_intersect::<f64>(scene, id, &frame, ROUNDING[0]).map(|fault| ("f64", fault));
    let fault = double.or_else(|| {
        refute_intersect::<f32>(scene, id, &frame, ROUNDING[1]).map(|fault| ("f32", fault))
    });
    fault.map(|(number, fault)| format!("hits in {number}: {fault:?}"))
}

/// A faulty `copies`.
pub const FARTHER: &str = "copies said of balls a quarter larger";

/// A point that refutes what a shape states of its copies, if it said so of balls `farther` times as large; or why the clause is none.
pub fn copies_fault(scene: &Scene, id: ShapeId, farther: f64) -> Option<String> {
    let idle = copies_obstacle(&scene.graph, id);
    let fault = refute_copies(scene, id, &FrameValues::defaults(&scene.params), farther);
    let idle = idle.map(|reason| format!("copies does nothing: {reason:?}"));
    idle.or_else(|| fault.map(|fault| format!("copies: {fault:?}")))
}
