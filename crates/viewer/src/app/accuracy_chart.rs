//! The chart of all ray methods: cost to the right, error upwards.

use eframe::egui::{self, Color32, Pos2, Rect, Response, Sense, Stroke, Ui, pos2, vec2};

use super::theme;
use crate::accuracy::comparison::{ComparisonResult, MethodResult};
use crate::session::Session;

/// The height of the chart in points.
const HEIGHT: f32 = 150.0;
/// Smaller errors, which are invisible, are drawn at this value. In pixel widths.
const MIN_ERROR: f64 = 1e-5;
/// The pointer is on a mark if it is nearer than this, in points.
const HOVER_DISTANCE: f32 = 9.0;

/// An error in pixel widths as text.
pub fn error_text(error: f64) -> String {
    match error {
        0.0 => "0 px".to_owned(),
        error if error < 1e-3 => format!("{error:.0e} px"),
        error => format!("{error:.3} px"),
    }
}

/// The logarithmic axes of the chart.
struct Axes {
    plot: Rect,
    /// Powers of ten at both ends of the cost axis.
    cost: [f64; 2],
    /// Powers of ten at both ends of the error axis.
    error: [f64; 2],
}

impl Axes {
    fn new(plot: Rect, all: &[MethodResult]) -> Self {
        let powers = |of: &dyn Fn(&MethodResult) -> f64| {
            let values = || all.iter().map(|it| of(it).log10()).filter(|it| it.is_finite());
            let low = values().fold(f64::INFINITY, f64::min).floor();
            let high = values().fold(f64::NEG_INFINITY, f64::max).ceil();
            if low < high { [low, high] } else { [low.min(0.0), low.min(0.0) + 1.0] }
        };
        Self { plot, cost: powers(&|it| it.operations), error: powers(&error) }
    }

    /// The position of a result's mark.
    fn at(&self, result: &MethodResult) -> Pos2 {
        let fraction =
            |value: f64, [low, high]: [f64; 2]| ((value.log10() - low) / (high - low)) as f32;
        let x = fraction(result.operations, self.cost).clamp(0.0, 1.0);
        let y = fraction(error(result), self.error).clamp(0.0, 1.0);
        pos2(
            egui::lerp(self.plot.x_range(), x),
            egui::lerp(self.plot.bottom()..=self.plot.top(), y),
        )
    }
}

/// The error of a result in pixel widths; infinite if no ray hit what it should have hit, so that
/// no depth could be compared.
fn error(result: &MethodResult) -> f64 {
    let depth = result.metrics.depth.pixels;
    if result.failed() > 0 && depth.max == 0.0 {
        return f64::INFINITY;
    }
    depth.p99.max(MIN_ERROR)
}

/// Shows the chart; returns the result that was clicked.
pub fn show<'r>(
    ui: &mut Ui,
    session: &Session,
    comparison: &'r ComparisonResult,
) -> Option<&'r MethodResult> {
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let plot = Rect::from_min_max(rect.min + vec2(34.0, 6.0), rect.max - vec2(16.0, 18.0));
    let axes = Axes::new(plot, &comparison.all);
    grid(ui, rect, &axes);
    captions(ui, plot);
    let near = nearest(&response, &axes, &comparison.all);
    if let Some(near) = near {
        // A line joins the settings of the method under the pointer.
        let line: Vec<Pos2> = comparison
            .all
            .iter()
            .filter(|it| it.method == near.method)
            .map(|it| axes.at(it))
            .collect();
        ui.painter().line(line, Stroke::new(1.0, theme::of(ui).link));
    }
    for result in &comparison.all {
        mark(ui, session, comparison, result, axes.at(result));
    }
    let response = match near {
        Some(near) => response.on_hover_text_at_pointer(description(near, comparison)),
        None => response.on_hover_text(
            "Each mark is a ray method at one setting. Right: cost in operations per pixel. \
             Up: depth error in pixel widths, 99th percentile. Filled: no other mark is better \
             in both. Red: some pixels are wrong. Click a mark to use its method.",
        ),
    };
    near.filter(|_| response.clicked())
}

