//! The scene's text as rows in which numbers can be dragged.

use crate::app::number_widget::number_drag;
use crate::app::theme;
use crate::scene::model::Model;
use crate::scene::source_numbers::SourceNumber;
use crate::session::Session;
use std::sync::Arc;

use eframe::egui::{self, RichText, Ui};

/// Shows the text of the scene. While it has errors, no number can be dragged.
pub fn show(ui: &mut Ui, session: &mut Session) {
    let source = Arc::clone(session.text());
    let model = session.model.clone().filter(|model| model.source == *source);
    let lines: Vec<(usize, &str)> = lines(&source);
    let height = ui.text_style_height(&egui::TextStyle::Monospace) + 4.0;
    let scroll = egui::ScrollArea::both().auto_shrink(false);
    ui.spacing_mut().item_spacing.y = 0.0;
    scroll.show_rows(ui, height, lines.len(), |ui, rows| {
        for row in rows {
            let Some((start, text)) = lines.get(row) else { continue };
            ui.horizontal(|ui| {
                ui.set_height(height);
                ui.spacing_mut().item_spacing.x = 0.0;
                ui.spacing_mut().button_padding = egui::vec2(2.0, 0.0);
                ui.spacing_mut().interact_size = egui::vec2(12.0, height - 2.0);
                let number = format!("{:>4}  ", row + 1);
                ui.label(
                    RichText::new(number).monospace().color(theme::of(ui).weak.gamma_multiply(0.6)),
                );
                match &model {
                    Some(model) => line(ui, session, model, *start, text),
                    None => plain_line(ui, session, row, text),
                }
            });
        }
    });
}

/// The byte offset of each line, and the line without its ending.
fn lines(source: &str) -> Vec<(usize, &str)> {
    let mut start = 0;
    source
        .split('\n')
        .map(|line| {
            let at = start;
            start += line.len() + 1;
            (at, line.trim_end_matches('\r').trim_start_matches('\u{feff}'))
        })
        .collect()
}

fn line(ui: &mut Ui, session: &mut Session, model: &Model, start: usize, text: &str) {
    let end = start + text.len();
    let first = model.numbers.partition_point(|number| number.written.start < start);
    let numbers = model.numbers[first..].iter().take_while(|number| number.written.start < end);
    let mut from = 0;
    for number in numbers {
        plain(ui, text.get(from..number.written.start - start).unwrap_or_default());
        number_drag_of(ui, session, number);
        from = number.written.end - start;
    }
    plain(ui, text.get(from..).unwrap_or_default());
}

/// A line of a file with errors. Those of the line are marked.
fn plain_line(ui: &mut Ui, session: &Session, row: usize, text: &str) {
    let own = session.path().file_name().unwrap_or_default().to_string_lossy();
    let errors = session.diagnostics.all.iter().filter(|found| {
        found.is_error && found.file == own && found.position[0] as usize == row + 1
    });
    let Some((first, marked)) = errors.map(|found| (found, &found.marked)).next() else {
        return plain(ui, text);
    };
    let character = |index: usize| text.char_indices().nth(index).map_or(text.len(), |(at, _)| at);
    let [from, to] = [marked.start, marked.end].map(character);
    plain(ui, &text[..from]);
    let shown = RichText::new(&text[from..to]).monospace().color(theme::of(ui).error).underline();
    ui.label(shown).on_hover_text(&first.message);
    plain(ui, &text[to..]);
}

fn plain(ui: &mut Ui, text: &str) {
    if text.is_empty() {
        return;
    }
    let comment = text.trim_start().starts_with("//");
    let color = if comment { theme::of(ui).weak } else { theme::of(ui).text };
    ui.label(RichText::new(text).monospace().color(color));
}

fn number_drag_of(ui: &mut Ui, session: &mut Session, number: &SourceNumber) {
    let unit = if number.is_angle { 1f64.to_degrees() } else { 1.0 };
    let before = session.param_values.number(number);
    let mut value = before * unit;
    let [low, high] = number.range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let speed = (number.value.abs() * unit * 0.005).max(0.002);
    let drag = number_drag(&mut value).speed(speed).range(low * unit..=high * unit);
    let drag = drag.suffix(if number.is_angle { "deg" } else { "" });
    let changed = before != number.value;
    let response = ui
        .scope(|ui| {
            ui.style_mut().drag_value_text_style = egui::TextStyle::Monospace;
            if changed {
                ui.visuals_mut().override_text_color = Some(theme::of(ui).accent);
            }
            ui.add(drag)
        })
        .inner;
    let text = format!("Drag, or click to type. In the file: {}", number.text);
    if response.on_hover_text(text).changed() {
        session.param_values.set_number(number, value / unit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_have_their_byte_offsets() {
        assert_eq!(lines("a\r\nbc\n\nd"), [(0, "a"), (3, "bc"), (6, ""), (7, "d")]);
    }
}
