//! `sdfc chart`: charts of one scene or several, and a page that lists them.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use sdfc_measure::Quantiles;
use sdfc_measure::chart::{Chart as Results, Row};

use super::chart::{Form, charted, drawn, one, outdone, statistic};
use crate::args::Chart;
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::output::{self, Output};

/// The first line of a page of charts.
const TITLE: &str = "# Charts\n";

/// Charts scenes, and writes pictures, tables and results.
///
/// # Errors
///
/// A scene cannot be read, has errors or draws nothing; the machine has no GPU, or cannot write.
pub fn run(args: &Chart, console: &Console) -> Result<(), Failure> {
    match (&args.files[..], &args.output) {
        (files, None) if args.table.is_some() => table(args, files, console),
        (files, Some(folder)) if folder.is_dir() => folder_of_charts(args, files, folder, console),
        ([file], _) => one(args, file, console),
        (_, Some(_) | None) => {
            Err(Failure::Call("several scenes need an existing folder: add -o FOLDER".to_owned()))
        }
    }
}

/// Writes `NAME.svg`, `NAME.png` and `NAME.json` for each scene, and `README.md`, into a folder.
///
/// # Errors
///
/// Those of one chart. Files that were already written stay.
fn folder_of_charts(
    args: &Chart,
    files: &[PathBuf],
    folder: &Path,
    console: &Console,
) -> Result<(), Failure> {
    if args.json.is_some() {
        let why = "--json is for one scene without a folder; in a folder the results are written beside each chart";
        return Err(Failure::Call(why.to_owned()));
    }
    let index = folder.join("README.md");
    own_page(&index)?;
    let names = names(files)?;
    let interrupt = Interrupt::watch("stopped; finished charts stay", console);
    let mut charts = Vec::new();
    for (file, name) in files.iter().zip(names) {
        let path = |ending: &str| Output::new(&folder.join(format!("{name}.{ending}")));
        let [svg, png, json] = ["svg", "png", "json"].map(path);
        [&svg, &png, &json].into_iter().try_for_each(Output::check)?;
        let chart = charted(args, file, console, &interrupt)?;
        svg.write(&drawn(&chart, Form::Svg, false)?)?;
        png.write(&drawn(&chart, Form::Png, args.dark)?)?;
        json.write(&output::json(&chart)?)?;
        charts.push((name, chart));
    }
    Output::new(&index).write(page(args, &charts).as_bytes())
}

/// Returns the file names in the folder: those of the scenes, which must differ.
fn names(files: &[PathBuf]) -> Result<Vec<String>, Failure> {
    let mut names: Vec<String> = Vec::with_capacity(files.len());
    for file in files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if names.contains(&name) {
            let why = format!(
                "two of the scenes are called {name}; rename one, or write their charts to different folders"
            );
            return Err(Failure::Call(why));
        }
        names.push(name);
    }
    Ok(names)
}

/// Refuses to overwrite a page that this command did not write.
fn own_page(path: &Path) -> Result<(), Failure> {
    match std::fs::read_to_string(path) {
        Ok(text) if !text.starts_with(TITLE) => Err(Failure::Call(format!(
            "{} is not a page of charts and would be overwritten; choose another folder",
            path.display()
        ))),
        Ok(_) | Err(_) => Ok(()),
    }
}

/// Writes the summary only.
///
/// # Errors
///
/// Those of one chart. Then nothing is written.
fn table(args: &Chart, files: &[PathBuf], console: &Console) -> Result<(), Failure> {
    let Some(output) = args.table.as_deref().map(Output::new) else { return Ok(()) };
    output.check()?;
    let interrupt = Interrupt::watch("stopped; nothing was written", console);
    let mut charts = Vec::new();
    for file in files {
        let name = file.with_extension("").to_string_lossy().into_owned();
        charts.push((name, charted(args, file, console, &interrupt)?));
    }
    let head =
        head("# What `auto` does, scene by scene\n", &command_line(args, "--table FILE"), &charts);
    output.write((head + &summary(&charts)).as_bytes())
}

/// Returns the title, the command line and the device.
fn head(title: &str, call: &str, charts: &[(String, Results)]) -> String {
    let mut text = format!("{title}\nWritten by\n\n```\n{call}\n```\n\n");
    if let Some((_, chart)) = charts.first() {
        let [width, height] = chart.size;
        let made = chart.made.iter().map(|made| format!(";\n{made}")).collect::<String>();
        let _ = writeln!(text, "{width}x{height} on {}, {}{made}.", chart.adapter, chart.driver);
    }
    text
}

/// Returns the command line that writes the page again.
fn command_line(args: &Chart, output: &str) -> String {
    let mut text = "sdfc chart".to_owned();
    for file in &args.files {
        let _ = write!(text, " {}", file.display());
    }
    let [width, height] = args.size;
    let _ = write!(text, " --size {width}x{height} {output}");
    let names: Vec<&str> = args.march.iter().map(|method| method.name()).collect();
    if !names.is_empty() {
        let _ = write!(text, " --march {}", names.join(","));
    }
    text + if args.note.is_some() { " --note TEXT" } else { "" }
}

/// Returns a table with one line per scene: `auto` beside `sphere-cone`, and the methods on the
/// Pareto front.
fn summary(charts: &[(String, Results)]) -> String {
    let mut text = "\nColumns for `auto`: evaluations and operations per pixel; wrong pixels (missed, false or NaN); rays\n\
        out of steps; 99th percentile of the error in depth (in pixel widths) and of the normal (in degrees,\n\
        smooth surfaces only). *cone* is `sphere-cone`. *On the front* counts the settings of each method\n\
        that have no wrong pixels and that no other setting beats in operations, failures and depth. A scene\n\
        in italics has an uncertified field: its results hold for this view only.\n\n"
        .to_owned();
    text += "| scene | leaves | evaluations | cone | operations | cone | wrong | out of steps | depth | cone | normal | undecided | on the front |\n";
    text += "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    charts.iter().for_each(|(name, chart)| text += &summary_line(name, chart));
    text
}

fn summary_line(name: &str, chart: &Results) -> String {
    let row = |method: &str| chart.methods.iter().find(|row| row.default && row.method == method);
    let cell = |method: &str, format: &dyn Fn(&Row) -> String| {
        row(method).map_or_else(|| "-".to_owned(), format)
    };
    let both =
        |of: &dyn Fn(&Row) -> String| format!("{} | {}", cell("auto", of), cell("sphere-cone", of));
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
        cell("auto", &|row| row.wrong().to_string()),
        cell("auto", &|row| row.capped.to_string()),
        both(&|row| p99(&row.depth_px)),
        cell("auto", &|row| p99(&row.normal_deg)),
        chart.oracle.undecided,
        front.collect::<Vec<_>>().join(", "),
    )
}

/// Returns the summary, then all methods at their defaults, scene by scene.
fn page(args: &Chart, charts: &[(String, Results)]) -> String {
    let mut text = head(TITLE, &command_line(args, "-o FOLDER"), charts) + &summary(charts);
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
    statistic(errors, |errors| format!("{:.1e}", errors.p99))
}

/// Formats a number with few digits.
fn short(value: f64) -> String {
    if value >= 0.01 { format!("{value}") } else { format!("{value:.1e}") }
}
