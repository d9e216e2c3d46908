//! The description of what is under the pointer in the editor.

use std::collections::BTreeMap;

use eframe::egui::{self, ColorImage, Response, TextureHandle, TextureOptions, Ui};
use sdfc_ide::{definition, hover};

use crate::compile::diagnostics::ShownDiagnostic;
use crate::language::entry_pictures::{EntryId, SIZE};
use crate::session::Session;

/// The widest description in points.
const MAX_WIDTH: f32 = 420.0;

/// The pictures of library entries that were shown.
#[derive(Default)]
pub struct HoverPictures(BTreeMap<EntryId, TextureHandle>);

impl HoverPictures {
    /// Shows the errors at an offset of the shown text, else the description of the name there,
    /// with a picture of a library entry.
    pub fn describe(
        &mut self,
        response: &Response,
        session: &mut Session,
        found: &[ShownDiagnostic],
        at: usize,
    ) {
        if let Some(under) = found.iter().find(|found| found.range.contains(&at)) {
            let lines = std::iter::once(&under.message).chain(&under.help);
            let lines: Vec<&str> =
                lines.map(String::as_str).filter(|line| !line.is_empty()).collect();
            response.clone().on_hover_text_at_pointer(lines.join("\n"));
            return;
        }
        let Some(analysis) = session.answer_about_text().map(|answer| &answer.analysis) else {
            return;
        };
        let Some(shown) = hover(analysis, at, &mut |_| None) else { return };
        let entry = definition(analysis, at).and_then(|location| EntryId::at(&location));
        let lines = shown.markdown.lines().filter(|line| !line.starts_with("```"));
        let text = lines.collect::<Vec<_>>().join("\n");
        response.clone().on_hover_ui_at_pointer(|ui| {
            ui.set_max_width(MAX_WIDTH);
            if let Some(entry) = entry {
                self.picture(ui, session, entry);
            }
            ui.label(text.trim());
        });
    }

    /// Shows the picture of an entry; nothing until it is drawn.
    fn picture(&mut self, ui: &mut Ui, session: &mut Session, entry: EntryId) {
        let texture = match self.0.get(&entry) {
            Some(texture) => texture,
            None => {
                let Some(rgb) = session.entry_pictures.get(entry) else { return };
                let image = ColorImage::from_rgb(SIZE.map(|side| side as usize), rgb);
                let texture = ui.ctx().load_texture("entry", image, TextureOptions::LINEAR);
                self.0.entry(entry).or_insert(texture)
            }
        };
        let image = egui::Image::new(texture).corner_radius(4).alt_text("a picture of the entry");
        ui.add(image);
    }
}

impl std::fmt::Debug for HoverPictures {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("HoverPictures").field(&self.0.len()).finish()
    }
}
