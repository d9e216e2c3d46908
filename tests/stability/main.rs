//! Scenes on which ray methods fail, each with the bounds that `auto` holds on it.
//!
//! One test for each scene in this folder and under `examples/faults`. It draws the scene with every ray method of the
//! table, at 160x120, and compares the pictures with the oracle: `auto` has to hold the bounds that the scene's comment
//! states, and `docs/stability.md` has to tell what the other methods do.
//!
//! The page's figures are those of one driver, which it names. Elsewhere only `auto` is held to its bounds: other
//! devices round otherwise. `STABILITY_UPDATE=1` writes the page anew (with a filter, the rows of those scenes);
//! `STABILITY_SIZE=1280x960` looks at larger pictures, and leaves the page alone.

mod case;
mod page;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use case::{Bounds, Case, cases};
use libtest_mimic::{Arguments, Failed, Trial};
use page::{Figures, Page};
use sdfc::accuracy_data::{Truth, compare};
use sdfc::render::{Gpu, View, testing};
use sdfc::{FrameValues, Scene};

/// Width and height in pixels of the pictures that the page is about.
const SIZE: [u32; 2] = [160, 120];

/// Error of a normal in degrees that 99 of 100 pixels on smooth surfaces keep, in every case.
const NORMAL: f64 = 0.001;

/// Figures by case.
type Measured = Arc<Mutex<BTreeMap<String, Vec<Figures>>>>;

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
        let trial = Trial::test(case.name.clone(), move || holds(&case, size, update, &measured));
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

fn holds(case: &Case, size: [u32; 2], update: bool, measured: &Measured) -> Result<(), Failed> {
    let compiled = sdfc::compile(&case.path, &case.text);
    let findings = compiled.diagnostics_text(false);
    let scene = compiled.scene.ok_or_else(|| Failed::from(findings))?;
    if case.exempt.is_none() && !scene.is_certified() {
        return Err("the scene is uncertified, and its comment has no line `Exempt:`".into());
    }
    let views = views(case, &scene, size)?;
    let (gpu, oracle) = (Gpu::new()?, scene.oracle()?);
    let mut row = Vec::new();
    for method in sdfc::march::METHODS {
        let sampler = scene.sampler(&gpu, &method)?;
        let judge = |(view, frame, truth): &(View, FrameValues, Truth)| {
            Ok(compare(&oracle, frame, truth, &sampler.samples(view, frame)?))
        };
        let metrics = views.iter().map(judge).collect::<Result<Vec<_>, Failed>>()?;
        row.push(Figures::of(&views, &metrics));
    }
    let verdict = row.first().map_or_else(
        || Err("no method".into()),
        |auto| held(auto, &case.auto).and_then(|()| not_outdone(case, auto, &row)),
    );
    if update {
        measured.lock().unwrap_or_else(PoisonError::into_inner).insert(case.name.clone(), row);
        return verdict;
    }
    verdict?;
    if size == SIZE { Page::read()?.tells(case, &row, gpu.info()) } else { Ok(()) }
}

/// Each frame's view, and what the oracle says of it.
fn views(
    case: &Case,
    scene: &Scene,
    size: [u32; 2],
) -> Result<Vec<(View, FrameValues, Truth)>, Failed> {
    let look = |frame: FrameValues| {
        let view = scene.view(&frame, size)?;
        let truth = scene.truth(&view, &frame, &|_| ())?;
        Ok((view, frame, truth))
    };
    case.frames(scene)?.into_iter().map(look).collect()
}

/// No method takes fewer evaluations than `auto` and errs less.
fn not_outdone(case: &Case, auto: &Figures, row: &[Figures]) -> Result<(), Failed> {
    let methods = sdfc::march::METHODS.iter().zip(row);
    let better: Vec<&str> = methods
        .filter(|(_, figures)| figures.outdoes(auto))
        .map(|(method, _)| method.name)
        .collect();
    if better == case.outdone {
        return Ok(());
    }
    Err(format!("{better:?} are cheaper and nearer, not {:?}", case.outdone).into())
}

fn held(auto: &Figures, bounds: &Bounds) -> Result<(), Failed> {
    let pairs = [
        ("missed", auto.missed, bounds.missed),
        ("false", auto.false_hits, bounds.false_hits),
        ("capped", auto.capped, bounds.capped),
        ("NaN", auto.nan, bounds.nan),
        ("undecided", auto.undecided, bounds.undecided),
    ];
    let shares = pairs.iter().filter(|(_, found, most)| found > most);
    let mut wrong: Vec<String> = shares
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
