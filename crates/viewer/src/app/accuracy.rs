//! How far the picture is from the oracle, and what all methods would make of it: cost to the right, error upwards.

use eframe::egui::{self, Color32, Pos2, Rect, Response, RichText, Sense, Stroke, Ui, pos2, vec2};
use sdfc::march::method;

use super::style;
use crate::judge::{Figures, Judgement};
use crate::session::Session;

/// Height of the chart.
const HEIGHT: f32 = 150.0;
/// Errors below this lie on the axis: no eye tells them apart.
const LEAST_ERROR: f64 = 1e-5;
/// The pointer is on a mark that is nearer than this.
const REACH: f32 = 9.0;

/// The section of the panel.
pub fn show(ui: &mut Ui, session: &mut Session) {
    orders(ui, session);
    if let Some(why) = &session.comparing.unjudged {
        ui.label(RichText::new(why).small().color(style::of(ui).warning));
    }
    let Some(judgement) = session.comparing.judgement.clone() else {
        if session.comparing.unjudged.is_none() && session.comparing.progress().is_none() {
            let text = "How many pixels are wrong, and by how much: proven ray by ray.";
            ui.label(RichText::new(text).small().color(style::of(ui).weak));
        }
        return;
    };
    figures(ui, session, &judgement);
    if judgement.all.is_empty() {
        return;
    }
    ui.add_space(4.0);
    if let Some(chosen) = chart(ui, session, &judgement) {
        session.set_build(|build| build.method = Some(chosen.method.clone()));
        session.tolerance = chosen.part;
    }
    for refused in &judgement.refused {
        ui.label(RichText::new(refused).small().color(style::of(ui).warning));
    }
}

fn orders(ui: &mut Ui, session: &mut Session) {
    if let Some((part, what)) = session.comparing.progress() {
        ui.horizontal(|ui| {
            let bar = egui::ProgressBar::new(part).desired_width(ui.available_width() - 64.0);
            ui.add(bar.text(RichText::new(what).small()).desired_height(18.0));
            if ui.button("Cancel").on_hover_text("Give it up.").clicked() {
                session.comparing.stop();
            }
        });
        return;
    }
    let drawn = session.picture.is_some();
    let has_adapter = session.model.as_ref().is_some_and(|model| model.adapter().is_some());
    ui.horizontal(|ui| {
        let text = "Compare this view, at a reduced size, with an oracle that proves in double precision where each ray \
                    meets the surface.";
        let compare = ui.add_enabled(drawn, egui::Button::new("Compare")).on_hover_text(text);
        if compare.on_disabled_hover_text("There is no picture yet.").clicked() {
            session.compare(false);
        }
        let text = "Draw this view with every ray method at several settings, and compare each. Takes seconds to \
                    minutes; a click on a mark of the chart chooses that method.";
        let all = ui.add_enabled(drawn && has_adapter, egui::Button::new("All methods"));
        let why = if drawn { "Shaders need an adapter." } else { "There is no picture yet." };
        if all.on_hover_text(text).on_disabled_hover_text(why).clicked() {
            session.compare(true);
        }
        let text = "Compare each picture as soon as it is finished.";
        ui.checkbox(&mut session.comparing.at_rest, "at rest").on_hover_text(text);
    });
}

