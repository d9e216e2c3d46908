//! The keys that work wherever the pointer is.

use eframe::egui::{self, Context, Key};

use super::action::Action;
use super::help::SIDES;
use super::open_panels::OpenPanels;
use crate::session::Session;
use crate::session::save_state::Saved;

/// Handles the keys that were pressed. While text is being typed, only saving and closing work.
pub fn handle(
    ctx: &Context,
    session: &mut Session,
    panels: &mut OpenPanels,
    actions: &mut Vec<Action>,
) {
    if ctx.input_mut(|input| input.consume_key(egui::Modifiers::COMMAND, Key::S)) {
        session.save_shown(Saved::All);
    }
    if ctx.input_mut(|input| input.consume_key(egui::Modifiers::COMMAND, Key::Q)) {
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
    }
    let searches = |key| ctx.input(|input| input.modifiers.command && input.key_pressed(key));
    if searches(Key::F) || searches(Key::H) {
        // The editor handles the key.
        panels.code = true;
    }
    if ctx.text_edit_focused() {
        return;
    }
    let pressed = |key| ctx.input(|input| input.modifiers.is_none() && input.key_pressed(key));
    let with_ctrl = |key| ctx.input(|input| input.modifiers.command && input.key_pressed(key));
    for (key, side) in SIDES {
        if pressed(key) {
            session.move_camera(|camera| camera.look_from(side));
        }
        if with_ctrl(key) {
            session.move_camera(|camera| camera.look_from(side.opposite()));
        }
    }
    if pressed(Key::F) || pressed(Key::Period) {
        session.fit_view();
    }
    if pressed(Key::Home) || pressed(Key::H) {
        session.reset_camera();
    }
    if pressed(Key::P) || pressed(Key::Num5) {
        session.move_camera(|camera| camera.set_parallel(!camera.is_parallel()));
    }
    if pressed(Key::B) {
        session.show_bounds = !session.show_bounds;
    }
    if pressed(Key::C)
        && let Some(camera) = session.camera()
    {
        actions.push(Action::Copy(camera.text()));
    }
    // Space also presses the button that has the keyboard focus.
    if pressed(Key::Space) && !ctx.egui_wants_keyboard_input() && session.is_animated() {
        session.clock.toggle();
    }
    if pressed(Key::V) {
        // A slow frame may have several presses.
        for _ in 0..ctx.input(|input| input.num_presses(Key::V)) {
            session.mode = session.mode.next();
        }
    }
    if pressed(Key::R) {
        session.refine = !session.refine;
    }
    if ctx.input_mut(|input| input.consume_key(egui::Modifiers::COMMAND, Key::E)) {
        panels.export = !panels.export;
    }
    if pressed(Key::K) {
        panels.controls = !panels.controls;
    }
    if pressed(Key::T) {
        panels.code = !panels.code;
    }
    if ctx.input(|input| input.key_pressed(Key::Questionmark)) || pressed(Key::F1) {
        panels.help = !panels.help;
    }
    if pressed(Key::Escape) && !egui_closes(ctx) {
        (panels.help, panels.export) = (false, false);
    }
}

/// Returns true if egui closes a menu or a dialog on Esc. The key then means nothing else.
pub fn egui_closes(ctx: &Context) -> bool {
    egui::Popup::is_any_open(ctx) || ctx.memory(|memory| memory.top_modal_layer().is_some())
}
