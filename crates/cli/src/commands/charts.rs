//! `sdfc chart -o FOLDER`: the charts of several scenes, and a page that lists them.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use sdfc::accuracy_data::Quantiles;
use sdfc::accuracy_data::chart::{Chart as Figures, Row};

use super::chart::{Form, charted, drawn, outdone, told};
use crate::args::Chart;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::Output;

/// How a page of charts begins.
const TITLE: &str = "# Charts\n";

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
    if args.json.is_some() {
        let why = "into a folder each scene's figures go beside its chart; --json is for one scene without a folder";
        return Err(Failure::Call(why.to_owned()));
    }
    let index = folder.join("README.md");
    own_page(&index)?;
    let names = names(files)?;
    let mut charts = Vec::new();
    for (file, name) in files.iter().zip(names) {
        let path = |ending: &str| Output::new(&folder.join(format!("{name}.{ending}")));
        let [svg, png, json] = ["svg", "png", "json"].map(path);
        [&svg, &png, &json].into_iter().try_for_each(Output::check)?;
        let chart = charted(args, file, console)?;
        svg.write(&drawn(&chart, Form::Svg, false)?)?;
        png.write(&drawn(&chart, Form::Png, args.dark)?)?;
        json.write(&super::json(&chart)?)?;
        charts.push((name, chart));
    }
    Output::new(&index).write(page(args, &charts).as_bytes())
}

/// The names of the files in the folder: those of the scenes, of which no two may be the same.
fn names(files: &[PathBuf]) -> Result<Vec<String>, Failure> {
    let mut names: Vec<String> = Vec::with_capacity(files.len());
    for file in files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if names.contains(&name) {
            let why = format!("two of the scenes are called {name}, and so would their charts be");
            return Err(Failure::Call(why));
        }
        names.push(name);
    }
    Ok(names)
}

/// Refuses to overwrite a page that no such call has written.
fn own_page(path: &Path) -> Result<(), Failure> {
    match std::fs::read_to_string(path) {
        Ok(text) if !text.starts_with(TITLE) => Err(Failure::Call(format!(
            "{} is not a page of charts and would be overwritten; give another folder",
            path.display()
        ))),
        Ok(_) | Err(_) => Ok(()),
    }
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
    let head = head("# What `auto` does, scene by scene\n", &call(args, "--table FILE"), &charts);
    output.write((head + &summary(&charts)).as_bytes())
}

/// What was measured on what.
fn head(title: &str, call: &str, charts: &[(String, Figures)]) -> String {
    let mut text = format!("{title}\nWritten by\n\n```\n{call}\n```\n\n");
    if let Some((_, chart)) = charts.first() {
        let [width, height] = chart.size;
        let made = chart.made.iter().map(|made| format!("; {made}")).collect::<String>();
        let _ = writeln!(text, "{width}x{height} on {}, {}{made}.", chart.adapter, chart.driver);
    }
    text
}

/// The call that writes it again.
fn call(args: &Chart, output: &str) -> String {
    let mut text = "sdfc chart".to_owned();
    for file in &args.files {
        let _ = write!(text, " {}", file.display());
    }
    let [width, height] = args.size;
    let _ = write!(text, " --size {width}x{height} {output}");
    if !args.march.is_empty() {
        let _ = write!(text, " --march {}", args.march.join(","));
    }
    text + if args.note.is_some() { " --note TEXT" } else { "" }
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
        both(&|row| p99(&row.depth_px)),
        figure("auto", &|row| p99(&row.normal_deg)),
        chart.oracle.undecided,
        front.collect::<Vec<_>>().join(", "),
    )
}

/// The summary, then every method as it is used unless told otherwise, scene by scene.
fn page(args: &Chart, charts: &[(String, Figures)]) -> String {
    let mut text = head(TITLE, &call(args, "-o FOLDER"), charts) + &summary(charts);
    for (name, chart) in charts {
        let field = if chart.certified { "" } else { ", field uncertified" };
        let _ =
            write!(text, "\n## {name}\n\n`{}`, {} leaves{field}\n\n", chart.scene, chart.leaves);
        let _ = write!(text, "![operations against error]({name}.svg)\n\n");
        text += "| method | setting | evaluations / px | p99 | operations / px | ms | missed | false | NaN | out of steps | depth px p99 | normal deg p99 |\n";
        text += "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
        chart.methods.iter().filter(|row| row.default).for_each(|row| text += &line(row));
        let outdone = outdone(chart);
        if !outdone.is_empty() {
            let _ = write!(text, "\n{outdone}");
        }
    }
    text
}

fn line(row: &Row) -> String {
    let settings = row.settings.iter().map(|(name, value)| format!("{name} {}", short(*value)));
    format!(
        "| `{}` | {} | {:.1} | {} | {:.0} | {:.1} | {} | {} | {} | {} | {} | {} |\n",
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
        p99(&row.depth_px),
        p99(&row.normal_deg),
    )
}

fn p99(errors: &Quantiles) -> String {
    told(errors, |errors| format!("{:.1e}", errors.p99))
}

/// As few digits as tell the value.
fn short(value: f64) -> String {
    if value >= 0.01 { format!("{value}") } else { format!("{value:.1e}") }
}
