//! `sdfc bench`: compares the specialised shader with interpreting baselines.

use std::path::Path;

use sdfc::{Compiler, Diagnostics, Scene};
use sdfc_measure::chart::{Font, Growth, growth_svg};
use sdfc_measure::{BenchOptions, BenchReport, BenchRow, BenchVariant, bench, large_suite, suite};

use crate::args::Bench;
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::output::{self, Output};

/// Measures the scenes, prints a table and writes the results. Both grow with each scene, so that
/// nothing that was measured is lost if the program is stopped.
///
/// # Errors
///
/// A scene cannot be read, has errors or draws nothing; no scene has the wanted name; the machine
/// has no GPU, or cannot write the results.
pub fn run(args: &Bench, console: &Console) -> Result<(), Failure> {
    let scene = args.file.as_deref().map(|file| Entry::from_file(file, console)).transpose()?;
    let json = args.json.as_deref().map(Output::new);
    if let (Some(file), Some(json)) = (&args.file, &args.json) {
        output::distinct(file, &[json])?;
    }
    json.as_ref().map_or(Ok(()), Output::check)?;
    let plot = args.plot.as_deref().map(Output::new);
    plot.as_ref().map_or(Ok(()), Output::check)?;
    if args.faults {
        return super::faults::run(args.size, json, console);
    }

    let mut scenes: Vec<_> = scene.into_iter().collect();
    let small = args.suite.then(suite).into_iter().flatten();
    let large = args.large.then(large_suite).into_iter().flatten();
    let wanted = |name: &str| args.only.as_ref().is_none_or(|part| name.contains(part));
    for (name, text) in small.filter(|(name, _)| wanted(name)) {
        scenes.push(Entry::from_suite(name, &text, true)?);
    }
    for (name, text) in large.filter(|(name, _)| wanted(name)) {
        scenes.push(Entry::from_suite(name, &text, false)?);
    }
    if scenes.is_empty() {
        let part = args.only.as_deref().unwrap_or_default();
        return Err(Failure::Call(format!("no scene of the suites has `{part}` in its name")));
    }
    let gpu = super::gpu(console)?;
    let interrupt = Interrupt::watch("stopped; nothing was written", console);
    let (adapter, driver) = (gpu.info().name.clone(), gpu.info().driver.clone());
    let mut report = BenchReport { adapter, driver, rows: Vec::new() };
    let prints_table = json != Some(Output::Stdout);
    for Entry { name, scene, live, baselines } in &scenes {
        let (size, baselines) = (args.size, *baselines);
        let options = BenchOptions::new().size(size).baselines(baselines);
        let progress = console.progress(name);
        let live = live.as_ref().map_err(String::as_str);
        let row = bench(scene, live, name, &gpu, &options, &mut |part| {
            progress.set(part.done, part.total);
            interrupt.flow()
        });
        drop(progress);
        let failed = |error| interrupt.explained(super::measuring(&error, console));
        report.rows.push(row.map_err(failed)?);
        interrupt.set_message(stopped(report.rows.len(), scenes.len(), json.as_ref()));
        if prints_table {
            output::to_stdout(latest(&report).as_bytes())?;
            json.as_ref().map_or(Ok(()), |json| json.write(&output::json(&report)?))?;
        }
    }
    if let Some(plot) = plot {
        let drawn = growth_svg(&growth(&report), Font(sdfc_lang::font::SANS));
        plot.write(drawn.map_err(|error| Failure::Machine(error.to_string()))?.as_bytes())?;
    }
    match json {
        Some(json) if !prints_table => json.write(&output::json(&report)?),
        // A file has all rows already.
        Some(_) | None => Ok(()),
    }
}

/// Says what is left of an interrupted run.
fn stopped(done: usize, all: usize, json: Option<&Output>) -> String {
    match json {
        Some(Output::Stdout) => "stopped; nothing was written".to_owned(),
        Some(Output::File(path)) => {
            format!("stopped after {done} of {all} scenes; they are in {}", path.display())
        }
        None => format!("stopped after {done} of {all} scenes"),
    }
}

/// Returns the cost per pixel of the scattered scenes, as CPU time if the GPU is a software one.
fn growth(report: &BenchReport) -> Growth {
    let names = ["culled", "specialized"];
    let rows = || report.rows.iter().filter(|row| row.scene.starts_with("scattered"));
    let points = |name: &str| {
        let point = |row: &BenchRow| {
            let variant = row.variants.iter().find(|variant| variant.name == name)?;
            let frame = variant.cpu_ms.or(variant.frame_ms.map(|times| times.median))?;
            let [width, height] = row.size.map(f64::from);
            Some((row.leaves as f64, 1e6 * frame / (width * height)))
        };
        (name.to_owned(), rows().filter_map(point).collect())
    };
    let size = rows().next().map_or([0, 0], |row| row.size);
    let (adapter, driver) = (&report.adapter, &report.driver);
    Growth {
        title: format!("scattered, {}x{}, on {adapter}, {driver}", size[0], size[1]),
        cost: "nanoseconds per pixel".to_owned(),
        series: names.map(points).to_vec(),
    }
}

