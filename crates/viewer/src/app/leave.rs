//! Whether moved numbers are to be written before the window goes.

use eframe::egui::{self, Context, ViewportCommand};

use crate::session::Session;

/// What has been asked and answered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Leaving {
    /// Nothing yet.
    #[default]
    Stays,
    /// The window was to be closed, with numbers that are not in the file.
    Asks,
    /// It may go.
    Goes,
}

impl Leaving {
    /// Holds the window back where something would be lost, and asks.
    pub fn show(&mut self, ctx: &Context, session: &Session) {
        let closes = ctx.input(|input| input.viewport().close_requested());
        if closes && *self != Self::Goes && session.knobs.moved_literals() > 0 {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            *self = Self::Asks;
        }
        if *self != Self::Asks {
            return;
        }
        let modal = egui::Modal::new(egui::Id::unique("leaving")).show(ctx, |ui| {
            ui.set_width(320.0);
            let text = match session.knobs.moved_literals() {
                1 => "A moved number is not in the file.".to_owned(),
                moved => format!("{moved} moved numbers are not in the file."),
            };
            ui.label(text);
            ui.add_space(6.0);
            ui.horizontal(|ui| {
                if ui.button("Write and close").on_hover_text("Write them into the file.").clicked()
                {
                    session.write_literals();
                    *self = Self::Goes;
                }
                if ui.button("Close").on_hover_text("They are forgotten.").clicked() {
                    *self = Self::Goes;
                }
                if ui.button("Stay").on_hover_text("Esc").clicked() {
                    *self = Self::Stays;
                }
            });
        });
        if modal.should_close() && *self == Self::Asks {
            *self = Self::Stays;
        }
        if *self == Self::Goes {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
    }
}
