//! The Markdown of descriptions: paragraphs, lists, code between backticks, and fenced code.

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{FontId, Ui};

use crate::app::theme;

/// The sizes of the fonts in points. The font of code looks larger at the same size.
const TEXT: f32 = 12.5;
const CODE: f32 = 12.0;
/// The space between paragraphs in points.
const PARAGRAPH: f32 = 3.0;

/// Shows a text, with code in the font of code.
pub fn show(ui: &mut Ui, markdown: &str) {
    let mut is_fenced = false;
    for line in markdown.trim().lines() {
        if line.starts_with("```") {
            is_fenced = !is_fenced;
        } else if line.is_empty() {
            ui.add_space(PARAGRAPH);
        } else {
            ui.label(laid_out(ui, line, is_fenced));
        }
    }
}

/// A line of text. Every second part between backticks is code; a fenced line is all code.
fn laid_out(ui: &Ui, line: &str, is_fenced: bool) -> LayoutJob {
    let palette = theme::of(ui);
    let code = TextFormat::simple(FontId::monospace(CODE), palette.accent);
    let text = TextFormat::simple(FontId::proportional(TEXT), palette.text);
    let mut job = LayoutJob::default();
    if is_fenced {
        job.append(line, 0.0, code);
        return job;
    }
    let line = line.strip_prefix("- ").map_or(line.to_owned(), |item| format!("• {item}"));
    for (index, part) in line.split('`').enumerate() {
        let format = if index.is_multiple_of(2) { &text } else { &code };
        job.append(part, 0.0, format.clone());
    }
    job
}
