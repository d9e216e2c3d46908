//! `sdfc bench --faults`: how far a classroom practical's pictures are from right, and ours.

use sdfc::render::Gpu;
use sdfc::{FaultReport, FaultRow, FaultVariant, compile, faults};

use crate::console::Console;
use crate::failure::Failure;
use crate::output::{self, Output};

/// Measures the scenes, shows a table and writes the figures.
///
/// # Errors
///
/// The machine has no adapter, or cannot write the figures.
pub fn run(size: [u32; 2], json: Option<Output>, console: &Console) -> Result<(), Failure> {
    let failed = |error: sdfc::Error| super::lowering(&error, console);
    let gpu = Gpu::new().map_err(|error| failed(error.into()))?;
    let mut rows = Vec::new();
    for (name, text) in faults() {
        // The program's own scenes: that one of them has errors is a fault of this program.
        let fault = || Failure::Machine(format!("the scene `{name}` does not compile"));
        let scene = compile(name, text).scene.ok_or_else(fault)?;
        rows.push(scene.faults(name, &gpu, size).map_err(failed)?);
    }
    let (adapter, driver) = (gpu.info().name.clone(), gpu.info().driver.clone());
    let report = FaultReport { adapter, driver, rows };
    if json != Some(Output::Stdout) {
        output::to_stdout(table(&report).as_bytes())?;
    }
    json.map_or(Ok(()), |json| json.write(&super::json(&report)?))
}

/// The report for people: shares of the compared pixels in percent.
fn table(report: &FaultReport) -> String {
    let mut text = format!("{}, driver {}\n", report.adapter, report.driver);
    for row in &report.rows {
        let FaultRow { scene, size: [width, height], compared, variants } = row;
        text += &format!("\n{scene}: {width}x{height}, {compared} pixels compared\n");
        text += "  field, march        wrong %  missed   false  misplaced  miscolored  evals/px\n";
        for variant in variants {
            let FaultVariant { name, missed, false_hits, misplaced, miscolored, .. } = variant;
            text += &format!(
                "  {name:<18} {:>8.2} {missed:>7} {false_hits:>7} {misplaced:>10} {miscolored:>11} {:>9.1}\n",
                100.0 * variant.wrong,
                variant.evals_per_pixel
            );
        }
    }
    text
}
