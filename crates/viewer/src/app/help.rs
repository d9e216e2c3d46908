//! What the keys and buttons do.

use eframe::egui::{self, Context, Key};

use super::style;
use crate::orbit::Side;

/// Keys that look from a side.
pub const SIDES: [(Key, Side); 6] = [
    (Key::Num1, Side::Front),
    (Key::Num2, Side::Back),
    (Key::Num3, Side::Right),
    (Key::Num4, Side::Left),
    (Key::Num7, Side::Top),
    (Key::Num8, Side::Bottom),
];

const ROWS: [(&str, &str); 20] = [
    ("drag", "turn about the pivot"),
    ("right or middle drag", "move sideways"),
    ("wheel", "come nearer to what is under the pointer"),
    ("double click", "turn about that point"),
    ("W A S D Q E", "fly; with shift, faster"),
    ("alt drag", "look around"),
    ("F", "see all of the scene"),
    ("H, Home", "the scene's own camera"),
    ("1 2 3 4 7 8", "front, back, right, left, top, bottom"),
    ("P", "perspective or parallel rays"),
    ("B", "axes, and the box that the scene lies in"),
    ("C", "copy the camera, to paste into the scene"),
    ("V", "next view"),
    ("Space", "play or pause the time"),
    ("Ctrl S", "save a picture, an animation, the shader, the window"),
    ("K, T", "panel of knobs, panel of the text"),
    ("Esc", "stop refining, and go on"),
    ("drop a file", "show that scene"),
    ("?", "this"),
    ("Ctrl Q", "close the window"),
];

/// The window with all of it.
pub fn show(ctx: &Context, open: &mut bool) {
    let window =
        egui::Window::new("Keys and buttons").open(open).resizable(false).collapsible(false);
    window.anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0]).show(ctx, |ui| {
        egui::Grid::new("keys").num_columns(2).spacing([24.0, 6.0]).show(ui, |ui| {
            for (key, what) in ROWS {
                ui.label(egui::RichText::new(key).monospace().color(style::of(ui).accent));
                ui.label(what);
                ui.end_row();
            }
        });
    });
}
