//! The picture, and the pointer on it.

use std::time::{Duration, Instant};

use eframe::egui::{
    self, Color32, ColorImage, Key, PointerButton, Pos2, Rect, Response, RichText, Sense,
    TextureHandle, TextureOptions, Ui, pos2, vec2,
};
use glam::DVec3;
use sdfc::render::{CAPPED, HIT};

use super::{guides, style};
use crate::legend::Legend;
use crate::look::Look;
use crate::painter::Picture;
use crate::session::Session;

/// So long after the wheel was turned the camera counts as moving.
const REST: Duration = Duration::from_millis(160);
/// Distances to the pivot a second.
const FLIGHT: f64 = 0.8;
/// With shift.
const FAST: f64 = 4.0;
/// What one point of the wheel does to the distance: `exp` of it.
const WHEEL: f64 = -0.0025;

/// Legend and pointer's card stand side by side in this.
const BOTH: f32 = 620.0;

/// The picture on the screen.
#[derive(Default)]
pub struct Canvas {
    texture: Option<TextureHandle>,
    shown: u64,
    last_wheel: Option<Instant>,
}

impl Canvas {
    /// Shows the picture in all of the space, takes input, and asks for the next.
    pub fn show(&mut self, ui: &mut Ui, session: &mut Session) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        ui.painter().rect_filled(rect, 0.0, style::of(ui).ground);
        self.refresh(ui, session);
        if let Some(texture) = &self.texture {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture.id(), rect, whole, Color32::WHITE);
        } else {
            waiting(ui, rect, session);
        }
        if let Some(picture) = session.picture.as_deref().filter(|_| session.guides) {
            guides::show(ui, rect, picture);
        }
        let flying = drive(ui, &response, rect, session);
        let wheel = wheel(ui, &response, rect, session);
        if wheel {
            self.last_wheel = Some(Instant::now());
        }
        let recent = self.last_wheel.is_some_and(|last| last.elapsed() < REST);
        if recent {
            ui.ctx().request_repaint_after(REST);
        }
        let pressed = ui.input(|input| input.pointer.any_down());
        let playing = session.clock.playing && session.moves();
        let scale = f64::from(ui.ctx().pixels_per_point());
        let most = ui.input(|input| input.max_texture_side) as f64;
        let side = |points: f32| (f64::from(points) * scale).round().clamp(0.0, most) as u32;
        let size = [side(rect.width()), side(rect.height())];
        session.ask(size, flying || recent || playing || pressed);
        if let Some(picture) = &session.picture {
            legend(ui, rect, &picture.legend);
        }
        hover(ui, &response, rect, session);
    }

    /// Hands a new picture to the graphics card.
    fn refresh(&mut self, ui: &Ui, session: &Session) {
        let Some(picture) = &session.picture else {
            self.texture = None;
            return;
        };
        if self.shown == session.pictures && self.texture.is_some() {
            return;
        }
        self.shown = session.pictures;
        let image = color_image(picture);
        let smooth =
            if picture.divisor > 1 { TextureOptions::LINEAR } else { TextureOptions::NEAREST };
        match &mut self.texture {
            Some(texture) => texture.set(image, smooth),
            none => *none = Some(ui.ctx().load_texture("picture", image, smooth)),
        }
    }
}

fn color_image(picture: &Picture) -> ColorImage {
    let size = picture.image.size().map(|side| side as usize);
    // The alpha is 255 throughout, so nothing is multiplied.
    ColorImage::from_rgba_premultiplied(size, &picture.rgba)
}

fn waiting(ui: &Ui, rect: Rect, session: &Session) {
    if session.findings.errors() > 0 {
        return;
    }
    let text = match (&session.trouble, &session.no_picture, session.building) {
        (Some(trouble), _, _) | (None, Some(trouble), _) => trouble.clone(),
        (None, None, true) => "building the shader…".to_owned(),
        (None, None, false) => "reading the scene…".to_owned(),
    };
    let font = egui::TextStyle::Heading.resolve(ui.style());
    ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, text, font, style::of(ui).weak);
}

