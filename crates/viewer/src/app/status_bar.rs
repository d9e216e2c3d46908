//! The line below the picture: how it was drawn, and messages.

use eframe::egui::{self, RichText, Ui};
use sdfc_render::Clock;

use super::theme;
use crate::render::pacing::PASS_BUDGET_MS;
use crate::render::picture::{MovingPicture, Picture};

use crate::scene::model::{BuildTimes, Model};
use crate::session::Session;

/// Below this width in points the size of the picture and the evaluations are left out.
const WIDE: f32 = 760.0;

/// Shows the line. A message takes precedence over a problem, and that over the GPU's name. Where
/// there is no room for the hint, it is left out.
pub fn show(ui: &mut Ui, session: &mut Session, message: Option<&str>, hint: &str) {
    ui.horizontal(|ui| {
        if let Some(picture) = session.picture.as_deref() {
            metrics(ui, picture, session.moving.as_ref());
        }
        refinement(ui, session);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            export_progress(ui, session);
            let problem = session.problem.as_ref().or(session.render_error.as_ref());
            match (message, problem, &session.model) {
                (Some(message), ..) => truncated(ui, message, theme::of(ui).accent),
                (None, Some(problem), _) => truncated(ui, problem, theme::of(ui).warning),
                (None, None, Some(model)) => device(ui, model),
                (None, None, None) => {}
            }
            show_hint(ui, hint);
        });
    });
}

/// Shows what the mouse and the keys do, in the middle of the rest of the line.
fn show_hint(ui: &mut Ui, hint: &str) {
    let font = egui::TextStyle::Small.resolve(ui.style());
    let galley = ui.painter().layout_no_wrap(hint.to_owned(), font, theme::of(ui).weak);
    let room = ui.available_rect_before_wrap().shrink2(egui::vec2(12.0, 0.0));
    if galley.size().x <= room.width() {
        let at = egui::Align2::CENTER_CENTER.align_size_within_rect(galley.size(), room).min;
        ui.painter().galley(at, galley, theme::of(ui).weak);
    }
}

/// A text that is cut off if there is no room, with the full text on hover.
fn truncated(ui: &mut Ui, text: &str, color: egui::Color32) {
    let label = egui::Label::new(RichText::new(text).small().color(color)).truncate();
    ui.add(label).on_hover_text(text);
}

fn export_progress(ui: &mut Ui, session: &Session) {
    let Some(progress) = session.exports().progress() else { return };
    if ui.small_button("cancel").on_hover_text("Cancel the export; no file is written.").clicked() {
        session.exports().cancel();
    }
    let bar = egui::ProgressBar::new(progress).desired_width(90.0).show_percentage();
    ui.add(bar).on_hover_text("Drawing a picture to export.");
}

fn metrics(ui: &mut Ui, picture: &Picture, moving: Option<&MovingPicture>) {
    let color = theme::of(ui).weak;
    let weak = |text: String| RichText::new(text).small().color(color);
    let model = &picture.request.model;
    ui.label(weak(model.method.to_string())).on_hover_text("The ray method.");
    let wide = ui.available_width() >= WIDE;
    let [width, height] = picture.request.size;
    if wide {
        ui.label(weak(format!("{width} × {height}"))).on_hover_text("Width and height in pixels.");
    }
    let clock = match picture.clock {
        Clock::Gpu => "by the GPU's clock",
        Clock::Wall => "by the CPU's clock, with the transfer of the picture",
    };
    let text = format!(
        "Drawing one ray per pixel took {:.2} ms {clock};\n\
         {:.1} ms from the request to the picture.",
        picture.milliseconds, picture.latency
    );
    let shown = moving.map_or(picture.milliseconds, |moving| moving.milliseconds);
    ui.label(weak(format!("{shown:.1} ms"))).on_hover_text(text);
    let evaluations = picture.evaluations;
    let text = format!(
        "Mean number of field evaluations per pixel, shadows and reflections included.\n\
         99th percentile {}, maximum {}.\n\
         {} pixels hit a surface, {} hit nothing, {} ran out of steps, {} are not finite.",
        evaluations.p99,
        evaluations.max,
        picture.counts.hit,
        picture.counts.miss,
        picture.counts.capped,
        picture.counts.nan
    );
    if wide {
        let shown = weak(format!("{:.1} evaluations per pixel", evaluations.mean));
        ui.label(shown).on_hover_text(text);
    }
    if picture.counts.capped > 0 {
        let text = format!("{} out of steps", picture.counts.capped);
        ui.label(RichText::new(text).small().color(theme::of(ui).warning)).on_hover_text(
            "Pixels whose ray ran out of steps. The view “Out of steps” marks them.",
        );
    }
    let sampled = picture.counts.unproven.saturating_sub(picture.counts.capped);
    if sampled > 0 {
        let text = format!("{sampled} unproven");
        ui.label(RichText::new(text).small().color(theme::of(ui).warning)).on_hover_text(
            "Pixels whose rays were sampled, because bounds of the field are too wide for a proof. \
             Thin parts may be missing there.",
        );
    }
}