/// A scene that is measured.
struct Entry {
    name: String,
    scene: Scene,
    /// The same scene with its numbers as params, or why it does not compile with them.
    live: Result<Scene, String>,
    /// True if interpreters and live literals are measured. They take minutes on large scenes.
    baselines: bool,
}

impl Entry {
    fn from_file(file: &Path, console: &Console) -> Result<Self, Failure> {
        let input = sdfc_files::read(file)?;
        let folder = sdfc_files::Folder::of(file);
        let compiler = super::compiler().resolver(&folder);
        let scene = super::shown(compiler.compile(&input.name, &input.text), console)?;
        let live = compiler.live_literals(None).compile(&input.name, &input.text);
        let live = live.map_err(|errors| without_live_literals(&errors));
        if !scene.draws() {
            return Err(super::lowering(&sdfc::Error::NothingDrawn, console));
        }
        Ok(Self { name: input.name, scene, live, baselines: true })
    }

    fn from_suite(name: String, text: &str, baselines: bool) -> Result<Self, Failure> {
        let compile = |compiler: Compiler<'_>| {
            // The suite is part of this program, so an error in it is a bug of this program.
            let bug = |_| Failure::Machine(format!("the suite's scene `{name}` does not compile"));
            compiler.compile(&name, text).map_err(bug)
        };
        let (scene, live) =
            (compile(Compiler::new())?, compile(Compiler::new().live_literals(None))?);
        Ok(Self { name, scene, live: Ok(live), baselines })
    }
}

/// Says why a scene that compiles does not compile with its numbers as params.
fn without_live_literals(errors: &Diagnostics) -> String {
    let error = errors.iter().find(|diagnostic| diagnostic.is_error());
    let message = error.map_or("", |error| &error.message);
    format!("the scene does not compile with its numbers as params: {message}")
}

/// Formats the results of the latest scene, with the device above the first one: times in
/// milliseconds, and ratios to the specialised shader. CPU time is given for a software GPU.
fn latest(report: &BenchReport) -> String {
    let BenchReport { adapter, driver, rows } = report;
    let Some(row) = rows.last() else { return String::new() };
    let BenchRow { scene, leaves, size: [width, height], method, auto, variants, .. } = row;
    let mut text = match rows.len() {
        1 => format!("{adapter}, driver {driver}\n\n"),
        _ => "\n".to_owned(),
    };
    text += &format!("{scene}: {leaves} leaves, {width}x{height}, method {method}, auto is {auto}");
    for (ratio, of) in
        [(row.auto_times_best_frame, "frame"), (row.auto_times_best_first_picture, "first picture")]
    {
        text += &ratio.map_or_else(String::new, |ratio| format!(", {ratio:.2} of the best {of}"));
    }
    text += "\n  variant             frame ms   ratio    cpu ms   ratio  evals/px  leaves/px  iters/eval  front ms  analyze ms  lower ms  pipeline ms  first picture ms\n";
    variants.iter().for_each(|variant| text += &line(variant));
    text
}

fn line(variant: &BenchVariant) -> String {
    let name = variant.name;
    let Some(frame) = variant.frame_ms else {
        let why = variant.why.get("frame_ms").map_or("", String::as_str);
        return format!("  {name:<18}  {:>8}  {why}\n", "-");
    };
    let number = |value: Option<f64>, width: usize, decimals: usize| match value {
        Some(value) => format!("{value:>width$.decimals$}"),
        None => format!("{:>width$}", "-"),
    };
    let (compile, leaves) = (variant.compile_ms.as_ref(), variant.leaf_evals_per_pixel.as_ref());
    let notes = [
        variant.live_literals.map(|count| format!("{count} live literals")),
        variant.differing_pixels.filter(|count| *count > 0).map(|n| format!("{n} pixels differ")),
    ];
    let notes: Vec<String> = notes.into_iter().flatten().collect();
    [
        format!("  {name:<18}"),
        number(Some(frame.median), 8, 1),
        number(variant.times_specialized, 6, 2),
        number(variant.cpu_ms, 8, 1),
        number(variant.cpu_times_specialized, 6, 2),
        number(variant.evals_per_pixel.map(|evals| evals.mean), 8, 1),
        number(leaves.and_then(|leaves| leaves.mean), 9, 0),
        number(variant.iterations_per_eval.map(|turns| turns as f64), 10, 0),
        number(compile.and_then(|times| times.front), 8, 1),
        number(compile.and_then(|times| times.analyze), 10, 1),
        number(compile.and_then(|times| times.lower), 8, 1),
        number(compile.and_then(|times| times.pipeline), 11, 1),
        number(variant.first_picture_ms, 16, 1),
        notes.join(", "),
    ]
    .join("  ")
    .trim_end()
    .to_owned()
        + "\n"
}
