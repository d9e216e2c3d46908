//! What is wrong with the text, over the picture.

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{self, Color32, FontId, RichText, Ui, vec2};

use super::canvas::card;
use super::{Wish, editor, style};
use crate::findings::Finding;
use crate::session::Session;

/// The findings in the upper left corner; warnings only where they are asked for.
pub fn show(ui: &mut Ui, session: &Session, warnings: &mut bool, wishes: &mut Vec<Wish>) {
    let findings = &session.findings;
    if findings.all.is_empty() {
        return;
    }
    let rect = ui.max_rect();
    let errors = findings.errors();
    let area = egui::Area::new(ui.scope_id().with("findings")).order(egui::Order::Middle);
    area.fixed_pos(rect.left_top() + vec2(10.0, 10.0)).show(ui.ctx(), |ui| {
        ui.set_max_width((rect.width() - 20.0).clamp(120.0, 620.0));
        let others = findings.all.len() - errors;
        if errors > 0 || *warnings {
            let shown = |found: &&Finding| found.is_error || *warnings;
            let scroll = egui::ScrollArea::vertical()
                .max_height(rect.height() * 0.7)
                .min_scrolled_height(rect.height() * 0.7);
            scroll.show(ui, |ui| {
                for found in findings.all.iter().filter(shown) {
                    finding(ui, session, found, wishes);
                }
            });
        }
        if others > 0 {
            let text =
                if others == 1 { "1 warning".to_owned() } else { format!("{others} warnings") };
            let button =
                egui::Button::new(RichText::new(text).small().color(style::of(ui).warning))
                    .fill(style::of(ui).card);
            if ui.add(button).on_hover_text("Show or hide the warnings.").clicked() {
                *warnings = !*warnings;
            }
        }
    });
}

fn finding(ui: &mut Ui, session: &Session, found: &Finding, wishes: &mut Vec<Wish>) {
    let color = if found.is_error { style::of(ui).error } else { style::of(ui).warning };
    card(ui).stroke(egui::Stroke::new(1.0, color.gamma_multiply(0.6))).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.spacing_mut().item_spacing.y = 4.0;
        let kind = if found.is_error { "error" } else { "warning" };
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new(format!("{kind}[{}]", found.code)).strong().color(color));
            ui.label(RichText::new(&found.message).strong());
        });
        place(ui, session, found, wishes);
        ui.label(source_line(ui, found, color));
        for help in &found.help {
            ui.label(RichText::new(help).color(style::of(ui).weak));
        }
    });
}

fn place(ui: &mut Ui, session: &Session, found: &Finding, wishes: &mut Vec<Wish>) {
    ui.horizontal(|ui| {
        let link = egui::Link::new(RichText::new(found.location()).monospace().small());
        if ui.add(link).on_hover_text("Copy file:line:column.").clicked() {
            let path = session.path_of(found);
            let [line, column] = found.place;
            wishes.push(Wish::Copy(format!("{}:{line}:{column}", path.display())));
        }
        let Some(chosen) = editor::chosen() else { return };
        let link = egui::Link::new(RichText::new("edit").small());
        if ui.add(link).on_hover_text(format!("Open it in {chosen}.")).clicked()
            && let Err(error) = editor::open(&chosen, &session.path_of(found), found.place)
        {
            wishes.push(Wish::Remark(error));
        }
    });
}

/// The line, with what is meant marked in it and the label behind it.
fn source_line(ui: &Ui, found: &Finding, color: Color32) -> LayoutJob {
    let font = FontId::monospace(12.0);
    let plain = TextFormat::simple(font.clone(), style::of(ui).text);
    let mut marked = TextFormat::simple(font.clone(), color);
    marked.underline = egui::Stroke::new(1.5, color);
    let part = |range: std::ops::Range<usize>| -> String {
        found.line.chars().skip(range.start).take(range.len()).collect()
    };
    let mut job = LayoutJob::default();
    let number = TextFormat::simple(font.clone(), style::of(ui).weak);
    job.append(&format!("{:>4} ", found.place[0]), 0.0, number);
    job.append(&part(0..found.marked.start), 0.0, plain.clone());
    job.append(&part(found.marked.clone()), 0.0, marked);
    job.append(&part(found.marked.end..usize::MAX), 0.0, plain);
    if !found.label.is_empty() {
        job.append(&found.label, 16.0, TextFormat::simple(font, color));
    }
    job
}
