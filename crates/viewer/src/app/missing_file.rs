//! Offers to create the scene's file if there is none.

use std::path::PathBuf;

use eframe::egui::{self, Context, vec2};

use crate::session::Session;

/// Shows the offer below the message in the middle of the window. Returns the path if the user
/// accepts.
pub fn show(ctx: &Context, session: &Session) -> Option<PathBuf> {
    let path = session.path();
    if session.model.is_some() || session.problem.is_none() || path.exists() {
        return None;
    }
    let area = egui::Area::new(egui::Id::unique("missing")).order(egui::Order::Middle);
    let area = area.anchor(egui::Align2::CENTER_CENTER, vec2(0.0, 60.0));
    let shown = area.show(ctx, |ui| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let button = ui.button(format!("Create {name}"));
        button.on_hover_text(format!("Write a small scene to {}.", path.display())).clicked()
    });
    shown.inner.then(|| path.to_owned())
}
