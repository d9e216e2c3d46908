//! How many numbers of the source have been changed, and buttons to save, copy or reset them.

use eframe::egui::{self, RichText, Ui};
use sdfc_lang::live_literals::MAX_LIVE_LITERALS;

use super::action::Action;
use super::theme;
use crate::scene::model::Model;
use crate::session::Session;
use crate::session::save_state::Saved;

/// Shows the count and the buttons.
pub fn show(ui: &mut Ui, session: &mut Session, model: &Model, actions: &mut Vec<Action>) {
    let changed = session.param_values.changed_numbers();
    ui.horizontal_wrapped(|ui| {
        let text = match changed {
            0 if model.numbers.is_empty() => "no number can be dragged".to_owned(),
            0 if model.scene.live_literals().len() == MAX_LIVE_LITERALS => {
                format!("{MAX_LIVE_LITERALS} numbers can be dragged")
            }
            0 => "drag a number".to_owned(),
            1 => "1 number changed".to_owned(),
            changed => format!("{changed} numbers changed"),
        };
        let color = if changed > 0 { theme::of(ui).accent } else { theme::of(ui).weak };
        let help = format!(
            "Numbers that decide the scene's structure cannot be dragged, nor can those of a scene \
             whose parts are drawn by a loop. In a scene with more than {MAX_LIVE_LITERALS} \
             numbers, those nearest to your last edit can; edit another one in the file to move on."
        );
        ui.label(RichText::new(text).small().color(color)).on_hover_text(help);
        let button = |ui: &mut Ui, name: &str, help: &str| {
            let button = ui.add_enabled(changed > 0, egui::Button::new(name).small());
            let button = button.on_hover_text(help);
            button.on_disabled_hover_text("No number has been changed.").clicked()
        };
        if button(ui, "Save to file", "Write the changed numbers to the scene's file.") {
            session.save_to_file(Saved::Numbers);
        }
        if button(ui, "Copy", "Copy the source with the changed numbers.") {
            actions.push(Action::Copy(session.param_values.source_with_values(&model.source)));
        }
        if button(ui, "Reset", "Reset all numbers to the values in the file.") {
            session.param_values.reset_numbers();
        }
    });
}
