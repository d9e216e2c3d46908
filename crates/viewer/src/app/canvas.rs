//! The picture, camera input, and info about the pixel under the pointer.

use std::time::{Duration, Instant};

use eframe::egui::{
    self, Color32, ColorImage, Key, PointerButton, Pos2, Rect, Response, RichText, Sense,
    TextureHandle, TextureOptions, Ui, pos2, vec2,
};
use eframe::egui_wgpu::RenderState;
use glam::DVec3;
use sdfc_render::{CAPPED, HIT};

use super::device_texture::DeviceTextureSlot;
use super::handle_overlay::HandleOverlay;
use super::shape_outline::ShapeOutline;
use super::theme::{self, card};
use super::{bounds_overlay, legend_card, view_gizmo};
use crate::render::picture::Picture;
use crate::render::pixel_info::PixelInfo;
use crate::session::Session;

/// The time after the last turn of the wheel for which the camera counts as moving.
const WHEEL_REST: Duration = Duration::from_millis(160);
/// Flying speed, in distances to the pivot per second.
const FLY_SPEED: f64 = 0.8;
/// The factor of the flying speed with Shift.
const SHIFT_FACTOR: f64 = 4.0;
/// The logarithm of the zoom factor per point of the wheel.
const ZOOM_PER_POINT: f64 = -0.0025;

/// The picture on the screen.
#[derive(Default)]
pub struct Canvas {
    texture: Option<TextureHandle>,
    device_texture: DeviceTextureSlot,
    /// The session's picture count when the texture was made.
    shown: u64,
    last_wheel: Option<Instant>,
    /// What the wheel zooms at, and where the pointer is.
    zoomed_at: Option<(DVec3, Pos2)>,
    outline: ShapeOutline,
    handles: HandleOverlay,
    rect: Option<Rect>,
}

impl Canvas {
    /// Shows pictures on the device of the window from now on.
    pub fn show_device_pictures(&mut self, state: RenderState) {
        self.device_texture = DeviceTextureSlot::new(state);
    }

    /// Shows the picture in the whole space, handles camera input, and requests the next picture.
    /// Returns the position that was clicked, as fractions of the picture.
    pub fn show(&mut self, ui: &mut Ui, session: &mut Session) -> Option<[f64; 2]> {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        self.rect = Some(rect);
        ui.painter().rect_filled(rect, 0.0, theme::of(ui).ground);
        self.refresh(ui, session);
        let shown = session.shown_request().map_or(rect, |it| shown_at(rect, it.size));
        let moving = session.moving.as_ref().and_then(|it| self.device_texture.show(it));
        if let Some(texture) = moving.or(self.texture.as_ref().map(TextureHandle::id)) {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter_at(rect).image(texture, shown, whole, Color32::WHITE);
        } else {
            waiting(ui, rect, session);
        }
        self.outline.show(ui, [rect, shown], session);
        if let Some(request) = session.shown_request().filter(|_| session.show_bounds) {
            bounds_overlay::show(ui, shown, request);
        }
        if session.is_view_pending() {
            pending_view(ui, rect, session);
        }
        let flying = camera_input(ui, &response, [rect, shown], session);
        if zoom_by_wheel(ui, &response, [rect, shown], &mut self.zoomed_at, session) {
            self.last_wheel = Some(Instant::now());
        }
        let recent = self.last_wheel.is_some_and(|last| last.elapsed() < WHEEL_REST);
        if recent {
            ui.ctx().request_repaint_after(WHEEL_REST);
        } else {
            self.zoomed_at = None;
        }
        let pressed = ui.input(|input| input.pointer.any_down());
        let playing = session.clock.playing && session.is_animated();
        let scale = f64::from(ui.ctx().pixels_per_point());
        let most = ui.input(|input| input.max_texture_side) as f64;
        let side = |points: f32| (f64::from(points) * scale).round().clamp(0.0, most) as u32;
        let size = [side(rect.width()), side(rect.height())];
        session.request_picture(size, flying || recent || playing || pressed);
        if let Some(picture) = &session.picture {
            legend_card::show(ui, rect, &picture.legend);
        }
        pixel_info(ui, &response, [rect, shown], session);
        view_gizmo::show(ui, rect, session);
        self.handles.show(ui, [rect, shown], session);
        let clicked = response.interact_pointer_pos().filter(|_| response.clicked());
        if clicked.is_some() {
            session.handles.selected = None;
        }
        clicked.map(|at| fractions(shown, at))
    }

    /// Where the picture was shown in the last frame.
    pub fn rect(&self) -> Rect {
        self.rect.unwrap_or(Rect::ZERO)
    }

