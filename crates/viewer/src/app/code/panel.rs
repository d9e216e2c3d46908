//! The panel with the scene's text, which can be edited, or whose numbers can be dragged.

use std::sync::Arc;

use eframe::egui::{Key, RichText, Ui};

use super::editor::CodeEditor;
use super::text_state::{editor_id, record_replaced};
use super::{menu, numbers, tab_bar};
use crate::app::action::Action;
use crate::app::{number_buttons, theme};
use crate::session::Session;
use crate::session::draft::Draft;
use crate::session::save_state::Saved;
use crate::session::tabs::TabFile;

/// The longest text that can be edited in the window, in bytes. Longer ones are shown as rows.
const MAX_EDITED_BYTES: usize = 256 << 10;

/// What dragging and clicking does in the panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CodeMode {
    /// Typing edits the text.
    #[default]
    Edit,
    /// Dragging a number changes it.
    Numbers,
}

/// Shows the panel.
pub fn show(
    ui: &mut Ui,
    session: &mut Session,
    (mode, editor): (&mut CodeMode, &mut CodeEditor),
    actions: &mut Vec<Action>,
) {
    ui.add_space(4.0);
    tab_bar::show(ui, session);
    let is_small = session.shown_text().len() <= MAX_EDITED_BYTES;
    let mut discards = false;
    ui.horizontal_wrapped(|ui| {
        let before = *mode;
        let edits = ui.add_enabled_ui(is_small, |ui| {
            let text = "Type to change the scene. Ctrl+Z undoes, Ctrl+S saves.";
            ui.selectable_value(mode, CodeMode::Edit, "Edit").on_hover_text(text);
        });
        let why = format!("Texts of more than {MAX_EDITED_BYTES} bytes are edited elsewhere.");
        edits.response.on_disabled_hover_text(why);
        let text = "Drag a number of the scene to change it, or click it to type.";
        let numbers = ui.selectable_value(mode, CodeMode::Numbers, "Drag numbers");
        if numbers.on_hover_text(text).clicked() {
            session.show_file(TabFile::Scene);
        }
        // Numbers of other files are edited.
        if *session.shown_file() != TabFile::Scene {
            *mode = CodeMode::Edit;
        }
        // The editor has the search.
        if is_small
            && ui.input(|it| {
                it.modifiers.command && [Key::F, Key::H].iter().any(|key| it.key_pressed(*key))
            })
        {
            *mode = CodeMode::Edit;
        }
        if before == CodeMode::Numbers && *mode == CodeMode::Edit {
            session.write_numbers_into_text();
        }
        if *mode == CodeMode::Edit && is_small {
            menu::show(ui, session, editor);
            editor.color_button(ui, session);
        }
        discards |= edited_state(ui, session);
    });
    let changed = session.param_values.changed_numbers() > 0;
    if let Some(model) = session.model.clone()
        && (changed || *mode == CodeMode::Numbers)
    {
        number_buttons::show(ui, session, &model, actions);
    }
    if session.shown_draft().is_some_and(Draft::is_in_conflict) {
        discards |= conflict(ui, session);
    }
    if discards {
        discard(ui, session);
    }
    ui.separator();
    match mode {
        CodeMode::Edit if is_small => editor.show(ui, session),
        CodeMode::Edit | CodeMode::Numbers => {
            editor.forget_cursor();
            numbers::show(ui, session);
        }
    }
    if discards {
        // The editor needs the keyboard, or Ctrl + Z would not reach it. Until it was shown, the
        // click on the button would take the keyboard away again.
        let id = editor_id(session.path(), session.shown_file());
        ui.memory_mut(|memory| memory.request_focus(id));
    }
}

/// Says whether the text is saved, with a button that saves it. Returns true if the user gives up
/// the edited text.
fn edited_state(ui: &mut Ui, session: &mut Session) -> bool {
    let Some(draft) = session.shown_draft() else {
        let text = RichText::new("library file, read-only").small();
        ui.label(text.color(theme::of(ui).weak));
        return false;
    };
    if !draft.is_edited() {
        let text = RichText::new("type to change the scene").small().color(theme::of(ui).weak);
        let help = "The text of the file. Edits in your own editor are followed, too.";
        ui.label(text).on_hover_text(help);
        return false;
    }
    let save = ui.small_button("Save");
    if save.on_hover_text("Write the text to its file (Ctrl+S).").clicked() {
        session.save_shown(Saved::All);
    }
    let revert = ui.small_button("Revert");
    let revert = revert.on_hover_text("Go back to the text of the file; Ctrl+Z undoes that.");
    ui.label(RichText::new("not saved").small().color(theme::of(ui).accent));
    revert.clicked()
}

/// Goes back to the text of the shown file, in one step to undo.
fn discard(ui: &Ui, session: &mut Session) {
    let Some(draft) = session.shown_draft() else { return };
    let [before, after] = [draft.text(), draft.file()].map(Arc::clone);
    let id = editor_id(session.path(), session.shown_file());
    record_replaced(ui.ctx(), id, [&before, &after]);
    session.edit_shown(Draft::discard);
}

/// Asks what happens to a text that was edited in the window and in the file. Returns true if the
/// user gives up the edited text.
fn conflict(ui: &mut Ui, session: &mut Session) -> bool {
    let color = theme::of(ui).warning;
    ui.label(
        RichText::new("The file was changed outside, and this text is not saved.").color(color),
    );
    let buttons = ui.horizontal_wrapped(|ui| {
        let load = ui.small_button("Load the file");
        let help = "Show the file's text in place of this; Ctrl+Z undoes that.";
        let load = load.on_hover_text(help);
        let keep = ui.small_button("Keep this text");
        if keep.on_hover_text("Saving this text then replaces the file's.").clicked() {
            session.edit_shown(Draft::keep);
        }
        load.clicked()
    });
    buttons.inner
}
