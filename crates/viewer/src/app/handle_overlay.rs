//! Handles over the picture: an arrow for a param or a number, and for a vector three arrows and a
//! square that is dragged in the plane of the picture.

use eframe::egui::{
    self, Color32, CursorIcon, Id, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, vec2,
};
use glam::{DMat3, DVec3};
use sdfc_render::Pose;

use super::axes_overlay::{AXES, project_line};
use super::theme;
use crate::session::Session;
use crate::session::handle_state::ValueHandle;

/// The length of an arrow in points.
const LENGTH: f32 = 64.0;
/// The size of a grip in points.
const GRIP: f32 = 14.0;
/// An arrow that points at the eye is drawn upwards instead if it is shorter than this part of its
/// length.
const MIN_SEEN: f64 = 0.1;

/// The drag of a handle: the values and the pointer when it began.
#[derive(Debug, Default)]
pub struct HandleOverlay {
    start: Option<Dragged>,
}

#[derive(Debug)]
struct Dragged {
    handles: Vec<ValueHandle>,
    /// The total drag in points.
    by: Vec2,
}

impl HandleOverlay {
    /// Shows the handles, and changes the values of one that is dragged.
    pub fn show(&mut self, ui: &mut Ui, [rect, shown]: [Rect; 2], session: &mut Session) {
        let handles = session.value_handles();
        let Some(pose) = session.picture.as_ref().map(|picture| picture.request.pose) else {
            return;
        };
        let mut is_dragged = false;
        for (index, handle) in handles.iter().enumerate() {
            let Some(arrow) = Arrow::new(&pose, shown, handle) else { continue };
            let color = match handles.len() {
                3 => AXES[index].2,
                _ => theme::of(ui).accent,
            };
            let response = grip(ui, rect, arrow.tip(), index, "Drag to change the value.");
            arrow.paint(ui, rect, color, response.hovered() || response.dragged());
            if response.drag_started() {
                self.start = Some(Dragged { handles: handles.clone(), by: Vec2::ZERO });
            }
            if let Some(dragged) = self.start.as_mut().filter(|_| response.dragged()) {
                is_dragged = true;
                dragged.by += response.drag_delta();
                if let Some(start) = dragged.handles.get(index) {
                    let by = f64::from(dragged.by.dot(arrow.direction)) * arrow.value_per_point;
                    let value = rounded(start.number + by, arrow.value_per_point);
                    session.set_value(&start.value, value);
                }
            }
        }
        is_dragged |= self.plane_handle(ui, [rect, shown], &pose, &handles, session);
        if !is_dragged {
            self.start = None;
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
        if response.drag_started() {
            self.start = Some(Dragged { handles: handles.to_vec(), by: Vec2::ZERO });
        }
        let Some(dragged) = self.start.as_mut().filter(|_| response.dragged()) else {
            return false;
        };
        dragged.by += response.drag_delta();
        let unit = units_per_point(pose, shown, origin);
        let [right, up, _] = pose.basis();
        let by = right * f64::from(dragged.by.x) - up * f64::from(dragged.by.y);
        let changes = motions.inverse() * (by * unit);
        for (start, change) in dragged.handles.iter().zip(changes.to_array()) {
            session.set_value(&start.value, rounded(start.number + change, unit));
        }
        true
    }
}

/// The space that reacts to the pointer at a point of the picture.
fn grip(ui: &Ui, rect: Rect, at: Pos2, index: usize, help: &str) -> egui::Response {
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
