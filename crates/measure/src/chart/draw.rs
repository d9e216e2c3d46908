//! Draws a chart: operations per pixel to the right, error in depth upwards, both logarithmic. A
//! method is a line through its settings; a ring instead of a disc marks wrong pixels.

use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::theme::Theme;
use super::{Chart, LEAST_ERROR, Row};

pub(super) const SIZE: (u32, u32) = (960, 620);
/// Width and height of a count above a marker.
const LABEL: (i32, i32) = (30, 13);

/// The bytes of a font. It gives the size of text, and its shapes in a PNG.
#[derive(Clone, Copy, Debug)]
pub struct Font(pub &'static [u8]);

impl Font {
    pub(super) fn register(self) -> Result<(), DrawError> {
        let known = register_font("sans-serif", FontStyle::Normal, self.0);
        known.map_err(|_| DrawError::new(&"the font cannot be read"))
    }
}

/// A drawing area and its error.
type Area<B> = DrawingArea<B, plotters::coord::Shift>;
type Failed = DrawingAreaErrorKind<std::io::Error>;

/// Why a chart could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DrawError(String);

impl DrawError {
    pub(super) fn new(why: &dyn std::fmt::Display) -> Self {
        Self(why.to_string())
    }
}

impl std::fmt::Display for DrawError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the chart cannot be drawn: {}", self.0)
    }
}

impl std::error::Error for DrawError {}

/// Draws the chart as SVG, with a background that follows the reader's theme.
///
/// # Errors
///
/// [`DrawError`] if there is no row to draw, or the font is none.
pub fn svg(chart: &Chart, font: Font) -> Result<String, DrawError> {
    font.register()?;
    themed(SIZE, |root, theme| draw(chart, root, theme))
}

/// Draws an SVG that follows the reader's theme.
pub(super) fn themed(
    size: (u32, u32),
    draw: impl FnOnce(&Area<SVGBackend<'_>>, &Theme) -> Result<(), Failed>,
) -> Result<String, DrawError> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        draw(&root, &Theme::LIGHT).map_err(|error| DrawError::new(&error))?;
    }
    let head = text.find('\n').map_or(0, |end| end + 1);
    text.insert_str(head, &format!("<style>{}</style>\n", Theme::css()));
    Ok(text)
}

/// A logarithmic coordinate system.
type Plane<'a, B> = ChartContext<'a, B, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;

/// Draws the axes and their labels.
pub(super) fn mesh<B: DrawingBackend>(
    plane: &mut Plane<'_, B>,
    theme: &Theme,
    [x, y]: [&str; 2],
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let label = |size| ("sans-serif", size).into_font().color(&theme.ink);
    plane
        .configure_mesh()
        .x_desc(x)
        .y_desc(y)
        .axis_style(theme.ink)
        .bold_line_style(theme.faint)
        .light_line_style(TRANSPARENT)
        .label_style(label(13))
        .axis_desc_style(label(14))
        .x_label_formatter(&|value| plain(*value))
        .y_label_formatter(&|value| plain(*value))
        .draw()
}

