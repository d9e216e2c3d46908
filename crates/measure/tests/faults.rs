//! A classroom practical's march fails at the scenes under `examples/faults`, each by the fault that it is there
//! for; `auto` does not.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::Compiler;
use sdfc_measure::{FaultRow, FaultVariant, count_faults, fault_scenes};
use sdfc_render::{Gpu, testing};

/// Width and height in pixels.
const SIZE: [u32; 2] = [160, 100];
/// At most so many of the pixels of `auto` are wrong.
const RIGHT: f64 = 1e-3;

/// What a fault does to the practical's picture, as a share of the compared pixels, and at least how much.
type Symptom = (fn(&FaultVariant) -> usize, f64);

fn symptom(scene: &str) -> Option<Symptom> {
    match scene {
        // The loop ends at a negative distance.
        "overshoot" => Some((|picture| picture.missed, 0.4)),
        // The least distance is taken off each step.
        "stall" => Some((|picture| picture.missed, 0.6)),
        // The tolerance is absolute.
        "small" => Some((|picture| picture.false_hits + picture.misplaced, 0.9)),
        // Differences vanish.
        "far" => Some((|picture| picture.miscolored, 0.05)),
        _ => None,
    }
}

fn main() {
    let without_gpu = testing::without_gpu();
    let trials = fault_scenes().map(|(name, text)| {
        Trial::test(name, move || the_practical_fails(name, text)).with_ignored_flag(without_gpu)
    });
    libtest_mimic::run(&Arguments::from_args(), trials.into()).exit();
}

fn the_practical_fails(name: &str, text: &str) -> Result<(), Failed> {
    let (part, least) = symptom(name).ok_or("the scene has no symptom")?;
    let scene = Compiler::new().compile(name, text)?;
    let row = count_faults(&scene, name, &Gpu::new()?, SIZE)?;
    let FaultRow { compared, variants, .. } = &row;
    let [practical, _, auto] = &variants[..] else { return Err("three pictures".into()) };
    let share = part(practical) as f64 / *compared as f64;
    if share < least {
        return Err(format!("the practical's share is {share}: {row:?}").into());
    }
    // Most of the picture is looked at.
    if auto.wrong > RIGHT || *compared < 14_000 {
        return Err(format!("{row:?}").into());
    }
    Ok(())
}
