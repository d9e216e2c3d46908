//! `sdfc tune`: finds the cheapest ray method and setting within an error limit.

use sdfc::Method;
use sdfc_lang::settings::RAY_METHODS;
use sdfc_measure::ChartOptions;
use sdfc_measure::chart::{Chart, Row};

use super::chart::measured;
use crate::args::Tune;
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::output::{self, Output};

/// Charts the scene and prints the setting to write in it.
///
/// # Errors
///
/// Those of `chart`; or no method stays within the limit.
pub fn run(args: &Tune, console: &Console) -> Result<(), Failure> {
    let scene = super::scene(&args.file, super::compiler(), console)?;
    let json = args.json.as_deref().map(Output::new);
    output::distinct(&args.file, &args.json.as_deref().into_iter().collect::<Vec<_>>())?;
    json.iter().try_for_each(Output::check)?;
    let all = || Method::all().filter(|method| RAY_METHODS.contains(&method.name())).collect();
    let methods = if args.march.is_empty() { all() } else { args.march.clone() };
    let options = ChartOptions::new().size(args.size).methods(methods);
    let interrupt = Interrupt::watch("stopped; nothing was written", console);
    let chart = measured(&args.file, &scene, &options, &args.cache, console, &interrupt)?;
    // Written first: the results show why no method stays within the limit, if none does.
    if let Some(json) = &json {
        json.write(&output::json(&chart)?)?;
    }
    let advice = advice(&chart, args.max_error, scene.method().name())?;
    if json == Some(Output::Stdout) { Ok(()) } else { output::to_stdout(advice.as_bytes()) }
}

/// Returns the recommended setting, compared with the scene's own.
fn advice(chart: &Chart, error: f64, method: &str) -> Result<String, Failure> {
    if chart.oracle.hit == 0 {
        let why = "the picture shows no surface at this size, so methods cannot be compared; use a larger --size";
        return Err(Failure::Call(why.to_owned()));
    }
    let Some(best) = chart.cheapest(error) else { return Err(out_of_reach(chart, error)) };
    let [width, height] = chart.size;
    let mut text = format!(
        "{}: {width}x{height}, on {}, {}\nno wrong pixels, no capped rays, error in depth (99th percentile) at most {error} px:\n\n",
        chart.scene, chart.adapter, chart.driver
    );
    let now = chart.methods.iter().find(|row| row.default && row.method == method);
    if !chart.certified {
        text.insert_str(
            0,
            "the field is uncertified: the results hold for the measured view only\n",
        );
    }
    text += &line("cheapest", best);
    text += &now.map(|row| line("now", row)).unwrap_or_default();
    text += &match now {
        Some(now) if now == best => "\nThe scene already uses it.\n".to_owned(),
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

/// Names the most accurate setting without wrong pixels.
fn out_of_reach(chart: &Chart, error: f64) -> Failure {
    let without_faults = chart.methods.iter().filter(|row| row.keeps(f64::INFINITY));
    let best = without_faults.min_by(|a, b| a.depth_px.p99.total_cmp(&b.depth_px.p99));
    Failure::Call(match best {
        Some(row) => format!(
            "no method reaches {error} px here; the best is {} with {:.2e} px: allow a greater error",
            row.setting(),
            row.depth_px.p99
        ),
        None => {
            "every method has wrong pixels or capped rays here; `sdfc chart` shows which".to_owned()
        }
    })
}
