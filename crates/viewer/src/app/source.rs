//! The scene's text, with numbers that can be dragged.

use eframe::egui::{self, RichText, Ui};
use sdfc::graph::{Param, ParamKind};
use sdfc::lang::live_literals::{LiveLiteral, MAX_LIVE_LITERALS};

use super::params::drag;
use super::{Wish, style};
use crate::model::Model;
use crate::session::Session;

/// The text of the last good scene.
pub fn show(ui: &mut Ui, session: &mut Session, wishes: &mut Vec<Wish>) {
    let Some(model) = session.model.clone() else { return };
    ui.add_space(4.0);
    orders(ui, session, &model, wishes);
    ui.separator();
    let lines: Vec<(usize, &str)> = lines(&model.text);
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
                    RichText::new(number).monospace().color(style::of(ui).weak.gamma_multiply(0.6)),
                );
                line(ui, session, &model, *start, text);
            });
        }
    });
}

/// How many numbers have been moved, and what can be done with them.
pub fn orders(ui: &mut Ui, session: &mut Session, model: &Model, wishes: &mut Vec<Wish>) {
    let moved = session.knobs.moved_literals();
    ui.horizontal(|ui| {
        let what = match moved {
            0 if model.literals().next().is_none() => "no number to drag".to_owned(),
            0 if model.scene.slots().len() == MAX_LIVE_LITERALS => {
                format!("drag one of {MAX_LIVE_LITERALS} numbers")
            }
            0 => "drag a number".to_owned(),
            1 => "1 number moved".to_owned(),
            moved => format!("{moved} numbers moved"),
        };
        let color = if moved > 0 { style::of(ui).accent } else { style::of(ui).weak };
        let help = format!(
            "Numbers that decide what is built stay as they are, and so do those of a scene whose many parts are \
             loops. Of more than {MAX_LIVE_LITERALS} those move that stand around the last edit: change another in the file, \
             which takes a new shader once."
        );
        ui.label(RichText::new(what).small().color(color)).on_hover_text(help);
        let order = |ui: &mut Ui, name: &str, help: &str| {
            let button = ui.add_enabled(moved > 0, egui::Button::new(name).small());
            let button = button.on_hover_text(help);
            button.on_disabled_hover_text("No number of the text has been moved.").clicked()
        };
        if order(ui, "Write", "Write them into the file.") {
            session.write_literals();
        }
        if order(ui, "Copy", "Copy the text with them.") {
            wishes.push(Wish::Copy(session.knobs.rewritten(model)));
        }
        if order(ui, "Reset", "All back to what the file says.") {
            session.knobs.forget_literals();
        }
    });
}

/// Start of each line and the line, without its end.
fn lines(text: &str) -> Vec<(usize, &str)> {
    let mut start = 0;
    text.split('\n')
        .map(|line| {
            let at = start;
            start += line.len() + 1;
            (at, line.trim_end_matches('\r').trim_start_matches('\u{feff}'))
        })
        .collect()
}

fn line(ui: &mut Ui, session: &mut Session, model: &Model, start: usize, text: &str) {
    let end = start + text.len();
    let mut inside: Vec<(&LiveLiteral, &Param)> = model
        .literals()
        .filter(|(slot, _)| (start..end).contains(&(slot.span.start as usize)))
        .collect();
    inside.sort_by_key(|(slot, _)| slot.span.start);
    let mut from = 0;
    for (slot, param) in inside {
        let at = slot.span.start as usize - start;
        plain(ui, text.get(from..at).unwrap_or_default());
        number(ui, session, slot, param);
        from = slot.span.end as usize - start;
    }
    plain(ui, text.get(from..).unwrap_or_default());
}

fn plain(ui: &mut Ui, text: &str) {
    if text.is_empty() {
        return;
    }
    let comment = text.trim_start().starts_with("//");
    let color = if comment { style::of(ui).weak } else { style::of(ui).text };
    ui.label(RichText::new(text).monospace().color(color));
}

fn number(ui: &mut Ui, session: &mut Session, slot: &LiveLiteral, param: &Param) {
    let is_angle = param.kind == ParamKind::Angle;
    let unit = if is_angle { 1f64.to_degrees() } else { 1.0 };
    let before = session.knobs.literal(slot);
    let mut value = before * unit;
    let [low, high] = param.range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let speed = (slot.value.abs() * unit * 0.005).max(0.002);
    let drag = drag(&mut value).speed(speed).range(low * unit..=high * unit);
    let drag = drag.suffix(if is_angle { "deg" } else { "" });
    let moved = before != slot.value;
    let response = ui
        .scope(|ui| {
            ui.style_mut().drag_value_text_style = egui::TextStyle::Monospace;
            if moved {
                ui.visuals_mut().override_text_color = Some(style::of(ui).accent);
            }
            ui.add(drag)
        })
        .inner;
    let text = format!("Drag, or click to type. {} in the file.", param.summary);
    if response.on_hover_text(text).changed() {
        session.knobs.set_literal(slot, value / unit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_know_where_they_start() {
        assert_eq!(lines("a\r\nbc\n\nd"), [(0, "a"), (3, "bc"), (6, ""), (7, "d")]);
    }
}
