//! Lines over the picture: the scene's bounds.

use eframe::egui::{Pos2, Rect, Stroke, Ui, vec2};
use glam::DVec3;
use sdfc_render::Pose;

use super::theme;
use crate::render::picture::RenderRequest;

/// The near plane at which lines are clipped, as a fraction of the distance to the target.
const NEAR_PLANE: f64 = 1e-3;

/// Draws the bounds over a picture that fills the rectangle, with the picture's camera.
pub fn show(ui: &Ui, rect: Rect, request: &RenderRequest) {
    if let Some(bounds) = request.model.scene.bounds_at(&request.frame) {
        bounding_box(ui, rect, &request.pose, bounds);
    }
}

/// The twelve edges of a box, without those of infinite length.
fn bounding_box(ui: &Ui, rect: Rect, pose: &Pose, bounds: [[f64; 3]; 2]) {
    let stroke = Stroke::new(1.0, theme::of(ui).accent);
    let corner = |index: usize| DVec3::from([0, 1, 2].map(|axis| bounds[index >> axis & 1][axis]));
    for (from, axis) in (0..8_usize).flat_map(|from| (0..3_usize).map(move |axis| (from, axis))) {
        let (start, end) = (corner(from), corner(from | 1 << axis));
        if from >> axis & 1 == 0
            && let Some(line) = project_line(pose, rect, start, end)
        {
            ui.painter().with_clip_rect(rect).line_segment(line, stroke);
        }
    }
}

/// A line in screen coordinates; `None` if it is behind the camera or infinite.
pub(super) fn project_line(pose: &Pose, rect: Rect, start: DVec3, end: DVec3) -> Option<[Pos2; 2]> {
    let [right, up, forward] = pose.basis();
    let [mut start, mut end] = [start, end].map(|point| point - pose.eye);
    if !start.is_finite() || !end.is_finite() {
        return None;
    }
    let depth = |point: DVec3| if pose.parallel { 1.0 } else { point.dot(forward) };
    let nearest = NEAR_PLANE * (pose.target - pose.eye).length();
    let clip = |behind: DVec3, ahead: DVec3| {
        let fraction = (nearest - depth(behind)) / (depth(ahead) - depth(behind));
        behind + (ahead - behind) * fraction
    };
    match [start, end].map(|point| !pose.parallel && depth(point) < nearest) {
        [true, true] => return None,
        [true, false] => start = clip(start, end),
        [false, true] => end = clip(end, start),
        [false, false] => {}
    }
    let half = f64::from(rect.height()) / 2.0;
    let project = |point: DVec3| {
        let scale = half / (pose.half_height * depth(point));
        let [x, y] = [right, up].map(|axis| (point.dot(axis) * scale) as f32);
        rect.center() + vec2(x, -y)
    };
    Some([start, end].map(project))
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    fn pose(parallel: bool) -> Pose {
        let (eye, target, up) = (DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, DVec3::Y);
        Pose { eye, target, up, parallel, half_height: if parallel { 2.5 } else { 0.5 } }
    }

    #[test]
    fn lines_are_projected_and_clipped_at_the_camera() {
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(300.0, 200.0));
        for parallel in [false, true] {
            let pose = pose(parallel);
            let line = project_line(&pose, rect, DVec3::ZERO, DVec3::new(1.25, 2.5, 0.0));
            assert_eq!(line, Some([pos2(160.0, 120.0), pos2(210.0, 20.0)]));
            assert_eq!(project_line(&pose, rect, DVec3::ZERO, DVec3::INFINITY), None);
        }
        // A line to a point behind the camera leaves the picture at the top.
        let behind = DVec3::new(0.0, 1.0, 9.0);
        let [_, end] = project_line(&pose(false), rect, DVec3::ZERO, behind).unwrap();
        assert!(end.y < rect.top() && end.is_finite(), "{end}");
        assert_eq!(project_line(&pose(false), rect, behind, behind * 2.0), None);
    }
}