fn figures(ui: &mut Ui, session: &Session, judgement: &Judgement) {
    let palette = style::of(ui);
    let is_current = session.judgement_is_of_this();
    let Figures { metrics, method, .. } = &judgement.shown;
    let errors = metrics.depth.pixels;
    let failed = |count: u64| if count > 0 { palette.error } else { palette.text };
    let count = |name, count: u64, help| (name, count.to_string(), failed(count), help);
    let depth = |name, error, help| (name, pixels(error), palette.text, help);
    let rows = [
        [
            count(
                "missed",
                metrics.missed,
                "Pixels whose ray led through a surface; at an edge only by more than a quarter of a pixel.",
            ),
            count(
                "false",
                metrics.false_hits + metrics.nan,
                "Pixels whose ray ended where no surface is.",
            ),
            count("out of steps", metrics.capped, "Pixels whose ray was given up."),
        ],
        [
            depth(
                "depth, half",
                errors.p50,
                "The depth of half of all pixels is off by at most so much, in widths of a pixel there.",
            ),
            depth(
                "99 of 100",
                errors.p99,
                "The depth of 99 of 100 pixels is off by at most so much, in widths of a pixel there.",
            ),
            depth("worst", errors.max, "No depth is off by more, in widths of a pixel there."),
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
    let [width, height] = judgement.size;
    let counts = judgement.counts;
    let whose = if is_current { "" } else { ", of another picture than this" };
    let text = format!("{method}, {width} × {height}{whose}");
    let color = if is_current { palette.weak } else { palette.warning };
    let help = format!(
        "The oracle: {} pixels hit, {} miss, {} lie at an edge, {} are undecided. All of it took {:.1} s.",
        counts.hit,
        counts.miss,
        counts.edge,
        counts.undecided,
        judgement.milliseconds / 1000.0
    );
    ui.label(RichText::new(text).small().color(color)).on_hover_text(help);
}

fn pixels(error: f64) -> String {
    match error {
        0.0 => "0 px".to_owned(),
        error if error < 1e-3 => format!("{error:.0e} px"),
        error => format!("{error:.3} px"),
    }
}

/// Where figures lie on the chart: powers of ten both ways.
struct Axes {
    plot: Rect,
    cost: [f64; 2],
    error: [f64; 2],
}

impl Axes {
    fn new(plot: Rect, all: &[Figures]) -> Self {
        let powers = |of: &dyn Fn(&Figures) -> f64| {
            let values = || all.iter().map(|it| of(it).log10()).filter(|it| it.is_finite());
            let low = values().fold(f64::INFINITY, f64::min).floor();
            let high = values().fold(f64::NEG_INFINITY, f64::max).ceil();
            if low < high { [low, high] } else { [low.min(0.0), low.min(0.0) + 1.0] }
        };
        Self { plot, cost: powers(&|it| it.operations), error: powers(&error) }
    }

    fn at(&self, figures: &Figures) -> Pos2 {
        let part =
            |value: f64, [low, high]: [f64; 2]| ((value.log10() - low) / (high - low)) as f32;
        let x = part(figures.operations, self.cost).clamp(0.0, 1.0);
        let y = part(error(figures), self.error).clamp(0.0, 1.0);
        pos2(
            egui::lerp(self.plot.x_range(), x),
            egui::lerp(self.plot.bottom()..=self.plot.top(), y),
        )
    }
}

/// Infinite where no ray met what it should have met, so that no depth could be compared.
fn error(figures: &Figures) -> f64 {
    let depth = figures.metrics.depth.pixels;
    if figures.failed() > 0 && depth.max == 0.0 {
        return f64::INFINITY;
    }
    depth.p99.max(LEAST_ERROR)
}

/// Draws it; gives what was clicked.
fn chart<'j>(ui: &mut Ui, session: &Session, judgement: &'j Judgement) -> Option<&'j Figures> {
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let plot = Rect::from_min_max(rect.min + vec2(34.0, 6.0), rect.max - vec2(16.0, 18.0));
    let axes = Axes::new(plot, &judgement.all);
    grid(ui, rect, &axes);
    captions(ui, plot);
    let near = nearest(&response, &axes, &judgement.all);
    if let Some(near) = near {
        // Its other settings.
        let line: Vec<Pos2> = judgement
            .all
            .iter()
            .filter(|it| it.method == near.method)
            .map(|it| axes.at(it))
            .collect();
        ui.painter().line(line, Stroke::new(1.0, style::of(ui).link));
    }
    for figures in &judgement.all {
        mark(ui, session, judgement, figures, axes.at(figures));
    }
    let response = match near {
        Some(near) => response.on_hover_text_at_pointer(described(near, judgement)),
        None => response.on_hover_text(
            "Each mark is a method at one setting: to the right the operations of the field's formula for each \
             pixel, upwards the error in depth of 99 of 100 pixels in widths of a pixel. Filled: no other is better \
             in both. Red: with wrong pixels. A click chooses the method.",
        ),
    };
    near.filter(|_| response.clicked())
}