fn grid(ui: &Ui, rect: Rect, axes: &Axes) {
    let palette = theme::of(ui);
    let painter = ui.painter();
    painter.rect_filled(rect, 4.0, palette.ground);
    let font = egui::FontId::proportional(10.0);
    let line = Stroke::new(1.0, palette.line);
    let powers = |[low, high]: [f64; 2]| low as i32..=high as i32;
    for power in powers(axes.cost) {
        let fraction = (f64::from(power) - axes.cost[0]) / (axes.cost[1] - axes.cost[0]);
        let x = egui::lerp(axes.plot.x_range(), fraction as f32);
        painter.vline(x, axes.plot.y_range(), line);
        let at = pos2(x, axes.plot.bottom() + 3.0);
        painter.text(at, egui::Align2::CENTER_TOP, power_text(power), font.clone(), palette.weak);
    }
    let every = ((axes.error[1] - axes.error[0]) / 5.0).ceil().max(1.0) as usize;
    for power in powers(axes.error).step_by(every) {
        let fraction = (f64::from(power) - axes.error[0]) / (axes.error[1] - axes.error[0]);
        let y = egui::lerp(axes.plot.bottom()..=axes.plot.top(), fraction as f32);
        painter.hline(axes.plot.x_range(), y, line);
        let at = pos2(axes.plot.left() - 4.0, y);
        painter.text(at, egui::Align2::RIGHT_CENTER, power_text(power), font.clone(), palette.weak);
    }
}

/// The names of the axes.
fn captions(ui: &Ui, plot: Rect) {
    let font = egui::FontId::proportional(10.0);
    let weak = theme::of(ui).weak;
    let right = "operations per pixel";
    let corner = plot.right_bottom() - vec2(4.0, 3.0);
    ui.painter().text(corner, egui::Align2::RIGHT_BOTTOM, right, font.clone(), weak);
    let corner = plot.left_top() + vec2(4.0, 2.0);
    ui.painter().text(corner, egui::Align2::LEFT_TOP, "depth error, px", font, weak);
}

fn power_text(power: i32) -> String {
    match power {
        -2..=4 => format!("{}", 10_f64.powi(power)),
        _ => format!("1e{power}"),
    }
}

fn nearest<'j>(
    response: &Response,
    axes: &Axes,
    all: &'j [MethodResult],
) -> Option<&'j MethodResult> {
    let pointer = response.hover_pos()?;
    let distance = |result: &MethodResult| axes.at(result).distance(pointer);
    let nearest = all.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    (distance(nearest) < HOVER_DISTANCE).then_some(nearest)
}

fn mark(
    ui: &Ui,
    session: &Session,
    comparison: &ComparisonResult,
    result: &MethodResult,
    at: Pos2,
) {
    let palette = theme::of(ui);
    let chosen = session.build().method;
    let own = session.model.as_ref().map_or(sdfc::Method::Auto, |model| model.scene.method());
    let is_chosen = result.method == chosen.unwrap_or(own) && result.setting == session.tolerance;
    let color = match result.failed() {
        0 => palette.text,
        _ => palette.error,
    };
    let fill = if comparison.is_pareto_optimal(result) { color } else { Color32::TRANSPARENT };
    ui.painter().circle(at, 3.0, fill, Stroke::new(1.2, color));
    if is_chosen {
        ui.painter().circle_stroke(at, 6.5, Stroke::new(1.5, palette.accent));
    }
}

fn description(result: &MethodResult, comparison: &ComparisonResult) -> String {
    let MethodResult { method: name, setting, metrics, operations, milliseconds } = result;
    let parameter = name.definition().parameter;
    let setting =
        parameter.map_or(String::new(), |parameter| format!(", {} ×{setting}", parameter.name()));
    let [width, height] = comparison.size;
    format!(
        "{name}{setting}\n{} operations and {:.1} evaluations per pixel, {milliseconds:.1} ms at \
         {width} × {height}\n{} missed, {} false hits, {} out of steps, {} not finite\n\
         depth error: 99th percentile {}, maximum {}",
        operations.round(),
        metrics.evaluations.mean,
        metrics.missed,
        metrics.false_hits,
        metrics.capped,
        metrics.nan,
        error_text(metrics.depth.pixels.p99),
        error_text(metrics.depth.pixels.max),
    )
}
