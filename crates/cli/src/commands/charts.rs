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

/// Every method as it is used unless told otherwise, scene by scene.
fn page(charts: &[(String, Figures)]) -> String {
    let mut text = "# Charts\n\nWritten by `sdfc chart FILE... -o FOLDER`.\n".to_owned();
    if let Some((_, chart)) = charts.first() {
        let [width, height] = chart.size;
        let made = chart.made.iter().map(|made| format!("; {made}")).collect::<String>();
        let _ = writeln!(text, "{width}x{height} on {}, {}{made}.", chart.adapter, chart.driver);
    }
    for (name, chart) in charts {
        let _ = write!(text, "\n## {name}\n\n`{}`, {} leaves\n\n", chart.scene, chart.leaves);
        let _ = write!(text, "![operations against error]({name}.svg)\n\n");
        text += "| method | setting | evaluations / px | p99 | operations / px | ms | missed | false | capped | depth px p99 | normal deg p99 |\n";
        text += "|---|---|---|---|---|---|---|---|---|---|---|\n";
        chart.methods.iter().filter(|row| row.default).for_each(|row| text += &line(row));
    }
    text
}

fn line(row: &Row) -> String {
    let settings = row.settings.iter().map(|(name, value)| format!("{name} {value}"));
    format!(
        "| `{}` | {} | {:.1} | {} | {:.0} | {:.1} | {} | {} | {} | {:.1e} | {:.1e} |\n",
        row.method,
        settings.collect::<Vec<_>>().join(", "),
        row.evals_per_pixel.mean,
        row.evals_per_pixel.p99,
        row.ops_per_pixel,
        row.frame_ms.median,
        row.missed,
        row.false_hits,
        row.capped,
        row.depth_px.p99,
        row.normal_deg.p99,
    )
}