/// Moves the camera. Gives whether it flies.
fn drive(ui: &Ui, response: &Response, rect: Rect, session: &mut Session) -> bool {
    let height = f64::from(rect.height().max(1.0));
    let delta = response.drag_delta();
    let (right, down) = (f64::from(delta.x) / height, f64::from(delta.y) / height);
    let keys = ui.input(|input| input.modifiers);
    if delta != vec2(0.0, 0.0) {
        session.move_camera(|orbit| {
            let primary = response.dragged_by(PointerButton::Primary);
            if primary && keys.alt {
                orbit.look_around(right, down);
            } else if primary && !keys.shift {
                orbit.turn(right, down);
            } else {
                orbit.pan(right, down);
            }
        });
    }
    if response.double_clicked()
        && let Some(look) =
            response.interact_pointer_pos().and_then(|at| session.look(part(rect, at)))
        && look.status == HIT
    {
        session.move_camera(|orbit| orbit.set_pivot(look.point));
    }
    fly(ui, session)
}

fn fly(ui: &Ui, session: &mut Session) -> bool {
    if ui.ctx().text_edit_focused() {
        return false;
    }
    let axes = [(Key::D, Key::A), (Key::E, Key::Q), (Key::W, Key::S)];
    let (by, seconds, shift) = ui.input(|input| {
        let held = |key| f64::from(u8::from(input.key_down(key)));
        let by = axes.map(|(plus, minus)| held(plus) - held(minus));
        (DVec3::from(by), f64::from(input.stable_dt).min(0.1), input.modifiers)
    });
    if by == DVec3::ZERO || shift.ctrl || shift.command {
        return false;
    }
    let speed = if shift.shift { FLIGHT * FAST } else { FLIGHT };
    session.move_camera(|orbit| orbit.fly(by * speed * seconds));
    ui.ctx().request_repaint();
    true
}

fn wheel(ui: &Ui, response: &Response, rect: Rect, session: &mut Session) -> bool {
    let Some(at) = response.hover_pos() else { return false };
    let (scroll, zoom) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
    let factor = (f64::from(scroll) * WHEEL).exp() / f64::from(zoom);
    if factor == 1.0 {
        return false;
    }
    let half = f64::from(rect.height().max(1.0)) / 2.0;
    let from_middle = at - rect.center();
    let place = [f64::from(from_middle.x) / half, -f64::from(from_middle.y) / half];
    session.move_camera(|orbit| orbit.dolly(factor, place));
    true
}

/// A place in parts of the sides.
fn part(rect: Rect, at: Pos2) -> [f64; 2] {
    let part = (at - rect.min) / rect.size();
    [f64::from(part.x).clamp(0.0, 1.0), f64::from(part.y).clamp(0.0, 1.0)]
}

/// What is under the pointer, in a corner.
fn hover(ui: &mut Ui, response: &Response, rect: Rect, session: &Session) {
    let Some(look) = response.hover_pos().and_then(|at| session.look(part(rect, at))) else {
        return;
    };
    let lines = lines(ui, &look);
    let area =
        egui::Area::new(ui.scope_id().with("hover")).order(egui::Order::Middle).interactable(false);
    let area =
        area.pivot(egui::Align2::LEFT_BOTTOM).fixed_pos(rect.left_bottom() + vec2(10.0, -10.0));
    area.show(ui.ctx(), |ui| {
        card(ui).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            for (line, color) in lines {
                let text = RichText::new(line).monospace().size(11.5).color(color);
                ui.add(egui::Label::new(text).extend());
            }
        });
    });
}

