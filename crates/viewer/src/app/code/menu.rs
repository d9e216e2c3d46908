//! The menu of the editor's commands.

use eframe::egui::{self, Ui};

use super::editor::CodeEditor;
use crate::session::Session;

/// Shows the button that opens the menu.
pub fn show(ui: &mut Ui, session: &mut Session, editor: &mut CodeEditor) {
    let menu = ui.menu_button("More", |ui| {
        let entry = |ui: &mut Ui, enabled: bool, name: &str, keys: &str, help: &str| {
            let button = egui::Button::new(name).shortcut_text(keys);
            let button = ui.add_enabled(enabled, button).on_hover_text(help);
            button.on_disabled_hover_text(help).clicked()
        };
        let is_editable = session.shown_draft().is_some();
        if entry(ui, true, "Find…", "Ctrl+F", "Find text in this file.") {
            editor.search(false, session);
        }
        if entry(ui, is_editable, "Replace…", "Ctrl+H", "Find and replace text in this file.") {
            editor.search(true, session);
        }
        ui.separator();
        let help = "Go to the definition of the name at the cursor, in an import or the library \
                    too. Ctrl + click does the same.";
        if entry(ui, true, "Go to definition", "F12", help) {
            editor.go_to_definition(session);
        }
        let help = "Go back to where the last jump began.";
        if entry(ui, editor.can_go_back(), "Go back", "Alt+Left", help) {
            editor.go_back(session);
        }
        ui.separator();
        if entry(ui, is_editable, "Format", "", "Write the text in the standard layout.") {
            editor.format(ui.ctx(), session);
        }
        let help = "Format a text whenever it is saved, unless it has syntax errors.";
        ui.checkbox(&mut session.format_on_save, "Format on save").on_hover_text(help);
    });
    menu.response.on_hover_text("Search, jumps and layout.");
}
