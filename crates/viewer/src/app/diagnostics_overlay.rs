//! Errors and warnings over the picture.

use std::sync::Arc;

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{self, Color32, FontId, RichText, Ui, vec2};

use super::action::Action;
use super::external_editor;
use super::open_panels::OpenPanels;
use super::theme::{self, card};
use crate::compile::diagnostics::ShownDiagnostic;
use crate::session::Session;
use crate::session::draft::Draft;

/// The fraction of the picture's height that errors and warnings may cover.
const MAX_COVERED: f32 = 0.4;

/// After this long without an edit in the window, new errors cover the picture, in seconds. The
/// editor underlines them at once.
const TYPING_PAUSE: f64 = 1.0;

/// The overlay, which waits until the user stops typing before it covers the picture.
#[derive(Debug, Default)]
pub struct DiagnosticsOverlay {
    is_shown: bool,
    /// The text of the last frame, and the time at which it was edited in the window.
    text: Arc<str>,
    edited: Option<f64>,
}

impl DiagnosticsOverlay {
    /// Shows errors in the upper left corner unless they are folded, and warnings if they are
    /// unfolded.
    pub fn show(
        &mut self,
        ui: &Ui,
        session: &Session,
        panels: &mut OpenPanels,
        actions: &mut Vec<Action>,
    ) {
        let waits = self.is_typing(ui, session) && !self.is_shown;
        self.is_shown = !session.diagnostics.all.is_empty() && !waits;
        if self.is_shown {
            cards(ui, session, panels, actions);
        }
    }

    /// True if the shown text was edited in the window a moment ago.
    fn is_typing(&mut self, ui: &Ui, session: &Session) -> bool {
        let now = ui.input(|input| input.time);
        let text = session.shown_text();
        if !Arc::ptr_eq(text, &self.text) {
            let is_edited = session.shown_draft().is_some_and(Draft::is_edited);
            (self.text, self.edited) = (Arc::clone(text), is_edited.then_some(now));
        }
        let rest = self.edited.map_or(0.0, |edited| edited + TYPING_PAUSE - now);
        if rest > 0.0 {
            ui.ctx().request_repaint_after_secs(rest as f32);
        }
        rest > 0.0
    }
}

fn cards(ui: &Ui, session: &Session, panels: &mut OpenPanels, actions: &mut Vec<Action>) {
    let diagnostics = &session.diagnostics;
    let rect = ui.max_rect();
    let errors = diagnostics.errors();
    let area = egui::Area::new(ui.scope_id().with("diagnostics")).order(egui::Order::Middle);
    area.fixed_pos(rect.left_top() + vec2(10.0, 10.0)).show(ui.ctx(), |ui| {
        ui.set_max_width((rect.width() - 20.0).clamp(120.0, 620.0));
        ui.horizontal(|ui| {
            let palette = theme::of(ui);
            let warnings = diagnostics.all.len() - errors;
            fold_button(ui, "error", errors, palette.error, &mut panels.errors);
            fold_button(ui, "warning", warnings, palette.warning, &mut panels.warnings);
        });
        let shown = |it: &&ShownDiagnostic| match it.is_error {
            true => panels.errors,
            false => panels.warnings,
        };
        let height = (rect.height() * MAX_COVERED).max(60.0);
        let scroll = egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height);
        scroll.show(ui, |ui| {
            for diagnostic in diagnostics.all.iter().filter(shown) {
                card_of(ui, session, diagnostic, actions);
            }
        });
    });
}

/// A button with the number of errors or warnings, which shows or hides them.
fn fold_button(ui: &mut Ui, what: &str, count: usize, color: Color32, open: &mut bool) {
    if count == 0 {
        return;
    }
    let plural = if count == 1 { "" } else { "s" };
    let sign = if *open { "hide" } else { "show" };
    let text = RichText::new(format!("{sign} {count} {what}{plural}")).small().color(color);
    let button = egui::Button::new(text).fill(theme::of(ui).card);
    if ui.add(button).on_hover_text(format!("Show or hide the {what}{plural}.")).clicked() {
        *open = !*open;
    }
}

/// A card with a diagnostic, its source line and its help.
fn card_of(
    ui: &mut Ui,
    session: &Session,
    diagnostic: &ShownDiagnostic,
    actions: &mut Vec<Action>,
) {
    let color = if diagnostic.is_error { theme::of(ui).error } else { theme::of(ui).warning };
    card(ui).stroke(egui::Stroke::new(1.0, color.gamma_multiply(0.6))).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.spacing_mut().item_spacing.y = 4.0;
        let kind = if diagnostic.is_error { "error" } else { "warning" };
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new(format!("{kind}[{}]", diagnostic.code)).strong().color(color));
            ui.label(RichText::new(&diagnostic.message).strong());
        });
        position(ui, session, diagnostic, actions);
        ui.label(source_line(ui, diagnostic, color));
        for help in &diagnostic.help {
            ui.label(RichText::new(help).color(theme::of(ui).weak));
        }
        let is_current = session.has_diagnosed_text(&diagnostic.file);
        for fix in diagnostic.fixes.iter().filter(|_| is_current) {
            let button = ui.small_button(&fix.title);
            if button.on_hover_text("Make this change in the text.").clicked() {
                actions.push(Action::Fix(diagnostic.file.clone(), fix.clone()));
            }
        }
    });
}

/// Links to copy the position and to open it in an editor.
fn position(
    ui: &mut Ui,
    session: &Session,
    diagnostic: &ShownDiagnostic,
    actions: &mut Vec<Action>,
) {
    ui.horizontal(|ui| {
        let link = egui::Link::new(RichText::new(diagnostic.location()).monospace().small());
        if ui.add(link).on_hover_text("Copy file:line:column.").clicked() {
            let path = session.path_of(diagnostic);
            let [line, column] = diagnostic.position;
            actions.push(Action::Copy(format!("{}:{line}:{column}", path.display())));
        }
        let Some(chosen) = external_editor::from_environment() else { return };
        let link = egui::Link::new(RichText::new("open in editor").small());
        if ui.add(link).on_hover_text(format!("Open the file in {chosen}.")).clicked()
            && let Err(error) =
                external_editor::open(&chosen, &session.path_of(diagnostic), diagnostic.position)
        {
            actions.push(Action::Message(error));
        }
    });
}

/// The source line with its marked range and its label.
fn source_line(ui: &Ui, diagnostic: &ShownDiagnostic, color: Color32) -> LayoutJob {
    let font = FontId::monospace(12.0);
    let plain = TextFormat::simple(font.clone(), theme::of(ui).text);
    let mut marked = TextFormat::simple(font.clone(), color);
    marked.underline = egui::Stroke::new(1.5, color);
    let substring = |range: std::ops::Range<usize>| -> String {
        diagnostic.line.chars().skip(range.start).take(range.len()).collect()
    };
    let mut job = LayoutJob::default();
    let number = TextFormat::simple(font.clone(), theme::of(ui).weak);
    job.append(&format!("{:>4} ", diagnostic.position[0]), 0.0, number);
    job.append(&substring(0..diagnostic.marked.start), 0.0, plain.clone());
    job.append(&substring(diagnostic.marked.clone()), 0.0, marked);
    job.append(&substring(diagnostic.marked.end..usize::MAX), 0.0, plain);
    if !diagnostic.label.is_empty() {
        job.append(&diagnostic.label, 16.0, TextFormat::simple(font, color));
    }
    job
}
