//! `sdfc chart` for one scene: compares all ray methods with the oracle.

use std::path::Path;

use sdfc::{Error, Scene};
use sdfc_measure::chart::{Chart as Results, Font, Row, Theme, png, svg};
use sdfc_measure::{ChartOptions, OracleOptions, Quantiles, TruthStore};
use sdfc_render::Gpu;

use crate::args::{Cache, Chart};
use crate::cache::TruthFolder;
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::output::{self, Output};

/// The method that the others are compared with.
const AUTO: &str = "auto";

/// Charts one scene, prints a table and writes the picture and the results.
///
/// # Errors
///
/// The scene cannot be read, has errors or draws nothing; the machine has no GPU, or cannot write.
pub(super) fn one(args: &Chart, file: &Path, console: &Console) -> Result<(), Failure> {
    let [picture, json] = [&args.output, &args.json].map(|path| path.as_deref().map(Output::new));
    let paths: Vec<_> =
        [&args.output, &args.json].into_iter().filter_map(|path| path.as_deref()).collect();
    output::distinct(file, &paths)?;
    for output in picture.iter().chain(&json) {
        output.check()?;
    }
    let form = args.output.as_deref().map_or(Ok(Form::Svg), Form::of)?;
    let interrupt = Interrupt::watch("stopped; nothing was written", console);
    let chart = charted(args, file, console, &interrupt)?;
    if ![&picture, &json].contains(&&Some(Output::Stdout)) {
        output::to_stdout(table(&chart).as_bytes())?;
    }
    if let Some(picture) = picture {
        picture.write(&drawn(&chart, form, args.dark)?)?;
    }
    json.map_or(Ok(()), |json| json.write(&output::json(&chart)?))
}

/// Returns the chart of a scene.
pub(super) fn charted(
    args: &Chart,
    file: &Path,
    console: &Console,
    interrupt: &Interrupt,
) -> Result<Results, Failure> {
    let scene = super::scene(file, super::compiler(), console)?;
    let options = ChartOptions::new().size(args.size).methods(args.march.clone());
    let chart = measured(file, &scene, &options, &args.cache, console, interrupt)?;
    Ok(Results { made: args.note.clone(), ..chart })
}

/// A picture format.
#[derive(Clone, Copy)]
pub(super) enum Form {
    /// Scalable Vector Graphics.
    Svg,
    /// Portable Network Graphics.
    Png,
}

impl Form {
    /// Returns the format for a file extension; stdout is SVG.
    fn of(path: &Path) -> Result<Self, Failure> {
        if path.as_os_str() == "-" {
            return Ok(Self::Svg);
        }
        match path.extension().map(|ending| ending.to_ascii_lowercase()) {
            Some(ending) if ending == "svg" => Ok(Self::Svg),
            Some(ending) if ending == "png" => Ok(Self::Png),
            Some(_) | None => Err(Failure::Call(format!(
                "{} is not a folder and does not end in .svg or .png",
                path.display()
            ))),
        }
    }
}

/// Draws a chart.
pub(super) fn drawn(chart: &Results, form: Form, dark: bool) -> Result<Vec<u8>, Failure> {
    let font = Font(sdfc_lang::font::SANS);
    let theme = if dark { Theme::DARK } else { Theme::LIGHT };
    let picture = match form {
        Form::Svg => svg(chart, font).map(String::into_bytes),
        Form::Png => png(chart, font, &theme),
    };
    picture.map_err(|error| Failure::Machine(error.to_string()))
}

/// Measures all methods, with progress bars.
pub(super) fn measured(
    file: &Path,
    scene: &Scene,
    options: &ChartOptions,
    cache: &Cache,
    console: &Console,
    interrupt: &Interrupt,
) -> Result<Results, Failure> {
    let failed = |error: Error| interrupt.explained(super::lowering(&error, console));
    let gpu = Gpu::new().map_err(|error| failed(error.into()))?;
    let progress = console.progress("computing exact hits");
    let folder = TruthFolder::new(cache);
    let name = file.display().to_string();
    let asked = OracleOptions {
        progress: &|part| progress.set(part.done, part.total),
        store: folder.as_ref().map(|folder| folder as &dyn TruthStore),
    };
    let chart = sdfc_measure::chart(scene, &name, &gpu, options, asked, &mut |part| {
        progress.rename("drawing with all methods");
        progress.set(part.done, part.total);
        interrupt.flow()
    });
    drop(progress);
    chart.map_err(failed)
}

/// Formats the chart as a table.
fn table(chart: &Results) -> String {
    let [width, height] = chart.size;
    let counts = chart.oracle;
    let mut text = format!(
        "{}: {} leaves, {}{width}x{height}, on {}, {}\noracle: {} hit, {} miss, {} at edges, {} undecided\n\n",
        chart.scene,
        chart.leaves,
        if chart.certified { "" } else { "field uncertified, " },
        chart.adapter,
        chart.driver,
        counts.hit,
        counts.miss,
        counts.edge,
        counts.undecided,
    );
    text += "  method         setting            evals/px   p99    ops/px  frame ms  missed  false   depth px p50      p99      max  normal deg p99  capped  nan\n";
    chart.methods.iter().for_each(|row| text += &line(row));
    text += "\n*: default setting; +: no other setting is both cheaper and more accurate.\n";
    text + &outdone(chart)
}

/// Returns one line that names methods which are cheaper and more accurate than `auto`, if any.
pub(super) fn outdone(chart: &Results) -> String {
    let mut names: Vec<&str> = Vec::new();
    for row in chart.outdoing(AUTO) {
        if !names.contains(&row.method.as_str()) {
            names.push(&row.method);
        }
    }
    let names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    match names.as_slice() {
        [] => String::new(),
        [name] => format!("{name} is cheaper and more accurate than `{AUTO}` here.\n"),
        names => {
            format!("{} are cheaper and more accurate than `{AUTO}` here.\n", names.join(", "))
        }
    }
}

/// Formats a statistic of errors, or `-` if there are none.
pub(super) fn statistic(errors: &Quantiles, format: impl FnOnce(&Quantiles) -> String) -> String {
    if errors.n == 0 { "-".to_owned() } else { format(errors) }
}

fn line(row: &Row) -> String {
    let settings = row.settings.iter().map(|(name, value)| format!("{name} {value:.3e}"));
    let depth = |of: fn(&Quantiles) -> f64, places: usize| {
        statistic(&row.depth_px, |errors| format!("{:.places$}", of(errors)))
    };
    format!(
        "{}{} {:<13}  {:<17}  {:>8.1}  {:>4}  {:>8.0}  {:>8.1}  {:>6}  {:>5}  {:>12}  {:>7}  {:>7}  {:>14}  {:>6}  {:>3}\n",
        if row.default { '*' } else { ' ' },
        if row.pareto { '+' } else { ' ' },
        row.method,
        settings.collect::<Vec<_>>().join(", "),
        row.evals_per_pixel.mean,
        row.evals_per_pixel.p99,
        row.ops_per_pixel,
        row.frame_ms.median,
        row.missed,
        row.false_hits,
        depth(|errors| errors.p50, 5),
        depth(|errors| errors.p99, 4),
        depth(|errors| errors.max, 3),
        statistic(&row.normal_deg, |errors| format!("{:.5}", errors.p99)),
        row.capped,
        row.nan,
    )
}
