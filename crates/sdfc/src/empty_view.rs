//! Says why a picture shows nothing of a scene.

use sdfc_graph::Camera;
use sdfc_graph::eval::{FrameValues, evaluate_frame};
use sdfc_render::PixelCounts;

use crate::scene::Scene;

const REMEDY: &str = "or leave out `camera(...)` to see the whole scene";

/// Returns why a whole picture by the scene's own camera shows nothing, or only the inside of a
/// solid. `None` for other pictures, and without a `camera(...)`, which sees the whole scene.
pub(crate) fn why_empty(
    scene: &Scene,
    values: &FrameValues,
    pixels: &PixelCounts,
) -> Option<String> {
    let program = scene.program();
    if program.is_planar() {
        return None;
    }
    let Camera { eye, .. } = program.settings.camera?;
    let [x, y, z, _] = *evaluate_frame(&program.graph, &[eye], values).first()?;
    if scene.field(values).ok()?.distance([x, y, z]) < 0.0 {
        return Some(format!("the camera is inside of a solid: move its `eye`, {REMEDY}"));
    }
    let is_empty = pixels.hit == 0 && pixels.capped == 0;
    is_empty.then(|| format!("no ray meets the scene: turn the camera by its `target`, {REMEDY}"))
}
