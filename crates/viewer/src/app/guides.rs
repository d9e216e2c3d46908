//! Lines over the picture: where the axes point, and what the scene lies in.

use eframe::egui::{self, Color32, Pos2, Rect, Stroke, Ui, vec2};
use glam::DVec3;
use sdfc::render::Pose;

use super::style;
use crate::painter::Picture;

/// Of the arms of the axes, in points.
const ARM: f32 = 26.0;
/// Lines end before the eye, in distances to what is in the middle of the picture.
const NEAREST: f64 = 1e-3;
/// Each with its name.
const AXES: [(DVec3, &str, Color32); 3] = [
    (DVec3::X, "x", Color32::from_rgb(230, 90, 80)),
    (DVec3::Y, "y", Color32::from_rgb(110, 190, 80)),
    (DVec3::Z, "z", Color32::from_rgb(90, 140, 240)),
];

/// Draws them over a picture that fills the rectangle, as its camera sees them.
pub fn show(ui: &Ui, rect: Rect, picture: &Picture) {
    let request = &picture.request;
    if let Some(bounds) = request.model.scene.bounds_at(&request.frame) {
        frame(ui, rect, &request.pose, bounds);
    }
    axes(ui, rect, &request.pose);
}

/// The twelve edges of a box; of one that is endless, those that end.
fn frame(ui: &Ui, rect: Rect, pose: &Pose, bounds: [[f64; 3]; 2]) {
    let stroke = Stroke::new(1.0, style::of(ui).accent);
    let corner = |index: usize| DVec3::from([0, 1, 2].map(|axis| bounds[index >> axis & 1][axis]));
    for (from, axis) in (0..8_usize).flat_map(|from| (0..3_usize).map(move |axis| (from, axis))) {
        let (start, end) = (corner(from), corner(from | 1 << axis));
        if from >> axis & 1 == 0
            && let Some(line) = seen(pose, rect, start, end)
        {
            ui.painter().with_clip_rect(rect).line_segment(line, stroke);
        }
    }
}

/// In the upper right corner.
fn axes(ui: &Ui, rect: Rect, pose: &Pose) {
    let [right, up, forward] = pose.basis();
    let middle = rect.right_top() + vec2(-ARM - 18.0, ARM + 18.0);
    let mut arms = AXES.map(|(axis, name, color)| {
        let to = vec2(axis.dot(right) as f32, -axis.dot(up) as f32);
        (axis.dot(forward), middle + to * ARM, middle + to * (ARM + 9.0), name, color)
    });
    // The nearest last.
    arms.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (_, end, label, name, color) in arms {
        ui.painter().line_segment([middle, end], Stroke::new(2.0, color));
        let font = egui::FontId::proportional(11.0);
        ui.painter().text(label, egui::Align2::CENTER_CENTER, name, font, color);
    }
}

/// Where a line from one point to another is seen; `None` where no part of it is before the eye, or it has no ends.
fn seen(pose: &Pose, rect: Rect, start: DVec3, end: DVec3) -> Option<[Pos2; 2]> {
    let [right, up, forward] = pose.basis();
    let [mut start, mut end] = [start, end].map(|point| point - pose.eye);
    if !start.is_finite() || !end.is_finite() {
        return None;
    }
    let depth = |point: DVec3| if pose.parallel { 1.0 } else { point.dot(forward) };
    let nearest = NEAREST * (pose.target - pose.eye).length();
    let brought_forward = |behind: DVec3, ahead: DVec3| {
        let part = (nearest - depth(behind)) / (depth(ahead) - depth(behind));
        behind + (ahead - behind) * part
    };
    match [start, end].map(|point| !pose.parallel && depth(point) < nearest) {
        [true, true] => return None,
        [true, false] => start = brought_forward(start, end),
        [false, true] => end = brought_forward(end, start),
        [false, false] => {}
    }
    let half = f64::from(rect.height()) / 2.0;
    let place = |point: DVec3| {
        let scale = half / (pose.half_height * depth(point));
        let [x, y] = [right, up].map(|axis| (point.dot(axis) * scale) as f32);
        rect.center() + vec2(x, -y)
    };
    Some([start, end].map(place))
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
    fn a_line_is_seen_where_its_ends_are_and_no_nearer_than_the_eye() {
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(300.0, 200.0));
        for parallel in [false, true] {
            let pose = pose(parallel);
            let line = seen(&pose, rect, DVec3::ZERO, DVec3::new(1.25, 2.5, 0.0));
            assert_eq!(line, Some([pos2(160.0, 120.0), pos2(210.0, 20.0)]));
            assert_eq!(seen(&pose, rect, DVec3::ZERO, DVec3::INFINITY), None);
        }
        // To behind the eye: it leaves the picture upwards.
        let behind = DVec3::new(0.0, 1.0, 9.0);
        let [_, end] = seen(&pose(false), rect, DVec3::ZERO, behind).unwrap();
        assert!(end.y < rect.top() && end.is_finite(), "{end}");
        assert_eq!(seen(&pose(false), rect, behind, behind * 2.0), None);
    }
}
