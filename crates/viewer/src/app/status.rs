//! The line below the picture: how it was drawn, and what is amiss.

use eframe::egui::{self, RichText, Ui};
use sdfc::render::Clock;

use super::style;
use crate::model::{Model, Stages};
use crate::painter::{BUDGET, Picture};
use crate::session::Session;

/// The line.
pub fn show(ui: &mut Ui, session: &mut Session, remark: Option<&str>) {
    ui.horizontal(|ui| {
        if let Some(picture) = session.picture.as_deref() {
            figures(ui, session, picture);
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            saving(ui, session);
            let trouble = session.trouble.as_ref().or(session.no_picture.as_ref());
            match (remark, trouble, &session.model) {
                (Some(remark), ..) => note(ui, remark, style::of(ui).accent),
                (None, Some(trouble), _) => note(ui, trouble, style::of(ui).warning),
                (None, None, Some(model)) => machine(ui, model),
                (None, None, None) => {}
            }
        });
    });
}

fn note(ui: &mut Ui, text: &str, color: egui::Color32) {
    let label = egui::Label::new(RichText::new(text).small().color(color)).truncate();
    ui.add(label).on_hover_text(text);
}

/// How far a picture is that is being saved.
fn saving(ui: &mut Ui, session: &Session) {
    let Some(share) = session.clerk().progress() else { return };
    if ui.small_button("cancel").on_hover_text("No file comes of it.").clicked() {
        session.clerk().cancel();
    }
    let bar = egui::ProgressBar::new(share).desired_width(90.0).show_percentage();
    ui.add(bar).on_hover_text("A picture is being drawn for a file.");
}

fn figures(ui: &mut Ui, session: &Session, picture: &Picture) {
    let color = style::of(ui).weak;
    let weak = |text: String| RichText::new(text).small().color(color);
    let model = &picture.request.model;
    ui.label(weak(model.method.clone())).on_hover_text("The ray method.");
    let [width, height] = picture.request.size;
    ui.label(weak(format!("{width} × {height}"))).on_hover_text("Pixels.");
    let clock = match picture.clock {
        Clock::Gpu => "by the adapter's own clock",
        Clock::Wall => "by the wall clock, with reading back",
    };
    let text = format!(
        "One ray a pixel took {:.2} ms {clock};\n{:.1} ms from the request to the picture.",
        picture.milliseconds, picture.latency
    );
    ui.label(weak(format!("{:.1} ms", picture.milliseconds))).on_hover_text(text);
    let evaluations = picture.evaluations;
    let text = format!(
        "Evaluations of the field for each pixel, shadows and mirrors included: 99 of 100 pixels have at most {}, \
         the most is {}.\n{} pixels met a surface, {} nothing, {} ran out of steps, {} are no number.",
        evaluations.p99,
        evaluations.max,
        picture.counts.hit,
        picture.counts.miss,
        picture.counts.capped,
        picture.counts.nan
    );
    ui.label(weak(format!("{:.1} evaluations a pixel", evaluations.mean))).on_hover_text(text);
    if picture.counts.capped > 0 {
        let text = format!("{} capped", picture.counts.capped);
        ui.label(RichText::new(text).small().color(style::of(ui).warning))
            .on_hover_text("Rays that ran out of steps; the view “Capped rays” shows where.");
    }
    progress(ui, session, picture);
}

/// How fine the picture is.
fn progress(ui: &mut Ui, session: &Session, picture: &Picture) {
    let text = if picture.divisor > 1 {
        let more = match (session.refine, picture.request.moving) {
            (false, _) => ", stopped: Esc goes on",
            (true, true) => "",
            (true, false) => ", refining: Esc stops",
        };
        let full = picture.milliseconds * f64::from(picture.divisor * picture.divisor);
        let why = if full > BUDGET { "too slow: " } else { "" };
        format!("{why}showing 1/{} resolution{more}", picture.divisor)
    } else if !picture.finished && session.refine {
        format!("{} of {} rays a pixel", picture.samples, picture.request.samples)
    } else {
        return;
    };
    let help = "Every pixel of this scene takes longer than a frame may while something moves. Esc stops refining, and goes on.";
    ui.label(RichText::new(text).small().color(style::of(ui).accent)).on_hover_text(help);
}

/// What draws; where that is otherwise than asked, why.
fn machine(ui: &mut Ui, model: &Model) {
    let name = model.adapter().unwrap_or("the processor");
    let text = RichText::new(name).small().color(style::of(ui).weak);
    ui.label(text).on_hover_text(built(model.stages, model.pipelines));
    if let Some(why) = &model.note {
        note(ui, why, style::of(ui).warning);
    }
}

fn built(stages: Stages, pipelines: u64) -> String {
    let pipeline = match stages.pipeline {
        Some(milliseconds) => format!("pipeline {milliseconds:.1} ms"),
        None => "the running pipeline serves".to_owned(),
    };
    format!(
        "Last text: front end {:.1} ms, analysis {:.1} ms, lowering {:.1} ms, {pipeline}.\n\
         Pipelines made so far: {pipelines}.",
        stages.front, stages.analyze, stages.lower
    )
}
