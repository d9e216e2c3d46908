//! Handles over the picture: an arrow for a param or a number, and for a vector three arrows and a
//! square that is dragged in the plane of the picture.

use eframe::egui::{
    self, Color32, CursorIcon, Id, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, Vec2, vec2,
};
use glam::{DMat3, DVec3};
use sdfc_render::Pose;

use super::bounds_overlay::project_line;
use super::theme;
use super::view_gizmo::AXES;
use crate::session::Session;
use crate::session::handle_state::ValueHandle;

/// The length of an arrow in points.
const LENGTH: f32 = 64.0;
/// The size of a grip in points.
const GRIP: f32 = 14.0;
/// An arrow that points at the eye is drawn upwards instead if it is shorter than this part of its
/// length.
const MIN_SEEN: f64 = 0.1;

/// The handles in the picture, and the drag of one.
#[derive(Debug, Default)]
pub struct HandleOverlay {
    drag: Option<Drag>,
}

/// A drag of a handle.
#[derive(Debug)]
struct Drag {
    changes: Vec<Change>,
    /// The total drag in points.
    by: Vec2,
}

/// How a drag changes a value. This stays as it was when the drag began: in perspective, the arrow
/// of a value has another direction and another scale for each value.
#[derive(Debug)]
struct Change {
    start: ValueHandle,
    /// The change of the value per point to the right and down.
    per_point: [f64; 2],
    /// The change of the value that is a point in the picture.
    resolution: f64,
}

impl Change {
    /// The value after a drag. It has no digits for less than a point in the unit of its text.
    fn value(&self, by: Vec2) -> f64 {
        let ValueHandle { number, unit, .. } = &self.start;
        let [right, down] = self.per_point;
        let change = right * f64::from(by.x) + down * f64::from(by.y);
        if change.abs() < self.resolution / 2.0 {
            return *number;
        }
        unit.value(rounded(unit.number(number + change), unit.number(self.resolution)))
    }
}

impl HandleOverlay {
    /// Shows the handles, and changes the values of one that is dragged.
    pub fn show(&mut self, ui: &mut Ui, [rect, shown]: [Rect; 2], session: &mut Session) {
        let handles = session.value_handles();
        let Some(pose) = session.shown_request().map(|request| request.pose) else { return };
        let mut is_dragged = false;
        for (index, handle) in handles.iter().enumerate() {
            let Some(arrow) = Arrow::new(&pose, shown, handle) else { continue };
            let color = match handles.len() {
                3 => AXES[index].2,
                _ => theme::of(ui).accent,
            };
            let response = grip(ui, rect, arrow.tip(), index, "Drag to change the value.");
            arrow.paint(ui, rect, color, response.hovered() || response.dragged());
            is_dragged |= self.drag(&response, session, || vec![arrow.change(handle)]);
        }
        is_dragged |= self.plane_handle(ui, [rect, shown], &pose, &handles, session);
        if !is_dragged {
            self.drag = None;
        }
        session.handles.is_dragged = is_dragged;
    }

    /// Shows a square that moves three translations in the plane of the picture.
    fn plane_handle(
        &mut self,
        ui: &mut Ui,
        [rect, shown]: [Rect; 2],
        pose: &Pose,
        handles: &[ValueHandle],
        session: &mut Session,
    ) -> bool {
        let [x, y, z] = handles else { return false };
        let motions = DMat3::from_cols(x.handle.motion, y.handle.motion, z.handle.motion);
        let is_translation = handles.iter().all(|it| it.handle.is_translation);
        if !is_translation || motions.determinant().abs() < 1e-9 {
            return false;
        }
        let origin = x.handle.origin;
        let Some([at, _]) = project_line(pose, shown, origin, origin) else { return false };
        let help = "Drag to move the part in the plane of the picture.";
        let response = grip(ui, rect, at, 3, help);
        let square = Rect::from_center_size(at, Vec2::splat(GRIP - 4.0));
        let color = theme::of(ui).accent;
        let fill = if response.hovered() { color } else { color.gamma_multiply(0.4) };
        let painter = ui.painter().with_clip_rect(rect);
        painter.rect(square, 2.0, fill, Stroke::new(1.5, color), egui::StrokeKind::Middle);
        let changes = || {
            let resolution = units_per_point(pose, shown, origin);
            let [right, up, _] = pose.basis();
            let [right, down] =
                [right, -up].map(|side| (motions.inverse() * (side * resolution)).to_array());
            let per_point = right.into_iter().zip(down).map(|(right, down)| [right, down]);
            let change = |(start, per_point): (&ValueHandle, [f64; 2])| Change {
                start: start.clone(),
                per_point,
                resolution,
            };
            handles.iter().zip(per_point).map(change).collect()
        };
        self.drag(&response, session, changes)
    }

