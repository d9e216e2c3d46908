//! The list of completions below the cursor.

use eframe::egui::{self, Key, Modifiers, Pos2, RichText, Ui};
use sdfc_ide::Completion;

use crate::app::theme;

/// The list, while it is open.
#[derive(Clone, Copy, Debug, Default)]
pub struct CompletionList {
    /// True while the user types; moving the cursor closes the list.
    pub typing: bool,
    chosen: usize,
}

impl CompletionList {
    /// Closes the list if Esc is pressed. Returns true if it was open.
    pub fn close_by_key(&mut self, ui: &Ui) -> bool {
        let closes =
            self.typing && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape));
        self.typing &= !closes;
        closes
    }

    /// Handles the keys of the list before the editor gets them. Returns the accepted completion.
    pub fn accept_by_key<'c>(
        &mut self,
        ui: &Ui,
        items: &[&'c Completion],
    ) -> Option<&'c Completion> {
        if !self.typing || items.is_empty() {
            self.chosen = 0;
            return None;
        }
        let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        if pressed(Key::ArrowDown) {
            self.chosen += 1;
        }
        if pressed(Key::ArrowUp) {
            self.chosen += items.len() - 1;
        }
        self.chosen %= items.len();
        if pressed(Key::Tab) { items.get(self.chosen).copied() } else { None }
    }

    /// Shows the list. Returns the completion that is clicked.
    pub fn show<'c>(&self, ui: &Ui, at: Pos2, items: &[&'c Completion]) -> Option<&'c Completion> {
        if !self.typing || items.is_empty() {
            return None;
        }
        let area = egui::Area::new(egui::Id::unique("completions")).order(egui::Order::Foreground);
        let area = area.fixed_pos(at).constrain(true);
        let shown = area.show(ui.ctx(), |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_max_width(420.0);
                ui.spacing_mut().item_spacing.y = 1.0;
                let mut clicked = None;
                for (index, item) in items.iter().enumerate() {
                    let text = RichText::new(&item.label).monospace();
                    let entry = ui.selectable_label(index == self.chosen, text);
                    if entry.on_hover_text("Insert this (Tab).").clicked() {
                        clicked = Some(*item);
                    }
                }
                if let Some(item) = items.get(self.chosen) {
                    ui.separator();
                    let color = theme::of(ui).weak;
                    for line in [&item.detail, &item.docs] {
                        ui.label(RichText::new(line).small().color(color));
                    }
                    ui.label(RichText::new("Tab inserts").small().color(color));
                }
                clicked
            })
        });
        shown.inner.inner
    }
}