pub(super) fn draw<B: DrawingBackend>(
    chart: &Chart,
    root: &DrawingArea<B, plotters::coord::Shift>,
    theme: &Theme,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    root.fill(&theme.paper)?;
    let body = header(chart, root, theme)?;
    let (costs, errors) = (span(&chart.methods, cost), span(&chart.methods, error));
    let mut plane = ChartBuilder::on(&body)
        .margin(12)
        .margin_right(24)
        .x_label_area_size(44)
        .y_label_area_size(72)
        .build_cartesian_2d((costs[0]..costs[1]).log_scale(), (errors[0]..errors[1]).log_scale())?;
    let label = |size| ("sans-serif", size).into_font().color(&theme.ink);
    let names_of_axes = [
        "operations of the field's formula per pixel",
        "error in depth, 99th of 100 pixels, in widths of a pixel",
    ];
    mesh(&mut plane, theme, names_of_axes)?;

    let front = chart.front();
    let line = front.iter().map(|row| place(row));
    plane.draw_series(LineSeries::new(line, theme.faint.stroke_width(9)))?;
    plane.draw_series(front.iter().map(|row| Circle::new(place(row), 11, theme.faint.filled())))?;

    let mut labels: Vec<(i32, i32)> = Vec::new();
    for (index, name) in names(chart).into_iter().enumerate() {
        let color = theme.methods[index % theme.methods.len()];
        let rows: Vec<&Row> = chart.methods.iter().filter(|row| row.method == name).collect();
        let line = rows.iter().map(|row| place(row));
        plane
            .draw_series(LineSeries::new(line, color.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| Circle::new((x + 8, y), 5, color.filled()));
        plane.draw_series(rows.iter().map(|row| marker(row, color)))?;
        let style =
            ("sans-serif", 12).into_font().color(&color).pos(Pos::new(HPos::Center, VPos::Top));
        for row in rows.iter().filter(|row| row.default && row.failed() > 0) {
            let (x, marker) = plane.backend_coord(&place(row));
            let mut y = marker - 2 * LABEL.1;
            while labels.iter().any(|(a, b)| (x - a).abs() < LABEL.0 && (y - b).abs() < LABEL.1) {
                y -= LABEL.1;
            }
            labels.push((x, y));
            root.draw(&Text::new(row.failed().to_string(), (x, y), style.clone()))?;
        }
    }
    plane
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(theme.paper.mix(0.85))
        .border_style(theme.faint)
        .label_font(label(14))
        .draw()?;
    root.present()
}

/// Draws the title and returns the rest of the drawing area.
fn header<B: DrawingBackend>(
    chart: &Chart,
    root: &DrawingArea<B, plotters::coord::Shift>,
    theme: &Theme,
) -> Result<DrawingArea<B, plotters::coord::Shift>, DrawingAreaErrorKind<B::ErrorType>> {
    let (head, body) = root.split_vertically(58);
    let style = |size, color: &RGBColor| {
        ("sans-serif", size).into_font().color(color).pos(Pos::new(HPos::Left, VPos::Top))
    };
    let [width, height] = chart.size;
    head.draw(&Text::new(chart.scene.clone(), (20, 12), style(19, &theme.ink)))?;
    let counts = chart.oracle;
    let line = format!(
        "{} leaves, {}{width}x{height}, on {}, {}{}; oracle: {} hit, {} miss, {} at edges, {} undecided. \
         Ring: pixels are wrong or out of steps. Large: the default, with their number. Grey: nothing is cheaper and better.",
        chart.leaves,
        if chart.certified { "" } else { "field uncertified, " },
        chart.adapter,
        chart.driver,
        chart.made.iter().map(|made| format!(", {made}")).collect::<String>(),
        counts.hit,
        counts.miss,
        counts.edge,
        counts.undecided
    );
    for (index, part) in wrapped(&line, 160).into_iter().enumerate() {
        head.draw(&Text::new(part, (20, 34 + 14 * index as i32), style(12, &theme.soft)))?;
    }
    Ok(body)
}

/// Wraps a text into lines of limited length.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Returns the names of the methods in order of their first rows.
fn names(chart: &Chart) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for row in &chart.methods {
        if !names.contains(&row.method.as_str()) {
            names.push(&row.method);
        }
    }
    names
}

fn marker(row: &Row, color: RGBColor) -> Circle<(f64, f64), i32> {
    let radius = if row.default { 7 } else { 4 };
    let style = if row.failed() == 0 { color.filled() } else { color.stroke_width(2) };
    Circle::new(place(row), radius, style)
}

fn place(row: &Row) -> (f64, f64) {
    (cost(row), error(row))
}

fn cost(row: &Row) -> f64 {
    row.ops_per_pixel.max(1.0)
}

fn error(row: &Row) -> f64 {
    row.depth_px.p99.max(LEAST_ERROR)
}

/// Returns the range of values, with room for markers.
fn span(rows: &[Row], value: impl Fn(&Row) -> f64) -> [f64; 2] {
    let values = || rows.iter().map(&value).filter(|value| value.is_finite());
    let least = values().fold(f64::INFINITY, f64::min);
    let greatest = values().fold(0.0, f64::max);
    if least > greatest { [1.0, 10.0] } else { [least / 1.6, greatest * 4.0] }
}

/// Formats a tick with few digits: 0.001, 20, 3000.
fn plain(value: f64) -> String {
    if value >= 1.0 { format!("{value:.0}") } else { format!("{}", (value * 1e6).round() / 1e6) }
}
