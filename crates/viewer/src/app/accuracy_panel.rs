//! The section "Accuracy": how far the picture is from the oracle, and a chart of all ray methods.

use eframe::egui::{self, RichText, Ui};

use super::accuracy_chart::{self, error_text};
use super::theme;
use crate::accuracy::comparison::{ComparisonResult, MethodResult};
use crate::session::Session;

/// Shows the section of the panel.
pub fn show(ui: &mut Ui, session: &mut Session) {
    buttons(ui, session);
    if let Some(why) = &session.accuracy.error {
        ui.label(RichText::new(why).small().color(theme::of(ui).warning));
    }
    let Some(comparison) = session.accuracy.result.clone() else {
        if session.accuracy.error.is_none() && session.accuracy.progress().is_none() {
            let text = "How many pixels are wrong, and by how much, proven ray by ray.";
            ui.label(RichText::new(text).small().color(theme::of(ui).weak));
        }
        return;
    };
    metrics(ui, session, &comparison);
    if comparison.all.is_empty() {
        return;
    }
    ui.add_space(4.0);
    if let Some(chosen) = accuracy_chart::show(ui, session, &comparison) {
        session.update_build(|build| build.method = Some(chosen.method));
        session.tolerance = chosen.setting;
    }
    for refused in &comparison.refused {
        ui.label(RichText::new(refused).small().color(theme::of(ui).warning));
    }
}

fn buttons(ui: &mut Ui, session: &mut Session) {
    if let Some((done, step)) = session.accuracy.progress() {
        ui.horizontal(|ui| {
            let bar = egui::ProgressBar::new(done).desired_width(ui.available_width() - 64.0);
            ui.add(bar.text(RichText::new(step).small()).desired_height(18.0));
            if ui.button("Cancel").on_hover_text("Cancel the comparison.").clicked() {
                session.accuracy.cancel();
            }
        });
        return;
    }
    let drawn = session.picture.is_some();
    let has_gpu = session.model.as_ref().is_some_and(|model| model.gpu_name().is_some());
    ui.horizontal(|ui| {
        let text = "Compare the picture, at a reduced size, with an oracle that proves in double \
                    precision where each ray hits the surface.";
        let check = egui::Button::new("Check accuracy");
        let compare = ui.add_enabled(drawn, check).on_hover_text(text);
        if compare.on_disabled_hover_text("There is no picture yet.").clicked() {
            session.compare(false);
        }
        let text = "Draw the picture with every ray method at several settings and compare each. \
                    Takes seconds to minutes. Click a mark of the chart to use its method.";
        let all = ui.add_enabled(drawn && has_gpu, egui::Button::new("All methods"));
        let why = if drawn { "Needs a GPU." } else { "There is no picture yet." };
        if all.on_hover_text(text).on_disabled_hover_text(why).clicked() {
            session.compare(true);
        }
    });
    let text = "Check each picture as soon as it is finished.";
    ui.checkbox(&mut session.accuracy.automatic, "check each picture").on_hover_text(text);
}

fn metrics(ui: &mut Ui, session: &Session, comparison: &ComparisonResult) {
    let palette = theme::of(ui);
    let is_current = session.accuracy_is_current();
    let MethodResult { metrics, method, .. } = &comparison.shown;
    let errors = metrics.depth.pixels;
    let failed = |count: u64| if count > 0 { palette.error } else { palette.text };
    let count = |name, count: u64, help| (name, count.to_string(), failed(count), help);
    let depth = |name, error, help| (name, error_text(error), palette.text, help);
    let rows = [
        [
            count(
                "missed",
                metrics.missed,
                "Pixels whose ray went through a surface; at an edge, by more than a quarter pixel.",
            ),
            count(
                "false hits",
                metrics.false_hits + metrics.nan,
                "Pixels whose ray ended where there is no surface.",
            ),
            count("out of steps", metrics.capped, "Pixels whose ray ran out of steps."),
        ],
        [
            depth(
                "median error",
                errors.p50,
                "Median of the depth errors, in pixel widths at the surface.",
            ),
            depth(
                "99th percentile",
                errors.p99,
                "99th percentile of the depth errors, in pixel widths at the surface.",
            ),
            depth(
                "maximum",
                errors.max,
                "The greatest depth error, in pixel widths at the surface.",
            ),
        ],
    ];
    for row in rows {
        ui.columns(3, |columns| {
            for ((name, value, color, help), ui) in row.into_iter().zip(columns) {
                ui.spacing_mut().item_spacing.y = 0.0;
                let color = if is_current { color } else { palette.weak };
                ui.label(RichText::new(value).color(color)).on_hover_text(help);
                ui.label(RichText::new(name).small().color(palette.weak)).on_hover_text(help);
            }
        });
    }
    let [width, height] = comparison.size;
    let counts = comparison.counts;
    let whose = if is_current { "" } else { ", of another picture" };
    let text = format!("{method}, {width} × {height}{whose}");
    let color = if is_current { palette.weak } else { palette.warning };
    let help = format!(
        "The oracle: {} pixels hit, {} miss, {} are at an edge, {} are undecided. Took {:.1} s.",
        counts.hit,
        counts.miss,
        counts.edge,
        counts.undecided,
        comparison.milliseconds / 1000.0
    );
    ui.label(RichText::new(text).small().color(color)).on_hover_text(help);
}
