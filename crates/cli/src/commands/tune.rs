//! `sdfc tune`: the cheapest ray method and setting that keep an error.

use sdfc::ChartOptions;
use sdfc::accuracy_data::chart::{Chart, Row};
use sdfc::lang::settings::RAY_METHODS;

use super::chart::figures;
use crate::args::Tune;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::{self, Output};

/// Charts the scene and says what to write in it.
///
/// # Errors
///
/// As `chart`; or no method keeps the error.
pub fn run(args: &Tune, console: &Console) -> Result<(), Failure> {
    let scene = super::scene(&args.file, sdfc::lang::Options::default(), console)?;
    let json = args.json.as_deref().map(Output::new);
    output::distinct(&args.file, &args.json.as_deref().into_iter().collect::<Vec<_>>())?;
    json.iter().try_for_each(Output::check)?;
    let all = || RAY_METHODS.map(str::to_owned).to_vec();
    let methods = if args.march.is_empty() { all() } else { args.march.clone() };
    let options = ChartOptions { size: args.size, methods, ..ChartOptions::default() };
    let chart = figures(&args.file, &scene, &options, &args.cache, console)?;
    // The figures say why no method keeps the error, if none does.
    if let Some(json) = &json {
        json.write(&super::json(&chart)?)?;
    }
    let advice = advice(&chart, args.max_error, scene.method())?;
    if json == Some(Output::Stdout) { Ok(()) } else { output::to_stdout(advice.as_bytes()) }
}

/// What to write, and what it costs beside what the scene has.
fn advice(chart: &Chart, error: f64, method: &str) -> Result<String, Failure> {
    if chart.oracle.hit == 0 {
        let why = "nothing is seen at this size, so no method can be told from another; try a greater --size";
        return Err(Failure::Call(why.to_owned()));
    }
    let Some(best) = chart.cheapest(error) else { return Err(none_keeps(chart, error)) };
    let [width, height] = chart.size;
    let mut text = format!(
        "{}: {width}x{height}, on {}, {}\nno pixel wrong, none capped, 99 of 100 depths within {error} px:\n\n",
        chart.scene, chart.adapter, chart.driver
    );
    let now = chart.methods.iter().find(|row| row.default && row.method == method);
    if !chart.certified {
        text.insert_str(0, "the field is uncertified: this holds of the view that was measured\n");
    }
    text += &line("cheapest", best);
    text += &now.map(|row| line("now", row)).unwrap_or_default();
    text += &match now {
        Some(now) if now == best => "\nThe scene has it already.\n".to_owned(),
        Some(_) | None => format!("\nWrite in the scene:\n\n  {}\n", best.setting()),
    };
    Ok(text)
}

fn line(what: &str, row: &Row) -> String {
    format!(
        "  {what:<9} {:<44} {:>8.1} evaluations, {:>8.0} operations a pixel; {:.5} px, {} wrong, {} capped\n",
        row.setting(),
        row.evals_per_pixel.mean,
        row.ops_per_pixel,
        row.depth_px.p99,
        row.wrong(),
        row.capped,
    )
}

/// The most accurate row without a fault is the one to ask for less than.
fn none_keeps(chart: &Chart, error: f64) -> Failure {
    let sound = chart.methods.iter().filter(|row| row.keeps(f64::INFINITY));
    let finest = sound.min_by(|a, b| a.depth_px.p99.total_cmp(&b.depth_px.p99));
    Failure::Call(match finest {
        Some(row) => format!(
            "no method keeps {error} px here; the nearest is {} with {:.2e} px",
            row.setting(),
            row.depth_px.p99
        ),
        None => "every method misses something here, or runs out of steps; `sdfc chart` shows what"
            .to_owned(),
    })
}
