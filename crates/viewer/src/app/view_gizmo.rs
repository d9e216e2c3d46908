//! The axes in the upper right corner of the picture: a click looks along one, a drag turns.

use eframe::egui::{self, Align2, Color32, FontId, Rect, Sense, Stroke, Ui, Vec2, vec2};
use glam::DVec3;
use sdfc_render::Pose;

use super::theme;
use crate::session::Session;
use crate::session::orbit_camera::Side;

/// Direction, name and colour of each axis.
pub(super) const AXES: [(DVec3, &str, Color32); 3] = [
    (DVec3::X, "x", Color32::from_rgb(230, 90, 80)),
    (DVec3::Y, "y", Color32::from_rgb(110, 190, 80)),
    (DVec3::Z, "z", Color32::from_rgb(90, 140, 240)),
];
/// The length of the axes in points.
const LENGTH: f32 = 27.0;
/// The radius of their ends in points.
const END: f32 = 8.0;
/// The sides that the ends of the axes look from: the positive end, then the negative one.
const SIDES: [[Side; 2]; 3] =
    [[Side::Right, Side::Left], [Side::Top, Side::Bottom], [Side::Front, Side::Back]];
/// How much of the colours is seen while the pointer is elsewhere.
const OPACITY: f32 = 0.75;

/// An end of an axis.
struct End {
    axis: usize,
    negative: bool,
    /// Its position in points, from where the axes meet.
    position: Vec2,
    /// Its distance behind the point where the axes meet.
    depth: f64,
}

/// Shows the axes as the camera of a spatial scene sees them.
pub fn show(ui: &Ui, rect: Rect, session: &mut Session) {
    let is_planar = session.model.as_ref().is_none_or(|model| model.scene.is_planar());
    let Some(camera) = session.camera().filter(|_| !is_planar) else { return };
    let reach = LENGTH + END;
    let middle = rect.right_top() + vec2(-reach - 8.0, reach + 8.0);
    if rect.width() < 4.0 * reach || rect.height() < 4.0 * reach {
        return;
    }
    let mut ends = ends(&camera.pose());
    let area = Rect::from_center_size(middle, Vec2::splat(2.0 * reach));
    let response = ui.interact(area, ui.scope_id().with("view gizmo"), Sense::click_and_drag());
    let under = |at: egui::Pos2| {
        let near = ends.iter().filter(|end| (middle + end.position).distance(at) <= END);
        near.min_by(|a, b| a.depth.total_cmp(&b.depth)).map(|end| (end.axis, end.negative))
    };
    let chosen = response.hover_pos().and_then(under);
    if let Some((axis, negative)) = response.interact_pointer_pos().and_then(under)
        && response.clicked()
    {
        session.move_camera(|camera| camera.look_from(SIDES[axis][usize::from(negative)]));
    }
    let drag = response.drag_delta() / rect.height().max(1.0);
    if drag != Vec2::ZERO {
        session.move_camera(|camera| camera.orbit(f64::from(drag.x), f64::from(drag.y)));
    }
    let is_used = response.hovered() || response.dragged();
    response.on_hover_text("Click an axis to look along it, or drag to turn.");
    ends.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    let opacity = if is_used { 1.0 } else { OPACITY };
    for end in ends {
        paint(ui, rect, middle, &end, opacity, chosen == Some((end.axis, end.negative)));
    }
}

fn paint(ui: &Ui, rect: Rect, middle: egui::Pos2, end: &End, opacity: f32, is_chosen: bool) {
    let (_, name, color) = AXES[end.axis];
    let painter = ui.painter_at(rect);
    let color = color.gamma_multiply(opacity);
    let at = middle + end.position;
    if end.negative {
        let fill = if is_chosen { color } else { theme::of(ui).card.gamma_multiply(opacity) };
        painter.circle(at, END - 1.5, fill, Stroke::new(1.5, color));
    } else {
        painter.line_segment([middle, at], Stroke::new(2.0, color));
        painter.circle_filled(at, END, color);
    }
    if is_chosen {
        painter.circle_stroke(at, END, Stroke::new(1.5, theme::of(ui).strong));
    }
    if !end.negative || is_chosen {
        let sign = if end.negative { "-" } else { "" };
        let font = FontId::proportional(11.0);
        painter.text(at, Align2::CENTER_CENTER, format!("{sign}{name}"), font, Color32::BLACK);
    }
}

/// The six ends as a camera sees them.
fn ends(pose: &Pose) -> Vec<End> {
    let [right, up, forward] = pose.basis();
    let end = |(axis, negative): (usize, bool)| {
        let direction: DVec3 = if negative { -AXES[axis].0 } else { AXES[axis].0 };
        let position = vec2(direction.dot(right) as f32, -direction.dot(up) as f32) * LENGTH;
        End { axis, negative, position, depth: direction.dot(forward) }
    };
    (0..3).flat_map(|axis| [(axis, false), (axis, true)]).map(end).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::orbit_camera::OrbitCamera;

    #[test]
    fn the_end_that_was_clicked_comes_to_the_front() {
        let pose = Pose {
            eye: DVec3::new(4.0, 3.0, 5.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            parallel: false,
            half_height: 0.3,
        };
        for (axis, sides) in SIDES.iter().enumerate() {
            for (negative, side) in [false, true].into_iter().zip(sides) {
                let mut camera = OrbitCamera::new(&pose);
                camera.look_from(*side);
                let ends = ends(&camera.pose());
                let front = ends.iter().min_by(|a, b| a.depth.total_cmp(&b.depth)).unwrap();
                assert_eq!((front.axis, front.negative), (axis, negative), "{side:?}");
                assert!(front.position.length() < 1.0, "{:?}", front.position);
            }
        }
    }
}