    /// Uploads a new picture to the window's texture.
    fn refresh(&mut self, ui: &Ui, session: &Session) {
        let Some(picture) = &session.picture else {
            self.texture = None;
            return;
        };
        if self.shown == session.picture_count && self.texture.is_some() {
            return;
        }
        self.shown = session.picture_count;
        let image = color_image(picture);
        let smooth = if picture.divisor * picture.stride > 1 {
            TextureOptions::LINEAR
        } else {
            TextureOptions::NEAREST
        };
        match &mut self.texture {
            Some(texture) => texture.set(image, smooth),
            none => *none = Some(ui.ctx().load_texture("picture", image, smooth)),
        }
    }
}

/// Where a picture is shown until there is one of the right size: as high as the space, as the
/// camera would show it, and never stretched.
fn shown_at(space: Rect, [width, height]: [u32; 2]) -> Rect {
    let aspect = width as f32 / height.max(1) as f32;
    Rect::from_center_size(space.center(), vec2(space.height() * aspect, space.height()))
}

/// Says which view is being computed and which one is shown.
fn pending_view(ui: &Ui, rect: Rect, session: &Session) {
    let Some(request) = session.shown_request() else { return };
    let (next, shown) = (session.mode.name(), request.mode.name());
    let text = format!("computing {next}…  (this is {shown})");
    let font = egui::TextStyle::Body.resolve(ui.style());
    let at = rect.center_top() + vec2(0.0, 14.0);
    let painter = ui.painter_at(rect);
    let galley = painter.layout_no_wrap(text, font, theme::of(ui).accent);
    let text_rect = egui::Align2::CENTER_TOP.anchor_size(at, galley.size());
    painter.rect_filled(text_rect.expand2(vec2(10.0, 5.0)), 6.0, theme::of(ui).card);
    painter.galley(text_rect.min, galley, theme::of(ui).accent);
}

fn color_image(picture: &Picture) -> ColorImage {
    let size = picture.rgba_size.map(|side| side as usize);
    // Alpha is 255 everywhere, so premultiplied colours are the same.
    ColorImage::from_rgba_premultiplied(size, &picture.rgba)
}

/// A text about the current step, until there is a picture.
fn waiting(ui: &Ui, rect: Rect, session: &Session) {
    if session.diagnostics.errors() > 0 {
        return;
    }
    let text = match (&session.problem, &session.render_error, &session.model) {
        (Some(problem), _, _) | (None, Some(problem), _) => problem.clone(),
        (None, None, _) if session.building => "compiling the shader…".to_owned(),
        (None, None, Some(_)) => "drawing the first picture…".to_owned(),
        (None, None, None) => "compiling the scene…".to_owned(),
    };
    let font = egui::TextStyle::Heading.resolve(ui.style());
    ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, text, font, theme::of(ui).weak);
}

/// Moves the camera by mouse and keys. Returns true while it flies.
fn camera_input(
    ui: &Ui,
    response: &Response,
    [rect, shown]: [Rect; 2],
    session: &mut Session,
) -> bool {
    let height = f64::from(rect.height().max(1.0));
    let delta = response.drag_delta();
    let (right, down) = (f64::from(delta.x) / height, f64::from(delta.y) / height);
    let keys = ui.input(|input| input.modifiers);
    let middle_turns = session.middle_turns;
    if delta != vec2(0.0, 0.0) {
        session.move_camera(|camera| {
            let primary = response.dragged_by(PointerButton::Primary);
            let turns = primary || middle_turns && response.dragged_by(PointerButton::Middle);
            if primary && keys.alt {
                camera.look_around(right, down);
            } else if turns && !keys.shift {
                camera.orbit(right, down);
            } else {
                camera.pan(right, down);
            }
        });
    }
    if response.double_clicked()
        && let Some(at) = response.interact_pointer_pos()
        && let Some(info) = session.pixel_info(fractions(shown, at))
        && info.status == HIT
    {
        session.move_camera(|camera| camera.set_pivot(info.point));
    }
    fly(ui, session)
}

/// Flies by the keys that are held. Returns true while it does.
fn fly(ui: &Ui, session: &mut Session) -> bool {
    if ui.ctx().text_edit_focused() {
        return false;
    }
    let axes = [(Key::D, Key::A), (Key::E, Key::Q), (Key::W, Key::S)];
    let (by, seconds, modifiers) = ui.input(|input| {
        let held = |key| f64::from(u8::from(input.key_down(key)));
        let by = axes.map(|(plus, minus)| held(plus) - held(minus));
        (DVec3::from(by), f64::from(input.stable_dt).min(0.1), input.modifiers)
    });
    if by == DVec3::ZERO || modifiers.ctrl || modifiers.command {
        return false;
    }
    let speed = if modifiers.shift { FLY_SPEED * SHIFT_FACTOR } else { FLY_SPEED };
    session.move_camera(|camera| camera.fly(by * speed * seconds));
    ui.ctx().request_repaint();
    true
}

