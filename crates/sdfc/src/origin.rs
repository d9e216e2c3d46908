//! A scene far from the origin is drawn about a place of its own.
//!
//! There f32 has few digits left for what is seen: at a million units its numbers are a sixteenth apart. So pictures of
//! such scenes have a program whose point is counted from what the camera looks at, and eye and lamps are counted from
//! there too, in f64. Texts for other engines, and all that asks for the field at a place, have the scene's own.

use sdfc_analyze::prepare_with;
use sdfc_graph::eval::evaluate_frame;
use sdfc_graph::{Camera, Program};

use crate::Scene;

/// A scene is drawn about a place of its own if what is seen is so many times nearer to the eye than the origin.
const TIMES_NEARER: f64 = 64.0;

impl Scene {
    /// The program that pictures are drawn by.
    pub fn drawn(&self) -> &Program {
        let rebased = self.rebased.get_or_init(|| {
            let origin = self.place_seen()?;
            prepare_with(&self.elaborated.scene, origin, self.writing)
                .ok()
                .map(|prepared| prepared.program)
        });
        rebased.as_ref().unwrap_or(&self.program)
    }

    /// What the camera looks at by default, if that is far from the origin.
    fn place_seen(&self) -> Option<[f64; 3]> {
        let frame = self.defaults();
        let (place, reach) = match &self.program.settings.camera {
            Some(Camera { eye, target, .. }) => {
                let values = evaluate_frame(&self.program.graph, &[*eye, *target], &frame);
                let [eye, target, ..] = values[..] else { return None };
                ([target[0], target[1], target[2]], distance([eye[0], eye[1], eye[2]], target))
            }
            None => {
                let [lo, hi] = self.bounds_at(&frame)?;
                let middle = [0, 1, 2].map(|axis| 0.5 * (lo[axis] + hi[axis]));
                (middle, distance(lo, [hi[0], hi[1], hi[2], 0.0]))
            }
        };
        let farthest = place.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let known = place.iter().all(|x| x.is_finite()) && reach.is_finite();
        (known && farthest > TIMES_NEARER * reach).then_some(place)
    }
}

fn distance(a: [f64; 3], b: [f64; 4]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}
