//! Asks whether edited text and changed numbers are saved before the scene is left.

use std::path::PathBuf;

use eframe::egui::{self, Context, RichText, Ui};

use super::theme;
use crate::session::Session;
use crate::session::save_state::SaveState;

/// A way to leave the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Closes the window.
    Close,
    /// Opens another scene.
    Open(PathBuf),
}

/// The question, while it is shown.
#[derive(Debug, Default)]
pub struct UnsavedDialog {
    exit: Option<Exit>,
    /// True if the scene is left as soon as the file is written.
    saving: bool,
}

impl UnsavedDialog {
    /// Returns the exit if nothing would be lost; otherwise asks.
    pub fn request(&mut self, exit: Exit, session: &Session) -> Option<Exit> {
        if !session.has_unsaved_changes() {
            return Some(exit);
        }
        *self = Self { exit: Some(exit), saving: false };
        None
    }

    /// Shows the question. Returns the exit once everything is saved or the user discards it.
    pub fn show(&mut self, ctx: &Context, session: &mut Session) -> Option<Exit> {
        let exit = self.exit.clone()?;
        let saved = self.saving && session.save_state() == SaveState::Idle;
        let mut leaves = saved;
        let mut stays = false;
        if !saved {
            let modal = egui::Modal::new(egui::Id::unique("unsaved"));
            let modal = modal.show(ctx, |ui| self.question(ui, &exit, session));
            (leaves, stays) = modal.inner;
            stays |= modal.should_close();
        }
        if leaves || stays {
            *self = Self::default();
        }
        leaves.then_some(exit)
    }

    /// Returns whether the scene is left and whether it stays open.
    fn question(&mut self, ui: &mut Ui, exit: &Exit, session: &mut Session) -> (bool, bool) {
        ui.set_width(360.0);
        for file in session.edited_files() {
            ui.label(format!("The edited text of {file} is not saved."));
        }
        match session.param_values.changed_numbers() {
            0 => {}
            1 => drop(ui.label("1 changed number is not saved to the file.")),
            changed => {
                ui.label(format!("{changed} changed numbers are not saved to the file."));
            }
        }
        let writing = self.saving && session.save_state() == SaveState::Writing;
        if let SaveState::Failed(why) = session.save_state()
            && self.saving
        {
            ui.label(RichText::new(why).color(theme::of(ui).error));
        } else if writing {
            ui.label(RichText::new("writing…").color(theme::of(ui).weak));
        }
        ui.add_space(6.0);
        let [save, discard] = match exit {
            Exit::Close => ["Save and close", "Close without saving"],
            Exit::Open(_) => ["Save and open", "Open without saving"],
        };
        let buttons = ui.horizontal(|ui| {
            let save = ui.add_enabled(!writing, egui::Button::new(save));
            if save.on_hover_text("Write texts and numbers to their files.").clicked() {
                self.saving = true;
                session.save_all();
            }
            let discard = ui.button(discard).on_hover_text("The changes are lost.");
            let cancel = ui.button("Cancel").on_hover_text("Stay with this scene (Esc).");
            (discard.clicked(), cancel.clicked())
        });
        buttons.inner
    }
}
