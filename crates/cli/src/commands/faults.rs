//! `sdfc bench --faults`: counts the wrong pixels of a naive ray marcher, and of sdfc.

use sdfc::Compiler;
use sdfc_measure::{FaultReport, FaultRow, FaultVariant, count_faults, fault_scenes};

use crate::console::Console;
use crate::failure::Failure;
use crate::output::{self, Output};

/// Measures the scenes, prints a table and writes the results.
///
/// # Errors
///
/// The machine has no GPU, or cannot write the results.
pub fn run(size: [u32; 2], json: Option<Output>, console: &Console) -> Result<(), Failure> {
    let gpu = super::gpu(console)?;
    let mut rows = Vec::new();
    for (name, text) in fault_scenes() {
        // The scenes are part of this program, so an error in one is a bug of this program.
        let bug = || Failure::Machine(format!("the scene `{name}` does not compile"));
        let scene = Compiler::new().compile(name, text).map_err(|_| bug())?;
        let row = count_faults(&scene, name, &gpu, size);
        rows.push(row.map_err(|error| super::measuring(&error, console))?);
    }
    let (adapter, driver) = (gpu.info().name.clone(), gpu.info().driver.clone());
    let report = FaultReport { adapter, driver, rows };
    if json != Some(Output::Stdout) {
        output::to_stdout(table(&report).as_bytes())?;
    }
    json.map_or(Ok(()), |json| json.write(&output::json(&report)?))
}

/// Formats the report: numbers of pixels, and the wrong ones in percent.
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