fn lines(ui: &Ui, look: &Look) -> Vec<(String, Color32)> {
    // Rounded first, and without the sign that a zero may have.
    let number = |it: f64| format!("{:>9.4}", (it * 1e4).round() / 1e4 + 0.0);
    let point = |v: DVec3| v.to_array().map(number).join(" ");
    let mut lines = Vec::new();
    match look.status {
        HIT => {
            if let Some(shape) = &look.shape {
                lines.push((shape.clone(), style::of(ui).accent));
            }
            lines.push((format!("point  {}", point(look.point)), style::of(ui).text));
            if let Some(normal) = look.normal {
                lines.push((format!("normal {}", point(normal)), style::of(ui).text));
            }
        }
        CAPPED => lines.push(("the ray ran out of steps".to_owned(), style::of(ui).warning)),
        _ => lines.push(("the ray meets nothing".to_owned(), style::of(ui).weak)),
    }
    let distance = look.distance.map_or(String::new(), |d| format!("   field {d:.2e}"));
    let plural = if look.evaluations == 1 { "" } else { "s" };
    let text = format!("ray {:.4}{distance}   {} evaluation{plural}", look.depth, look.evaluations);
    lines.push((text, style::of(ui).weak));
    lines
}

/// A translucent card over the picture.
pub fn card(ui: &Ui) -> egui::Frame {
    egui::Frame::new()
        .fill(style::of(ui).card)
        .stroke(egui::Stroke::new(1.0, style::of(ui).line))
        .corner_radius(6)
        .inner_margin(egui::Margin::symmetric(10, 7))
}

/// What the colours mean, in the lower right corner; above what is told of the pointer where both have no room.
fn legend(ui: &mut Ui, rect: Rect, legend: &Legend) {
    if *legend == Legend::None {
        return;
    }
    let area = egui::Area::new(ui.scope_id().with("legend"))
        .order(egui::Order::Middle)
        .interactable(false);
    let lift = if rect.width() < BOTH { 94.0 } else { 10.0 };
    let area =
        area.pivot(egui::Align2::RIGHT_BOTTOM).fixed_pos(rect.right_bottom() - vec2(10.0, lift));
    area.show(ui.ctx(), |ui| {
        card(ui).show(ui, |ui| match legend {
            Legend::None => {}
            Legend::Scale { label, ends, ramp } => {
                ui.label(RichText::new(*label).small().color(style::of(ui).weak));
                let (bar, _) = ui.allocate_exact_size(vec2(220.0, 10.0), Sense::hover());
                const STEPS: usize = 44;
                for step in 0..STEPS {
                    let [red, green, blue] = ramp.color((step as f64 + 0.5) / STEPS as f64);
                    let width = bar.width() / STEPS as f32;
                    let left = bar.left() + width * step as f32;
                    let cell = Rect::from_min_size(pos2(left, bar.top()), vec2(width + 0.5, 10.0));
                    ui.painter().rect_filled(cell, 0.0, Color32::from_rgb(red, green, blue));
                }
                let [low, high] = ends.map(crate::knobs::display_text);
                let middle = crate::knobs::display_text((ends[0] + ends[1]) / 2.0);
                let font = egui::TextStyle::Small.resolve(ui.style());
                let (row, _) = ui.allocate_exact_size(vec2(220.0, 12.0), Sense::hover());
                let places = [
                    (row.left_top(), egui::Align2::LEFT_TOP, low),
                    (row.center_top(), egui::Align2::CENTER_TOP, middle),
                    (row.right_top(), egui::Align2::RIGHT_TOP, high),
                ];
                for (at, align, text) in places {
                    ui.painter().text(at, align, text, font.clone(), style::of(ui).text);
                }
            }
            Legend::Keys(keys) => {
                for ([red, green, blue], text) in keys {
                    ui.horizontal(|ui| {
                        let (dot, _) = ui.allocate_exact_size(vec2(10.0, 10.0), Sense::hover());
                        let (fill, line) =
                            (Color32::from_rgb(*red, *green, *blue), style::of(ui).line);
                        let line = egui::Stroke::new(1.0, line);
                        ui.painter().rect(dot, 2.0, fill, line, egui::StrokeKind::Outside);
                        ui.label(RichText::new(text).small());
                    });
                }
            }
        });
    });
}