fn grid(ui: &Ui, rect: Rect, axes: &Axes) {
    let palette = style::of(ui);
    let painter = ui.painter();
    painter.rect_filled(rect, 4.0, palette.ground);
    let font = egui::FontId::proportional(10.0);
    let line = Stroke::new(1.0, palette.line);
    let powers = |[low, high]: [f64; 2]| low as i32..=high as i32;
    for power in powers(axes.cost) {
        let part = (f64::from(power) - axes.cost[0]) / (axes.cost[1] - axes.cost[0]);
        let x = egui::lerp(axes.plot.x_range(), part as f32);
        painter.vline(x, axes.plot.y_range(), line);
        let at = pos2(x, axes.plot.bottom() + 3.0);
        painter.text(at, egui::Align2::CENTER_TOP, power_text(power), font.clone(), palette.weak);
    }
    let every = ((axes.error[1] - axes.error[0]) / 5.0).ceil().max(1.0) as usize;
    for power in powers(axes.error).step_by(every) {
        let part = (f64::from(power) - axes.error[0]) / (axes.error[1] - axes.error[0]);
        let y = egui::lerp(axes.plot.bottom()..=axes.plot.top(), part as f32);
        painter.hline(axes.plot.x_range(), y, line);
        let at = pos2(axes.plot.left() - 4.0, y);
        painter.text(at, egui::Align2::RIGHT_CENTER, power_text(power), font.clone(), palette.weak);
    }
}

/// What goes to the right, and what upwards.
fn captions(ui: &Ui, plot: Rect) {
    let font = egui::FontId::proportional(10.0);
    let weak = style::of(ui).weak;
    let right = "operations a pixel";
    let corner = plot.right_bottom() - vec2(4.0, 3.0);
    ui.painter().text(corner, egui::Align2::RIGHT_BOTTOM, right, font.clone(), weak);
    let corner = plot.left_top() + vec2(4.0, 2.0);
    ui.painter().text(corner, egui::Align2::LEFT_TOP, "error, px", font, weak);
}

fn power_text(power: i32) -> String {
    match power {
        -2..=4 => format!("{}", 10_f64.powi(power)),
        _ => format!("1e{power}"),
    }
}

fn nearest<'j>(response: &Response, axes: &Axes, all: &'j [Figures]) -> Option<&'j Figures> {
    let pointer = response.hover_pos()?;
    let distance = |figures: &Figures| axes.at(figures).distance(pointer);
    let nearest = all.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    (distance(nearest) < REACH).then_some(nearest)
}

fn mark(ui: &Ui, session: &Session, judgement: &Judgement, figures: &Figures, at: Pos2) {
    let palette = style::of(ui);
    let asked = session.build().method.as_deref();
    let own = session.model.as_ref().map_or("", |model| model.scene.method());
    let is_chosen = figures.method == asked.unwrap_or(own) && figures.part == session.tolerance;
    let color = match figures.failed() {
        0 => palette.text,
        _ => palette.error,
    };
    let fill = if judgement.is_best(figures) { color } else { Color32::TRANSPARENT };
    ui.painter().circle(at, 3.0, fill, Stroke::new(1.2, color));
    if is_chosen {
        ui.painter().circle_stroke(at, 6.5, Stroke::new(1.5, palette.accent));
    }
}

fn described(figures: &Figures, judgement: &Judgement) -> String {
    let Figures { method: name, part, metrics, operations, milliseconds } = figures;
    let knob = method(name).and_then(|method| method.parameter);
    let setting = knob.map_or(String::new(), |knob| format!(", {} ×{part}", knob.name()));
    let [width, height] = judgement.size;
    format!(
        "{name}{setting}\n{} operations a pixel, {:.1} evaluations, {milliseconds:.1} ms at {width} × {height}\n\
         {} missed, {} false, {} out of steps, {} no number\n99 of 100 pixels within {}, the worst {}",
        operations.round(),
        metrics.evaluations.mean,
        metrics.missed,
        metrics.false_hits,
        metrics.capped,
        metrics.nan,
        pixels(metrics.depth.pixels.p99),
        pixels(metrics.depth.pixels.max),
    )
}
