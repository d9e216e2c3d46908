//! The tabs of the panel "Code": the scene, its imports, and a file of the library.

use eframe::egui::{RichText, Ui};

use crate::app::theme;
use crate::session::Session;
use crate::session::draft::Draft;
use crate::session::tabs::TabFile;

/// Shows a tab for each file if there are several.
pub fn show(ui: &mut Ui, session: &mut Session) {
    let tabs = session.tabs();
    if tabs.len() < 2 {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for file in tabs {
            tab(ui, session, file);
        }
    });
}

fn tab(ui: &mut Ui, session: &mut Session, file: TabFile) {
    let name = file.name(session.path());
    let is_edited = session.draft_of(&file).is_some_and(Draft::is_edited);
    let title = if is_edited { format!("{name} •") } else { name };
    let color = if is_edited { theme::of(ui).accent } else { theme::of(ui).text };
    let help = match &file {
        TabFile::Scene => "The scene.",
        TabFile::Import(_) => "A file that the scene imports. Editing it compiles the scene.",
        TabFile::Library(_) => "A file of sdfc's library. It cannot be changed.",
    };
    let is_shown = *session.shown_file() == file;
    let label = ui.selectable_label(is_shown, RichText::new(title).color(color));
    if label.on_hover_text(help).clicked() {
        session.show_file(file.clone());
    }
    if matches!(file, TabFile::Library(_))
        && ui.small_button("×").on_hover_text("Close this file.").clicked()
    {
        session.close_library_file();
    }
}