/// Zooms at the surface under the pointer; beside the shapes, at the depth of the pivot. Further
/// turns of the wheel zoom at the same point, until the pointer moves. Returns true if the camera
/// moved.
fn zoom_by_wheel(
    ui: &Ui,
    response: &Response,
    [rect, shown]: [Rect; 2],
    zoomed_at: &mut Option<(DVec3, Pos2)>,
    session: &mut Session,
) -> bool {
    let Some(at) = response.hover_pos() else { return false };
    let (scroll, zoom) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
    let factor = (f64::from(scroll) * ZOOM_PER_POINT).exp() / f64::from(zoom);
    if factor == 1.0 {
        return false;
    }
    let known = zoomed_at.filter(|(_, pointer)| *pointer == at).map(|(point, _)| point);
    let under = || {
        let info = session.pixel_info(fractions(shown, at)).filter(|_| shown.contains(at));
        info.filter(|info| info.status == HIT).map(|info| info.point)
    };
    if let Some(point) = known.or_else(under) {
        *zoomed_at = Some((point, at));
        session.move_camera(|camera| camera.zoom_at(point, factor));
        return true;
    }
    let half = f64::from(rect.height().max(1.0)) / 2.0;
    let from_middle = at - rect.center();
    let pointer = [f64::from(from_middle.x) / half, -f64::from(from_middle.y) / half];
    session.move_camera(|camera| camera.dolly(factor, pointer));
    true
}

/// A position as fractions of the rectangle's width and height.
fn fractions(rect: Rect, at: Pos2) -> [f64; 2] {
    let fractions = (at - rect.min) / rect.size();
    [f64::from(fractions.x).clamp(0.0, 1.0), f64::from(fractions.y).clamp(0.0, 1.0)]
}

/// Shows point, normal, depth and field of the pixel under the pointer, in the lower left corner.
fn pixel_info(ui: &mut Ui, response: &Response, [rect, shown]: [Rect; 2], session: &Session) {
    let pointer = response.hover_pos().filter(|at| shown.contains(*at));
    let info = pointer.and_then(|at| session.pixel_info(fractions(shown, at)));
    let Some(info) = info else { return };
    let lines = lines(ui, &info);
    let area =
        egui::Area::new(ui.scope_id().with("hover")).order(egui::Order::Middle).interactable(false);
    let area =
        area.pivot(egui::Align2::LEFT_BOTTOM).fixed_pos(rect.left_bottom() + vec2(10.0, -10.0));
    area.show(ui.ctx(), |ui| {
        ui.set_max_width(rect.width() - 20.0);
        card(ui).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            for (line, color) in lines {
                let text = RichText::new(line).monospace().size(11.5).color(color);
                ui.add(egui::Label::new(text).truncate());
            }
        });
    });
}

fn lines(ui: &Ui, info: &PixelInfo) -> Vec<(String, Color32)> {
    // Rounded first, so that a small negative number is not shown as -0.
    let number = |it: f64| format!("{:>9.4}", (it * 1e4).round() / 1e4 + 0.0);
    let point = |v: DVec3| v.to_array().map(number).join(" ");
    let mut lines = Vec::new();
    match info.status {
        HIT => {
            if let Some(shape) = &info.shape {
                lines.push((shape.clone(), theme::of(ui).accent));
            }
            lines.push((format!("point  {}", point(info.point)), theme::of(ui).text));
            if let Some(normal) = info.normal {
                lines.push((format!("normal {}", point(normal)), theme::of(ui).text));
            }
        }
        CAPPED => lines.push(("the ray ran out of steps".to_owned(), theme::of(ui).warning)),
        _ => lines.push(("background".to_owned(), theme::of(ui).weak)),
    }
    if info.unproven && info.status != CAPPED {
        lines.push(("not proven: the ray was sampled".to_owned(), theme::of(ui).warning));
    }
    let distance = info.distance.map_or(String::new(), |d| format!("   field {d:.2e}"));
    let plural = if info.evaluations == 1 { "" } else { "s" };
    let text =
        format!("depth {:.4}{distance}   {} evaluation{plural}", info.depth, info.evaluations);
    lines.push((text, theme::of(ui).weak));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_of_another_size_is_not_stretched() {
        let space = Rect::from_min_size(pos2(100.0, 50.0), vec2(400.0, 600.0));
        let shown = shown_at(space, [900, 600]);
        assert_eq!((shown.size(), shown.center()), (vec2(900.0, 600.0), space.center()));
        assert_eq!(shown_at(space, [800, 1200]), space);
    }
}
