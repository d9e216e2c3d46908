//! The list of keys and mouse buttons.

use eframe::egui::{self, Context, Key};

use super::theme;
use crate::session::orbit_camera::Side;

/// The keys that look from a side.
pub const SIDES: [(Key, Side); 6] = [
    (Key::Num1, Side::Front),
    (Key::Num2, Side::Back),
    (Key::Num3, Side::Right),
    (Key::Num4, Side::Left),
    (Key::Num7, Side::Top),
    (Key::Num8, Side::Bottom),
];

const ROWS: [(&str, &str); 28] = [
    ("drag", "orbit around the pivot"),
    ("right or middle drag", "pan"),
    ("wheel", "zoom at the pointer"),
    ("click", "light the code of the shape"),
    ("double-click", "orbit around that point"),
    ("W A S D Q E", "fly; faster with Shift"),
    ("Alt + drag", "look around"),
    ("F, .", "fit view: see the whole scene"),
    ("H, Home", "reset camera: the scene's own"),
    ("1 2 3 4 7 8", "front, back, right, left, top, bottom; with Ctrl the other side"),
    ("click the end of an axis", "look along it"),
    ("P, 5", "perspective or orthographic"),
    ("B", "show the scene's bounds"),
    ("C", "copy the camera to paste into the scene"),
    ("V", "next view"),
    ("Space", "play or pause the time"),
    ("Ctrl + S", "save the shown text; for the scene also changed values"),
    ("Ctrl + F, Ctrl + H", "find, replace text"),
    ("F12, Ctrl + click", "go to the definition of a name"),
    ("Alt + Left", "go back"),
    ("Alt + drag in the code", "change a number"),
    ("Ctrl + E", "export a picture, an animation, a shader"),
    ("K, T", "show the panel “Controls”, “Code”"),
    ("R", "pause or resume refining the picture"),
    ("Esc", "close a menu or a dialog"),
    ("drop a file", "open that scene"),
    ("?, F1", "show this list"),
    ("Ctrl + Q", "close the window"),
];

/// The room that the list needs, in points. egui shows a window whose size it does not know cut off
/// until the next frame, which may be long after.
const SIZE: [f32; 2] = [580.0, 760.0];

/// Shows the list if it is open.
pub fn show(ctx: &Context, open: &mut bool) {
    let window = egui::Window::new("Keys and mouse")
        .open(open)
        .resizable(false)
        .collapsible(false)
        .default_size(SIZE)
        .vscroll(true);
    window.anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0]).show(ctx, |ui| {
        egui::Grid::new("keys").num_columns(2).spacing([24.0, 6.0]).show(ui, |ui| {
            for (key, what) in ROWS {
                ui.label(egui::RichText::new(key).monospace().color(theme::of(ui).accent));
                ui.label(what);
                ui.end_row();
            }
        });
    });
}
