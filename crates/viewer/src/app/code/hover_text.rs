//! The description of what is under the pointer in the editor.

use std::ops::Range;
use std::sync::Arc;

use eframe::egui::{self, Response, Ui};
use sdfc_ide::{ExampleScene, Hover, ShapeFacts, hover};

use super::markdown;
use crate::app::picture_textures::PictureTextures;
use crate::compile::diagnostics::ShownDiagnostic;
use crate::session::Session;
use crate::session::tabs::TabFile;

/// The widest description in points.
const MAX_WIDTH: f32 = 420.0;

/// The last description, and the pictures of library entries that were shown.
#[derive(Debug, Default)]
pub struct HoverText {
    textures: PictureTextures<ExampleScene>,
    last: Option<Described>,
}

/// The description of the name at an offset of a text, with the facts of a model.
#[derive(Debug)]
struct Described {
    text: Arc<str>,
    /// The serial of the model; `None` if there was none.
    model: Option<u64>,
    offset: usize,
    hover: Option<Hover>,
}

impl HoverText {
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
        let Some(shown) = self.hover(session, at) else { return };
        response.clone().on_hover_ui_at_pointer(|ui| {
            ui.set_max_width(MAX_WIDTH);
            if let Some(example) = &shown.example {
                self.picture(ui, session, example);
            }
            markdown::show(ui, &shown.markdown);
        });
    }

    /// The description of the name at an offset of the shown text.
    fn hover(&mut self, session: &Session, offset: usize) -> Option<Hover> {
        let analysis = &session.answer_about_text()?.analysis;
        let text = session.shown_text();
        let model = session.model.as_ref().map(|model| model.serial);
        let is_last = |it: &&Described| {
            Arc::ptr_eq(&it.text, text) && (it.model, it.offset) == (model, offset)
        };
        if let Some(last) = self.last.as_ref().filter(is_last) {
            return last.hover.clone();
        }
        let found = hover(analysis, offset, &mut |call| facts(session, call));
        let text = Arc::clone(text);
        self.last = Some(Described { text, model, offset, hover: found.clone() });
        found
    }

    /// Shows the picture of an example; nothing until it is drawn.
    fn picture(&mut self, ui: &mut Ui, session: &mut Session, example: &ExampleScene) {
        let pictures = &mut session.entry_pictures;
        let Some(texture) = self.textures.get(ui.ctx(), pictures, example) else { return };
        let image = egui::Image::new(texture).corner_radius(4).alt_text("a picture of the entry");
        ui.add(image);
    }
}

/// The facts about the shapes that a call of the shown text made, if that text was compiled.
fn facts(session: &Session, call: Range<usize>) -> Option<ShapeFacts> {
    let model = session.model.as_ref().filter(|model| model.source == **session.shown_text());
    let model = model.filter(|_| *session.shown_file() == TabFile::Scene)?;
    let facts = model.scene.shape_facts(call)?;
    Some(ShapeFacts { cost: facts.cost(), quality: facts.quality })
}
