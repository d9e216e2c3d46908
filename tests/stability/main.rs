//! `auto` stays within its error bounds on scenes on which other ray methods fail.
//!
//! There is one test for each scene in this folder and under `examples/faults`. It draws the scene
//! with every ray method at 160x120 and compares the pictures with the oracle. `auto` must stay
//! within the bounds in the scene's comment, and `docs/stability.md` must list the errors of all
//! methods.
//!
//! The values on the page come from one driver, which it names. With other drivers only the bounds
//! of `auto` are checked, because they round differently. `STABILITY_UPDATE=1` rewrites the page
//! (with a filter, the rows of the selected scenes). `STABILITY_SIZE=1280x960` tests larger
//! pictures and ignores the page.

mod case;
mod page;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use case::{Bounds, Case, cases};
use libtest_mimic::{Arguments, Failed, Trial};
use page::{Errors, Page};
use sdfc::{FrameValues, Scene};
use sdfc_measure::{OracleOptions, Sampler, Truth, compare, oracle, truth};
use sdfc_render::{Gpu, View, testing};

/// The width and height in pixels of the pictures for the page.
const SIZE: [u32; 2] = [160, 120];

/// The largest 99th percentile of the error of normals on smooth surfaces, in degrees.
const NORMAL: f64 = 0.001;

/// The results by case.
type Measured = Arc<Mutex<BTreeMap<String, Vec<Errors>>>>;

fn main() {
    let without_gpu = testing::without_gpu();
    let arguments = Arguments::from_args();
    let (cases, size) = match cases().and_then(|cases| Ok((cases, size()?))) {
        Ok(read) => read,
        Err(why) => {
            let wrong = Trial::test("cases", move || Err(why));
            libtest_mimic::run(&arguments, vec![wrong]).exit();
        }
    };
    let measured = Measured::default();
    let update = std::env::var_os("STABILITY_UPDATE").is_some() && size == SIZE;
    let mut trials: Vec<Trial> = Vec::new();
    for case in &cases {
        let (case, measured) = (case.clone(), Arc::clone(&measured));
        let trial =
            Trial::test(case.name.clone(), move || check_case(&case, size, update, &measured));
        trials.push(trial.with_ignored_flag(without_gpu));
    }
    let conclusion = libtest_mimic::run(&arguments, trials);
    if update && !without_gpu {
        let measured = measured.lock().unwrap_or_else(PoisonError::into_inner);
        if let Err(why) = Page::write(&cases, &measured) {
            let failed = Trial::test("page", move || Err(why));
            libtest_mimic::run(&Arguments::default(), vec![failed]).exit();
        }
    }
    conclusion.exit();
}

fn size() -> Result<[u32; 2], Failed> {
    let Ok(text) = std::env::var("STABILITY_SIZE") else { return Ok(SIZE) };
    let sides = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides.ok_or_else(|| format!("STABILITY_SIZE: `{text}` is no size like 1280x960").into())
}

fn check_case(
    case: &Case,
    size: [u32; 2],
    update: bool,
    measured: &Measured,
) -> Result<(), Failed> {
    let scene = sdfc::Compiler::new().compile(&case.path, &case.text)?;
    if case.exempt.is_none() && !scene.is_certified() {
        return Err("the scene is uncertified, and its comment has no line `Exempt:`".into());
    }
    let views = views(case, &scene, size)?;
    let (gpu, oracle) = (Gpu::new()?, oracle(&scene)?);
    let mut row = Vec::new();
    for method in sdfc::Method::all() {
        let sampler = Sampler::new(&scene, &gpu, method)?;
        let measure = |(view, frame, truth): &(View, FrameValues, Truth)| {
            Ok(compare(&oracle, frame, truth, &sampler.samples(view, frame)?))
        };
        let metrics = views.iter().map(measure).collect::<Result<Vec<_>, Failed>>()?;
        row.push(Errors::of(&views, &metrics));
    }
    let result = row.first().map_or_else(
        || Err("no method".into()),
        |auto| within_bounds(auto, &case.auto).and_then(|()| not_outdone(case, auto, &row)),
    );
    if update {
        measured.lock().unwrap_or_else(PoisonError::into_inner).insert(case.name.clone(), row);
        return result;
    }
    result?;
    if size == SIZE { Page::read()?.check(case, &row, gpu.info()) } else { Ok(()) }
}

/// Returns the view of each frame, and the result of the oracle for it.
fn views(
    case: &Case,
    scene: &Scene,
    size: [u32; 2],
) -> Result<Vec<(View, FrameValues, Truth)>, Failed> {
    let measure = |frame: FrameValues| {
        let view = scene.view(&frame, size)?;
        let truth = truth(scene, &view, &frame, OracleOptions::default())?;
        Ok((view, frame, truth))
    };
    case.frames(scene)?.into_iter().map(measure).collect()
}

/// Fails unless the methods that outperform `auto` are those that the case names.
fn not_outdone(case: &Case, auto: &Errors, row: &[Errors]) -> Result<(), Failed> {
    let methods = sdfc_march::METHODS.iter().zip(row);
    let better: Vec<&str> = methods
        .filter(|(_, errors)| errors.outperforms(auto))
        .map(|(method, _)| method.name)
        .collect();
    if better == case.outdone {
        return Ok(());
    }
    Err(format!("{better:?} outperform `auto`, but the case names {:?}", case.outdone).into())
}

fn within_bounds(auto: &Errors, bounds: &Bounds) -> Result<(), Failed> {
    let pairs = [
        ("missed", auto.missed, bounds.missed),
        ("false", auto.false_hits, bounds.false_hits),
        ("capped", auto.capped, bounds.capped),
        ("NaN", auto.nan, bounds.nan),
        ("undecided", auto.undecided, bounds.undecided),
    ];
    let exceeded = pairs.iter().filter(|(_, found, most)| found > most);
    let mut wrong: Vec<String> = exceeded
        .map(|(what, found, most)| format!("{found:.4} % {what}, {most} % allowed"))
        .collect();
    if auto.depth > bounds.depth {
        wrong.push(format!("depths off by {:.4} px, {} px allowed", auto.depth, bounds.depth));
    }
    if auto.normal > NORMAL {
        wrong.push(format!("normals off by {:.5} degrees, {NORMAL} allowed", auto.normal));
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("; ").into()) }
}
