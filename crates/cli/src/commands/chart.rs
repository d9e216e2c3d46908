//! `sdfc chart`: every ray method against the oracle.

use std::ops::ControlFlow;
use std::path::Path;

use sdfc::accuracy_data::chart::{Chart as Figures, Font, Row, Theme, png, svg};
use sdfc::accuracy_data::{Quantiles, TruthStore};
use sdfc::render::Gpu;
use sdfc::{ChartOptions, Error, OracleOptions, Scene};

use super::charts;
use crate::args::{Cache, Chart};
use crate::cache::TruthFolder;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::{self, Output};

/// The method that others are held against.
const AUTO: &str = "auto";

/// Charts the scene, shows a table and writes the picture and the figures.
///
/// # Errors
///
/// The scene cannot be read, has errors or draws nothing; the machine has no adapter, or cannot write.
pub fn run(args: &Chart, console: &Console) -> Result<(), Failure> {
    match (&args.files[..], &args.output) {
        (files, None) if args.table.is_some() => charts::table(args, files, console),
        (files, Some(folder)) if folder.is_dir() => charts::run(args, files, folder, console),
        ([file], _) => one(args, file, console),
        (_, Some(_) | None) => {
            Err(Failure::Call("several scenes need a folder that exists, with -o".to_owned()))
        }
    }
}

fn one(args: &Chart, file: &Path, console: &Console) -> Result<(), Failure> {
    let [picture, json] = [&args.output, &args.json].map(|path| path.as_deref().map(Output::new));
    let paths: Vec<_> =
        [&args.output, &args.json].into_iter().filter_map(|path| path.as_deref()).collect();
    output::distinct(file, &paths)?;
    for output in picture.iter().chain(&json) {
        output.check()?;
    }
    let form = args.output.as_deref().map_or(Ok(Form::Svg), Form::of)?;
    let chart = charted(args, file, console)?;
    if ![&picture, &json].contains(&&Some(Output::Stdout)) {
        output::to_stdout(table(&chart).as_bytes())?;
    }
    if let Some(picture) = picture {
        picture.write(&drawn(&chart, form, args.dark)?)?;
    }
    json.map_or(Ok(()), |json| json.write(&super::json(&chart)?))
}

/// A scene's chart.
pub(super) fn charted(args: &Chart, file: &Path, console: &Console) -> Result<Figures, Failure> {
    let scene = super::scene(file, sdfc::lang::Options::default(), console)?;
    let options =
        ChartOptions { size: args.size, methods: args.march.clone(), ..ChartOptions::default() };
    let chart = figures(file, &scene, &options, &args.cache, console)?;
    Ok(Figures { made: args.note.clone(), ..chart })
}

/// A kind of picture.
#[derive(Clone, Copy)]
pub(super) enum Form {
    /// By its shapes.
    Svg,
    /// By its pixels.
    Png,
}

impl Form {
    /// By the path's ending; a stream is SVG.
    fn of(path: &Path) -> Result<Self, Failure> {
        if path.as_os_str() == "-" {
            return Ok(Self::Svg);
        }
        match path.extension().map(|ending| ending.to_ascii_lowercase()) {
            Some(ending) if ending == "svg" => Ok(Self::Svg),
            Some(ending) if ending == "png" => Ok(Self::Png),
            Some(_) | None => Err(Failure::Call(format!(
                "{} is no folder, and its name does not end in .svg or .png",
                path.display()
            ))),
        }
    }
}

/// The picture of a chart.
pub(super) fn drawn(chart: &Figures, form: Form, dark: bool) -> Result<Vec<u8>, Failure> {
    let font = Font(sdfc::lang::font::SANS);
    let theme = if dark { Theme::DARK } else { Theme::LIGHT };
    let picture = match form {
        Form::Svg => svg(chart, font).map(String::into_bytes),
        Form::Png => png(chart, font, &theme),
    };
    picture.map_err(|error| Failure::Machine(error.to_string()))
}

/// Draws and compares, with bars of progress.
pub(super) fn figures(
    file: &Path,
    scene: &Scene,
    options: &ChartOptions,
    cache: &Cache,
    console: &Console,
) -> Result<Figures, Failure> {
    let failed = |error: Error| super::lowering(&error, console);
    let gpu = Gpu::new().map_err(|error| failed(error.into()))?;
    let truth = console.progress("oracle");
    let pictures = console.progress("methods");
    let kept = TruthFolder::of(cache);
    let asked = OracleOptions {
        progress: &|part| truth.set(part.done, part.total),
        kept: kept.as_ref().map(|folder| folder as &dyn TruthStore),
    };
    let chart = scene.chart(&file.display().to_string(), &gpu, options, asked, &mut |part| {
        pictures.set(part.done, part.total);
        ControlFlow::Continue(())
    });
    drop((truth, pictures));
    chart.map_err(failed)
}

/// The chart for people who read figures.
fn table(chart: &Figures) -> String {
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
    text += "\n*: the default; +: no other is cheaper and better.\n";
    text + &outdone(chart)
}

/// A line where other methods take fewer operations than `auto` and err less.
pub(super) fn outdone(chart: &Figures) -> String {
    let mut names: Vec<&str> = Vec::new();
    for row in chart.outdoing(AUTO) {
        if !names.contains(&row.method.as_str()) {
            names.push(&row.method);
        }
    }
    let names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    match names.as_slice() {
        [] => String::new(),
        [name] => format!("{name} is cheaper and nearer than `{AUTO}` here.\n"),
        names => format!("{} are cheaper and nearer than `{AUTO}` here.\n", names.join(", ")),
    }
}

/// A figure of some errors; of none there is nothing to say.
pub(super) fn told(errors: &Quantiles, figure: impl FnOnce(&Quantiles) -> String) -> String {
    if errors.n == 0 { "-".to_owned() } else { figure(errors) }
}

fn line(row: &Row) -> String {
    let settings = row.settings.iter().map(|(name, value)| format!("{name} {value:.3e}"));
    let depth = |of: fn(&Quantiles) -> f64, places: usize| {
        told(&row.depth_px, |errors| format!("{:.places$}", of(errors)))
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
        told(&row.normal_deg, |errors| format!("{:.5}", errors.p99)),
        row.capped,
        row.nan,
    )
}
