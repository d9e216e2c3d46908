//! A naive marcher fails on each scene under `examples/faults` by the fault that the scene
//! demonstrates; `auto` does not.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::Compiler;
use sdfc_measure::{FaultRow, FaultVariant, count_faults, fault_scenes};
use sdfc_render::{Gpu, testing};

/// Width and height in pixels.
const SIZE: [u32; 2] = [160, 100];
/// Largest fraction of wrong pixels with `auto`.
const RIGHT: f64 = 1e-3;

/// Counts the pixels with a fault in the naive marcher's picture, and the least fraction of the
/// compared pixels.
type Symptom = (fn(&FaultVariant) -> usize, f64);

fn symptom(scene: &str) -> Option<Symptom> {
    match scene {
        // The loop ends at a negative distance.
        "overshoot" => Some((|picture| picture.missed, 0.4)),
        // The least distance is subtracted from each step.
        "stall" => Some((|picture| picture.missed, 0.6)),
        // The tolerance is absolute.
        "small" => Some((|picture| picture.false_hits + picture.misplaced, 0.9)),
        // Differences round to zero.
        "far" => Some((|picture| picture.miscolored, 0.05)),
        _ => None,
    }
}

fn main() {
    let without_gpu = testing::without_gpu();
    let trials = fault_scenes().map(|(name, text)| {
        Trial::test(name, move || the_naive_marcher_fails(name, text))
            .with_ignored_flag(without_gpu)
    });
    libtest_mimic::run(&Arguments::from_args(), trials.into()).exit();
}

fn the_naive_marcher_fails(name: &str, text: &str) -> Result<(), Failed> {
    let (count, least) = symptom(name).ok_or("the scene has no symptom")?;
    let scene = Compiler::new().compile(name, text)?;
    let row = count_faults(&scene, name, &Gpu::new()?, SIZE)?;
    let FaultRow { compared, variants, .. } = &row;
    let [naive, _, auto] = &variants[..] else { return Err("three pictures".into()) };
    let fraction = count(naive) as f64 / *compared as f64;
    if fraction < least {
        return Err(format!("the fraction of the naive marcher is {fraction}: {row:?}").into());
    }
    // Most of the picture is compared.
    if auto.wrong > RIGHT || *compared < 14_000 {
        return Err(format!("{row:?}").into());
    }
    Ok(())
}
