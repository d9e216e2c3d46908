//! Moves the origin of scenes that lie far from it, before they are drawn.
//!
//! Far from the origin f32 has few digits left for details: at a million units, neighbouring
//! numbers are 1/16 apart. Pictures of such scenes use a program whose origin is what the camera
//! looks at; the eye and the lights are given relative to it, computed in f64. Shaders for other
//! engines and evaluations of the field keep the scene's own coordinates.

use sdfc_analyze::prepare_with;
use sdfc_graph::eval::evaluate_frame;
use sdfc_graph::{Camera, Program};

use crate::scene::Scene;

/// The origin is moved if the target is this many times nearer to the eye than to the origin.
const TIMES_NEARER: f64 = 64.0;

impl Scene {
    /// The program that pictures are drawn with.
    pub fn drawn(&self) -> &Program {
        let rebased = self.rebased.get_or_init(|| {
            let origin = self.camera_target()?;
            prepare_with(&self.elaborated.scene, origin, self.loops)
                .ok()
                .map(|prepared| prepared.program)
        });
        rebased.as_ref().unwrap_or(&self.program)
    }

    /// Returns the default target of the camera, if it is far from the origin.
    fn camera_target(&self) -> Option<[f64; 3]> {
        let frame = self.defaults();
        let (target, extent) = match &self.program.settings.camera {
            Some(Camera { eye, target, .. }) => {
                let values = evaluate_frame(&self.program.graph, &[*eye, *target], &frame);
                let [eye, target, ..] = values[..] else { return None };
                ([target[0], target[1], target[2]], distance([eye[0], eye[1], eye[2]], target))
            }
            None => {
                let [lo, hi] = self.focus_at(&frame)?;
                let middle = [0, 1, 2].map(|axis| 0.5 * (lo[axis] + hi[axis]));
                (middle, distance(lo, [hi[0], hi[1], hi[2], 0.0]))
            }
        };
        let farthest = target.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let known = target.iter().all(|x| x.is_finite()) && extent.is_finite();
        (known && farthest > TIMES_NEARER * extent).then_some(target)
    }
}

fn distance(a: [f64; 3], b: [f64; 4]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}
