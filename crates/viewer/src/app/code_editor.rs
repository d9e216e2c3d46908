//! An editor of the scene's text: colours, line numbers, underlined errors, undo and redo.

use std::ops::Range;
use std::sync::Arc;

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{self, Color32, Event, FontId, Galley, Key, Modifiers, Stroke, TextBuffer, Ui};
use sdfc_syntax::{Class, classes};

use super::theme::{self, Palette};
use crate::compile::diagnostics::ShownDiagnostic;
use crate::session::Session;

/// The width of the line numbers in points.
const GUTTER: f32 = 40.0;
/// What the Tab key inserts.
const INDENT: &str = "  ";

/// Shows the editor. What is typed becomes the text of the session.
pub fn show(ui: &mut Ui, session: &mut Session) {
    let palette = theme::of(ui);
    let found: Vec<ShownDiagnostic> = session.diagnostics_of_text().cloned().collect();
    let marks: Vec<Mark> = found.iter().map(|found| Mark::of(found, palette)).collect();
    let font = egui::TextStyle::Monospace.resolve(ui.style());
    let mut layouter = |ui: &Ui, text: &dyn TextBuffer, _: f32| -> Arc<Galley> {
        let job = highlighted(text.as_str(), &marks, palette, &font);
        ui.fonts_mut(|fonts| fonts.layout_job(job))
    };
    let mut text = session.text().to_string();
    let id = egui::Id::unique("code editor");
    if ui.memory(|memory| memory.has_focus(id)) {
        // Tab would move the focus.
        ui.input_mut(|input| {
            if input.consume_key(Modifiers::NONE, Key::Tab) {
                input.events.push(Event::Text(INDENT.to_owned()));
            }
        });
    }
    egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            ui.add_space(GUTTER);
            let edit = egui::TextEdit::multiline(&mut text)
                .id(id)
                .frame(egui::Frame::NONE)
                .code_editor()
                .desired_width(f32::INFINITY)
                .desired_rows(8)
                .layouter(&mut layouter);
            let output = edit.show(ui);
            ui.ctx().accesskit_node_builder(id, |node| node.set_label("the scene's text"));
            line_numbers(ui, &output.galley, output.galley_pos);
            if output.response.changed() {
                session.edit(|draft| draft.set_text(&text));
            } else if let Some(pointer) = output.response.hover_pos() {
                let cursor = output.galley.cursor_from_pos(pointer - output.galley_pos);
                let at = byte_of(&text, cursor.index.0);
                if let Some(under) = found.iter().find(|found| found.range.contains(&at)) {
                    let mut shown = under.message.clone();
                    for line in under.help.iter().filter(|line| !line.is_empty()) {
                        shown = format!("{shown}\n{line}");
                    }
                    output.response.response.clone().on_hover_text_at_pointer(shown);
                }
            }
        });
    });
}

/// The byte offset of a character.
fn byte_of(text: &str, character: usize) -> usize {
    text.char_indices().nth(character).map_or(text.len(), |(at, _)| at)
}

/// Paints a number in front of each visible line.
fn line_numbers(ui: &Ui, galley: &Galley, at: egui::Pos2) {
    let font = egui::TextStyle::Monospace.resolve(ui.style());
    let color = theme::of(ui).weak.gamma_multiply(0.6);
    let clip = ui.clip_rect();
    for (index, row) in galley.rows.iter().enumerate() {
        let row = row.rect().translate(at.to_vec2());
        if row.bottom() >= clip.top() && row.top() <= clip.bottom() {
            let position = egui::pos2(at.x - 12.0, row.center().y);
            let number = (index + 1).to_string();
            let align = egui::Align2::RIGHT_CENTER;
            ui.painter().text(position, align, number, font.clone(), color);
        }
    }
}

/// An underlined range.
struct Mark {
    range: Range<usize>,
    color: Color32,
}

impl Mark {
    fn of(found: &ShownDiagnostic, palette: &Palette) -> Self {
        let color = if found.is_error { palette.error } else { palette.warning };
        let Range { start, end } = found.range;
        // An empty range, as at the end of a line, would not be seen.
        Self { range: start..end.max(start + 1), color }
    }
}

/// The text with its colours. Lines are not wrapped.
fn highlighted(text: &str, marks: &[Mark], palette: &Palette, font: &FontId) -> LayoutJob {
    let mut job = LayoutJob::default();
    job.wrap.max_width = f32::INFINITY;
    let mut ends: Vec<usize> = Vec::new();
    let tokens = classes(text);
    ends.extend(tokens.iter().flat_map(|(_, range)| [range.start, range.end]));
    ends.extend(marks.iter().flat_map(|mark| [mark.range.start, mark.range.end]));
    ends.extend([0, text.len()]);
    ends.retain(|end| text.is_char_boundary(*end));
    ends.sort_unstable();
    ends.dedup();
    for pair in ends.windows(2) {
        let [start, end] = [pair[0], pair[1]];
        let token = tokens.partition_point(|(_, range)| range.end <= start);
        let token = tokens.get(token).filter(|(_, range)| range.start <= start);
        let color = token.map_or(palette.text, |(class, _)| color_of(*class, palette));
        let mut format = TextFormat::simple(font.clone(), color);
        if let Some((Class::Color, range)) = token
            && let Ok(color) = Color32::from_hex(&text[range.clone()])
        {
            format.underline = Stroke::new(3.0, color);
        }
        if let Some(mark) = marks.iter().find(|mark| mark.range.contains(&start)) {
            format.underline = Stroke::new(1.5, mark.color);
        }
        job.append(&text[start..end], 0.0, format);
    }
    job
}

fn color_of(class: Class, palette: &Palette) -> Color32 {
    match class {
        Class::Comment | Class::Docs => palette.weak,
        Class::Keyword => palette.link,
        Class::Number | Class::Color => palette.accent,
        Class::Text => palette.warning,
        Class::Name
        | Class::Operator
        | Class::Open
        | Class::Close
        | Class::Punctuation
        | Class::Unknown => palette.text,
    }
}