    /// Changes values by the drag of a grip. Returns true while it is dragged.
    fn drag(
        &mut self,
        response: &Response,
        session: &mut Session,
        changes: impl FnOnce() -> Vec<Change>,
    ) -> bool {
        if response.drag_started() {
            self.drag = Some(Drag { changes: changes(), by: Vec2::ZERO });
        }
        let Some(drag) = self.drag.as_mut().filter(|_| response.dragged()) else { return false };
        drag.by += response.drag_delta();
        for change in &drag.changes {
            session.set_value(&change.start.value, change.value(drag.by));
        }
        true
    }
}

/// The space that reacts to the pointer at a point of the picture.
fn grip(ui: &Ui, rect: Rect, at: Pos2, index: usize, help: &str) -> Response {
    let space = Rect::from_center_size(at, Vec2::splat(GRIP)).intersect(rect);
    let response = ui.interact(space, Id::unique(("value handle", index)), Sense::drag());
    response.on_hover_cursor(CursorIcon::Grab).on_hover_text(help)
}

/// An arrow on the screen.
struct Arrow {
    from: Pos2,
    /// Where it points, of length 1.
    direction: Vec2,
    value_per_point: f64,
}

impl Arrow {
    fn new(pose: &Pose, shown: Rect, ValueHandle { handle, .. }: &ValueHandle) -> Option<Self> {
        let unit = units_per_point(pose, shown, handle.origin);
        let speed = handle.motion.length();
        let along = handle.motion.try_normalize()? * (f64::from(LENGTH) * unit);
        let [from, to] = project_line(pose, shown, handle.origin, handle.origin + along)?;
        let seen = f64::from((to - from).length() / LENGTH);
        let (direction, seen) = match seen < MIN_SEEN {
            true => (vec2(0.0, -1.0), 1.0),
            false => ((to - from).normalized(), seen),
        };
        Some(Self { from, direction, value_per_point: unit / seen / speed })
    }

    /// How a drag changes the value of this arrow.
    fn change(&self, start: &ValueHandle) -> Change {
        let Vec2 { x, y } = self.direction;
        let per_point = [x, y].map(|side| f64::from(side) * self.value_per_point);
        Change { start: start.clone(), per_point, resolution: self.value_per_point }
    }

    fn tip(&self) -> Pos2 {
        self.from + self.direction * LENGTH
    }

    fn paint(&self, ui: &Ui, rect: Rect, color: Color32, is_hovered: bool) {
        let painter = ui.painter().with_clip_rect(rect);
        let width = if is_hovered { 4.0 } else { 2.5 };
        let tip = self.tip();
        painter.circle_filled(self.from, 3.0, color);
        painter.line_segment([self.from, tip], Stroke::new(width, color));
        let side = self.direction.rot90() * 6.0;
        let (end, back) = (tip + self.direction * 7.0, tip - self.direction * 5.0);
        let head = vec![end, back + side, back - side];
        painter.add(Shape::convex_polygon(head, color, Stroke::new(1.0, theme::of(ui).ground)));
    }
}

/// Scene units per point of the screen at the depth of a point.
fn units_per_point(pose: &Pose, shown: Rect, at: DVec3) -> f64 {
    let [_, _, forward] = pose.basis();
    let depth = if pose.parallel { 1.0 } else { (at - pose.eye).dot(forward).abs() };
    2.0 * pose.half_height * depth / f64::from(shown.height().max(1.0))
}

/// A value without the digits that are less than a point.
fn rounded(value: f64, per_point: f64) -> f64 {
    let digits = -per_point.abs().max(1e-12).log10().floor();
    let unit = 10f64.powf(digits.clamp(0.0, 12.0));
    (value * unit).round() / unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::handles::Handle;
    use crate::scene::handle_values::HandleValue;
    use crate::scene::number_text::{Unit, angle_text};

    /// The text of an angle in a unit after a drag that changes it by 0.37° per point.
    fn dragged(start: f64, suffix: &str, by: f32) -> String {
        let unit = Unit::of(suffix);
        let handle = Handle { origin: DVec3::ZERO, motion: DVec3::X, is_translation: true };
        let value = HandleValue::Number(0);
        let start = ValueHandle { value, number: unit.value(start), unit, handle };
        let resolution = 0.37f64.to_radians();
        let change = Change { start, per_point: [resolution, 0.0], resolution };
        angle_text(change.value(vec2(by, 0.0)), suffix)
    }

    #[test]
    fn a_dragged_angle_has_short_text_in_its_unit() {
        assert_eq!(
            [dragged(30.0, "deg", 7.0), dragged(-30.0, "deg", 7.0)],
            ["32.6deg", "-27.4deg"]
        );
        assert_eq!(dragged(0.25, "turn", -7.0), "0.243turn");
        for by in 1..200 {
            let text = dragged(30.0, "deg", by as f32);
            assert!(text.len() <= "-12.3deg".len(), "{text}");
        }
        // Less than half a point changes nothing.
        assert_eq!(dragged(30.123_456, "deg", 0.4), "30.123456deg");
    }
}
