//! `sdfc chart -o FOLDER`: the charts of several scenes, and a page that lists them.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use sdfc::accuracy_data::chart::{Chart as Figures, Row};

use super::chart::{Form, charted, drawn};
use crate::args::Chart;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::Output;

/// Writes `NAME.svg`, `NAME.png` and `NAME.json` of each scene into the folder, and `README.md`.
///
/// # Errors
///
/// Those of one chart; what was written before stays.
pub fn run(
    args: &Chart,
    files: &[PathBuf],
    folder: &Path,
    console: &Console,
) -> Result<(), Failure> {
    let mut charts = Vec::new();
    for file in files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let chart = charted(args, file, console)?;
        let path = |ending: &str| folder.join(format!("{name}.{ending}"));
        Output::new(&path("svg")).write(&drawn(&chart, Form::Svg, false)?)?;
        Output::new(&path("png")).write(&drawn(&chart, Form::Png, args.dark)?)?;
        Output::new(&path("json")).write(&super::json(&chart)?)?;
        charts.push((name, chart));
    }
    Output::new(&folder.join("README.md")).write(page(&charts).as_bytes())
}

/// Writes the lines of the summary alone.
///
/// # Errors
///
/// Those of one chart; then nothing is written.
pub fn table(args: &Chart, files: &[PathBuf], console: &Console) -> Result<(), Failure> {
    let Some(output) = args.table.as_deref().map(Output::new) else { return Ok(()) };
    output.check()?;
    let mut charts = Vec::new();
    for file in files {
        let name = file.with_extension("").to_string_lossy().into_owned();
        charts.push((name, charted(args, file, console)?));
    }
    let head = head("What `auto` does, scene by scene", "--table", &charts);
    output.write((head + &summary(&charts)).as_bytes())
}

/// What was measured on what.
fn head(title: &str, how: &str, charts: &[(String, Figures)]) -> String {
    let mut text = format!("# {title}\n\nWritten by `sdfc chart FILE... {how}`.\n");
    if let Some((_, chart)) = charts.first() {
        let [width, height] = chart.size;
        let made = chart.made.iter().map(|made| format!("; {made}")).collect::<String>();
        let _ = writeln!(text, "{width}x{height} on {}, {}{made}.", chart.adapter, chart.driver);
    }
    text
}

/// A line for each scene: `auto` beside `sphere-cone`, and which methods are on the front.
fn summary(charts: &[(String, Figures)]) -> String {
    let mut text = "\nOf `auto`: evaluations and operations per pixel, pixels that are wrong (missed, false or NaN), rays out of \
        steps, errors that 99 of 100 plain pixels keep, in depth in widths of a pixel and, where the surface is smooth, of the \
        normal in degrees. *cone* is `sphere-cone`. On the front are the settings of a method that fail at no pixel and to which no other is \
        preferable in operations, failures and depth, counted. A scene in italics has a field that is uncertified: \
        what is found of it is measured here, and not known of other views.\n\n"
        .to_owned();
    text += "| scene | leaves | evaluations | cone | operations | cone | wrong | out of steps | depth | cone | normal | undecided | on the front |\n";
    text += "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    charts.iter().for_each(|(name, chart)| text += &summary_line(name, chart));
    text
}

fn summary_line(name: &str, chart: &Figures) -> String {
    let row = |method: &str| chart.methods.iter().find(|row| row.default && row.method == method);
    let figure = |method: &str, figure: &dyn Fn(&Row) -> String| {
        row(method).map_or_else(|| "-".to_owned(), figure)
    };
    let both = |of: &dyn Fn(&Row) -> String| {
        format!("{} | {}", figure("auto", of), figure("sphere-cone", of))
    };
    let mut front: Vec<(&str, usize)> = Vec::new();
    for row in chart.front() {
        match front.iter_mut().find(|(known, _)| *known == row.method) {
            Some((_, count)) => *count += 1,
            None => front.push((&row.method, 1)),
        }
    }
    let front = front.iter().map(|(method, count)| format!("{count} `{method}`"));
    format!(
        "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
        if chart.certified { name.to_owned() } else { format!("*{name}*") },
        chart.leaves,
        both(&|row| format!("{:.1}", row.evals_per_pixel.mean)),
        both(&|row| format!("{:.0}", row.ops_per_pixel)),
        figure("auto", &|row| row.wrong().to_string()),
        figure("auto", &|row| row.capped.to_string()),
        both(&|row| format!("{:.1e}", row.depth_px.p99)),
        figure("auto", &|row| format!("{:.1e}", row.normal_deg.p99)),
        chart.oracle.undecided,
        front.collect::<Vec<_>>().join(", "),
    )
}

/// The summary, then every method as it is used unless told otherwise, scene by scene.
fn page(charts: &[(String, Figures)]) -> String {
    let mut text = head("Charts", "-o FOLDER", charts) + &summary(charts);
    for (name, chart) in charts {
        let field = if chart.certified { "" } else { ", field uncertified" };
        let _ =
            write!(text, "\n## {name}\n\n`{}`, {} leaves{field}\n\n", chart.scene, chart.leaves);
        let _ = write!(text, "![operations against error]({name}.svg)\n\n");
        text += "| method | setting | evaluations / px | p99 | operations / px | ms | missed | false | NaN | out of steps | depth px p99 | normal deg p99 |\n";
        text += "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
        chart.methods.iter().filter(|row| row.default).for_each(|row| text += &line(row));
    }
    text
}

fn line(row: &Row) -> String {
    let settings = row.settings.iter().map(|(name, value)| format!("{name} {}", short(*value)));
    format!(
        "| `{}` | {} | {:.1} | {} | {:.0} | {:.1} | {} | {} | {} | {} | {:.1e} | {:.1e} |\n",
        row.method,
        settings.collect::<Vec<_>>().join(", "),
        row.evals_per_pixel.mean,
        row.evals_per_pixel.p99,
        row.ops_per_pixel,
        row.frame_ms.median,
        row.missed,
        row.false_hits,
        row.nan,
        row.capped,
        row.depth_px.p99,
        row.normal_deg.p99,
    )
}

/// As few digits as tell the value.
fn short(value: f64) -> String {
    if value >= 0.01 { format!("{value}") } else { format!("{value:.1e}") }
}
