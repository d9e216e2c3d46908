//! What the driver of this machine reports of the shaders of all examples.

use std::time::Instant;

use libtest_mimic::Failed;
use sdfc_tests::compiled_examples;

use crate::driver::{self, Device};
use crate::spirv;
use crate::table::Part;

/// Compiles the shader of each example's picture and prints a table in Markdown: every number that
/// the driver reports, under its own name, and the time to compile in milliseconds.
pub fn print_statistics() -> Result<(), Failed> {
    let device = Device::open()?;
    println!("Driver: {}.\n", device.driver());
    let mut titles = Vec::new();
    for (name, scene) in compiled_examples()? {
        let code = spirv(scene, Part::Render)?;
        let words = driver::words(&code);
        let start = Instant::now();
        let mut found = device.statistics(&words).map_err(|error| format!("{name}: {error}"))?;
        found.retain(|(title, _)| !title.to_lowercase().contains("hash"));
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        if titles.is_empty() {
            titles = found.iter().map(|(title, _)| title.clone()).collect();
            println!("| example | {} | ms |", titles.join(" | "));
            println!("|---{}|--:|", "|--:".repeat(titles.len()));
        }
        let number = |title: &String| {
            let known = found.iter().find(|(name, _)| name == title);
            known.map_or(String::new(), |(_, number)| number.to_string())
        };
        let numbers: Vec<String> = titles.iter().map(number).collect();
        println!("| {name} | {} | {milliseconds:.0} |", numbers.join(" | "));
    }
    Ok(())
}
