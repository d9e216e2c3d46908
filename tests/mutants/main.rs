//! Scenes that show whether the rules for the steps of rays are needed, and the table of mutants.
//!
//! A mutant is one rule of the analysis or of a ray method that is broken on purpose. `table.txt`
//! lists for each mutant a file, a text of that file, the text to put in its place, and a scene
//! that is drawn wrong once that is done. The tests here check the other half: every text of the
//! table occurs exactly once in its file, and the unchanged compiler draws every scene right.
//!
//! `tests/mutants/run` applies the mutants one by one to a copy of the repository and expects the
//! test of the mutant's scene to fail there. It builds the compiler once for each mutant, so it is
//! run by hand, after a change to the analysis or to a ray method.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

mod table;

use std::collections::BTreeSet;

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::FrameValues;
use sdfc_measure::{Metrics, OracleOptions, Sampler, compare, oracle, truth};
use sdfc_render::{Gpu, testing};

use crate::table::{Expected, Mutant};

/// Width and height of the pictures in pixels.
const SIZE: [u32; 2] = [96, 72];

/// Largest 99th percentile of the depth error in a right picture, in pixel widths.
const DEPTH: f64 = 0.5;

/// The folder of the repository.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

fn main() {
    let without_gpu = testing::without_gpu();
    let mutants = table::read(include_str!("table.txt")).expect("the table is well formed");
    let all = mutants.clone();
    let mut trials = vec![
        Trial::test("every_original_text_occurs_exactly_once", move || occur_once(&all)),
        Trial::test("every_scene_of_the_folder_has_a_mutant", {
            let all = mutants.clone();
            move || are_used(&all)
        }),
    ];
    trials.extend(mutants.into_iter().map(|mutant| {
        let name = format!("the_scene_of_{}_is_drawn_right", mutant.name);
        Trial::test(name, move || is_drawn_right(&mutant)).with_ignored_flag(without_gpu)
    }));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn occur_once(mutants: &[Mutant]) -> Result<(), Failed> {
    let mut wrong = Vec::new();
    for Mutant { name, file, original, .. } in mutants {
        let source = std::fs::read_to_string(format!("{ROOT}/{file}"))?;
        let count = source.matches(original.as_str()).count();
        if count != 1 {
            wrong.push(format!("{name}: {file} has {count} of `{original}`"));
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n").into()) }
}

fn are_used(mutants: &[Mutant]) -> Result<(), Failed> {
    let used: BTreeSet<String> = mutants.iter().map(|mutant| mutant.scene.clone()).collect();
    for entry in std::fs::read_dir(format!("{ROOT}/tests/mutants"))? {
        let path = entry?.path();
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let scene = format!("mutants/{stem}");
        if path.extension().is_some_and(|end| end == "sdf") && !used.contains(&scene) {
            return Err(format!("no mutant uses {scene}.sdf").into());
        }
    }
    Ok(())
}

/// Draws the mutant's scene and compares it with the surface that the oracle finds.
fn is_drawn_right(mutant: &Mutant) -> Result<(), Failed> {
    let text = std::fs::read_to_string(format!("{ROOT}/tests/{}.sdf", mutant.scene))?;
    let scene = sdfc::Compiler::new().compile("mutant.sdf", &text)?;
    if mutant.expected == Expected::Right && !scene.is_certified() {
        // The analysis promises nothing, so no picture can break a promise.
        return Ok(());
    }
    let method: sdfc::Method = mutant.method.parse()?;
    let frame = FrameValues::defaults(scene.params());
    let view = scene.view(&frame, SIZE)?;
    let truth = truth(&scene, &view, &frame, OracleOptions::default())?;
    let samples = Sampler::new(&scene, &Gpu::new()?, method)?.samples(&view, &frame)?;
    let metrics = compare(&oracle(&scene)?, &frame, &truth, &samples);
    if is_as_expected(&metrics, mutant.expected) {
        return Ok(());
    }
    Err(format!("expected {:?}, drawn: {metrics:?}", mutant.expected).into())
}

fn is_as_expected(metrics: &Metrics, expected: Expected) -> bool {
    let wrong = metrics.missed + metrics.false_hits + metrics.nan;
    match expected {
        Expected::Right => wrong == 0 && metrics.depth.pixels.p99 <= DEPTH,
        Expected::Measured { wrong: most, p99 } => {
            // One pixel in a thousand more, or half the depth error more, is a broken rule.
            let slack = u64::from(SIZE[0] * SIZE[1]) / 1000;
            wrong + metrics.capped <= most + slack && metrics.depth.pixels.p99 <= 1.5 * p99 + 0.01
        }
    }
}
