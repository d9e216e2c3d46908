//! Whether rays are inside where an entry's `hits` says so, in both precisions.

use sdfc::FrameValues;
use sdfc::graph::{Scene, ShapeId};
use sdfc_analyze::refute_hits;

/// What the intervals may be off, in parts of the lengths that they are computed from.
const ROUNDING: [f64; 2] = [1e-8, 4e-6];

/// A ray that refutes what a shape states of rays.
pub fn fault(scene: &Scene, id: ShapeId) -> Option<String> {
    let frame = FrameValues::defaults(&scene.params);
    let double = refute_hits::<f64>(scene, id, &frame, ROUNDING[0]).map(|fault| ("f64", fault));
    let fault = double
        .or_else(|| refute_hits::<f32>(scene, id, &frame, ROUNDING[1]).map(|fault| ("f32", fault)));
    fault.map(|(number, fault)| format!("hits in {number}: {fault:?}"))
}
