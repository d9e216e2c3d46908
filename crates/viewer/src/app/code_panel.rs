//! The panel with the scene's source, in which live literals can be dragged.

use eframe::egui::{self, RichText, Ui};
use sdfc_graph::{Param, ParamKind};
use sdfc_lang::live_literals::LiveLiteral;

use super::action::Action;
use super::number_widget::number_drag;
use super::{literal_buttons, theme};
use crate::scene::model::Model;
use crate::session::Session;

/// Shows the source of the last good scene.
pub fn show(ui: &mut Ui, session: &mut Session, actions: &mut Vec<Action>) {
    let Some(model) = session.model.clone() else { return };
    ui.add_space(4.0);
    literal_buttons::show(ui, session, &model, actions);
    ui.separator();
    let lines: Vec<(usize, &str)> = lines(&model.source);
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
                line(ui, session, &model, *start, text);
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
    let mut literals: Vec<(&LiveLiteral, &Param)> = model
        .literals()
        .filter(|(literal, _)| (start..end).contains(&(literal.span.start as usize)))
        .collect();
    literals.sort_by_key(|(literal, _)| literal.span.start);
    let mut from = 0;
    for (literal, param) in literals {
        let at = literal.span.start as usize - start;
        plain(ui, text.get(from..at).unwrap_or_default());
        number(ui, session, literal, param);
        from = literal.span.end as usize - start;
    }
    plain(ui, text.get(from..).unwrap_or_default());
}

fn plain(ui: &mut Ui, text: &str) {
    if text.is_empty() {
        return;
    }
    let comment = text.trim_start().starts_with("//");
    let color = if comment { theme::of(ui).weak } else { theme::of(ui).text };
    ui.label(RichText::new(text).monospace().color(color));
}

fn number(ui: &mut Ui, session: &mut Session, literal: &LiveLiteral, param: &Param) {
    let is_angle = param.kind == ParamKind::Angle;
    let unit = if is_angle { 1f64.to_degrees() } else { 1.0 };
    let before = session.param_values.literal(literal);
    let mut value = before * unit;
    let [low, high] = param.range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let speed = (literal.value.abs() * unit * 0.005).max(0.002);
    let drag = number_drag(&mut value).speed(speed).range(low * unit..=high * unit);
    let drag = drag.suffix(if is_angle { "deg" } else { "" });
    let changed = before != literal.value;
    let response = ui
        .scope(|ui| {
            ui.style_mut().drag_value_text_style = egui::TextStyle::Monospace;
            if changed {
                ui.visuals_mut().override_text_color = Some(theme::of(ui).accent);
            }
            ui.add(drag)
        })
        .inner;
    let text = format!("Drag, or click to type. In the file: {}", param.summary);
    if response.on_hover_text(text).changed() {
        session.param_values.set_literal(literal, value / unit);
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
