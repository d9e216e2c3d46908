//! Asks whether changed numbers are saved before the window closes.

use eframe::egui::{self, Context, ViewportCommand};

use crate::session::Session;

/// The state of the question.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CloseDialog {
    /// The window stays open.
    #[default]
    Hidden,
    /// The user tried to close the window with changed numbers.
    Asking,
    /// The window may close.
    Confirmed,
}

impl CloseDialog {
    /// Prevents closing while changed numbers would be lost, and asks.
    pub fn show(&mut self, ctx: &Context, session: &Session) {
        let closing = ctx.input(|input| input.viewport().close_requested());
        let changed = session.param_values.changed_literals();
        if closing && *self != Self::Confirmed && changed > 0 {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            *self = Self::Asking;
        }
        if *self != Self::Asking {
            return;
        }
        let modal = egui::Modal::new(egui::Id::unique("close")).show(ctx, |ui| {
            ui.set_width(340.0);
            let text = match changed {
                1 => "1 changed number is not saved to the file.".to_owned(),
                changed => format!("{changed} changed numbers are not saved to the file."),
            };
            ui.label(text);
            ui.add_space(6.0);
            ui.horizontal(|ui| {
                let save = ui.button("Save and close");
                if save.on_hover_text("Write the numbers to the scene's file.").clicked() {
                    session.save_literals();
                    *self = Self::Confirmed;
                }
                let discard = ui.button("Close without saving");
                if discard.on_hover_text("The changed numbers are lost.").clicked() {
                    *self = Self::Confirmed;
                }
                if ui.button("Cancel").on_hover_text("Keep the window open (Esc).").clicked() {
                    *self = Self::Hidden;
                }
            });
        });
        if modal.should_close() && *self == Self::Asking {
            *self = Self::Hidden;
        }
        if *self == Self::Confirmed {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
    }
}