/// The resolution or the samples of the picture, if it is not finished, and a button that pauses
/// refining.
fn refinement(ui: &mut Ui, session: &mut Session) {
    let Some(picture) = session.picture.as_deref() else { return };
    let moves = session.moving.is_some() || picture.request.moving;
    if !session.refine || !picture.finished && !moves {
        let (text, help) = match session.refine {
            true => ("Pause", "Stop refining the picture (R)."),
            false => ("Resume", "Refine the picture to full resolution (R)."),
        };
        if ui.small_button(text).on_hover_text(help).clicked() {
            session.refine = !session.refine;
        }
    }
    let Some(text) = resolution(session) else { return };
    let help = "A slow scene is drawn at a lower resolution while something moves, and refined \
                when it rests. R pauses and resumes refining.";
    ui.label(RichText::new(text).small().color(theme::of(ui).accent)).on_hover_text(help);
}

/// The resolution or the samples of the shown picture, if it is not finished.
fn resolution(session: &Session) -> Option<String> {
    if let Some(moving) = &session.moving {
        return (moving.divisor > 1).then(|| reduced(moving.divisor, moving.milliseconds));
    }
    let picture = session.picture.as_deref()?;
    if picture.stride > 1 {
        let scale = picture.divisor * picture.stride;
        return Some(format!("computing {}: 1/{scale} resolution", picture.request.mode.name()));
    }
    if picture.divisor > 1 {
        let more = match (session.refine, picture.request.moving) {
            (false, _) => ", refining is paused",
            (true, true) => "",
            (true, false) => ", refining",
        };
        return Some(reduced(picture.divisor, picture.milliseconds) + more);
    }
    (!picture.finished && session.refine)
        .then(|| format!("{} of {} samples per pixel", picture.samples, picture.request.samples))
}

fn reduced(divisor: u32, milliseconds: f64) -> String {
    let full = milliseconds * f64::from(divisor * divisor);
    let why = if full > PASS_BUDGET_MS { "slow scene: " } else { "" };
    format!("{why}1/{divisor} resolution")
}

/// The GPU or CPU that draws; if that is not what was requested, why.
fn device(ui: &mut Ui, model: &Model) {
    let name = model.gpu_name().unwrap_or("CPU");
    let text = RichText::new(name).small().color(theme::of(ui).weak);
    let label = ui.add(egui::Label::new(text).truncate());
    label.on_hover_text(build_summary(model.build_times, model.pipelines));
    if let Some(why) = &model.note {
        truncated(ui, why, theme::of(ui).warning);
    }
}

fn build_summary(times: BuildTimes, pipelines: u64) -> String {
    let pipeline = match times.pipeline {
        Some(milliseconds) => format!("pipeline {milliseconds:.1} ms"),
        None => "pipeline reused".to_owned(),
    };
    format!(
        "Draws the picture.\n\
         Last build: front end {:.1} ms, analysis {:.1} ms, code generation {:.1} ms, {pipeline}.\n\
         Pipelines made so far: {pipelines}.",
        times.front, times.analyze, times.lower
    )
}
