//! `auto` is right on formulas that nobody wrote for sdfc: textbook surfaces, blends and warps
//! without any promise.
//!
//! Each formula stands twice in `formulas.rs`: as a scene, and in Rust. The second one is sampled
//! densely in f64 along the rays of a small picture; that shares no code with the compiler or the
//! march. Off edges no pixel may differ that the picture does not call unproven, and 99 of 100
//! depths must agree to a twentieth of a pixel.

mod dense;
mod formulas;

use dense::{Dense, is_edge};
use formulas::{FORMULAS, Formula};
use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{Backend, Compiler, Method, PictureOptions, Scene, no_progress};
use sdfc_render::{HIT, Image, MISS, is_unproven, testing};

/// Width and height in pixels.
const SIZE: [u32; 2] = [32, 24];
/// Largest 99th percentile of the error in depth, in widths of a pixel.
const DEPTH: f64 = 0.05;
/// A picture that shows next to nothing tests nothing.
const LEAST_HITS: usize = 20;

/// Letters of two kinds before a wall, in the light of a sun.
const LETTERS: &str = r#"
let word = text("sdfc", size: 1, align: "center", spacing: 0.03)
word.offset(-0.02).extrude(0.2).round(0.02).translate(z: 0.1)
word.shell(0.03).extrude(0.26).translate(z: 0.1)
box([3, 3, 0.1]).translate(z: -0.2)
camera(eye: [1, 0.9, 4.6], target: [-0.3, 0.35, 0], fov: 14deg)
ambient(#dfe9ff, 0.35)
sun(direction: [-1, 1.6, 2], shadow: hard)
"#;
/// Largest number of pixels at edges that the two methods may draw differently.
const MAX_DIFFERENT: usize = 50;

fn main() {
    let without_gpu = testing::without_gpu();
    let trials = FORMULAS.iter().map(|formula| {
        let trial = Trial::test(formula.name, move || check(formula));
        trial.with_ignored_flag(without_gpu)
    });
    let mut trials: Vec<Trial> = trials.collect();
    let shadows = Trial::test("shadows of letters", shadows_agree);
    trials.push(shadows.with_ignored_flag(without_gpu));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// Rays to a light by `interval` end where those by `sphere` do, in a field with loops. A driver
/// once mixed up the rays of a workgroup there: 69 pixels differed; 42 at edges still do.
fn shadows_agree() -> Result<(), Failed> {
    let scene = Compiler::new().compile("letters", LETTERS)?;
    let [one, other] = [Method::Interval, Method::Sphere]
        .map(|method| Ok::<_, Failed>(drawn(&scene, method, [64, 36])?.to_srgb8()));
    let (one, other) = (one?, other?);
    let differ = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 8);
    let count = one.chunks(3).zip(other.chunks(3)).filter(differ).count();
    match count <= MAX_DIFFERENT {
        true => Ok(()),
        false => Err(format!("{count} pixels differ").into()),
    }
}

fn check(formula: &Formula) -> Result<(), Failed> {
    let scene = Compiler::new().compile(formula.name, &formula.scene())?;
    let frame = scene.defaults();
    let view = scene.view(&frame, SIZE)?;
    let dense = Dense::of(formula.field, &view);
    let hits = dense.hits();
    if hits < LEAST_HITS {
        return Err(format!("only {hits} pixels show the surface").into());
    }
    compare(&dense, &drawn(&scene, Method::Auto, SIZE)?)
}

fn drawn(scene: &Scene, method: Method, size: [u32; 2]) -> Result<Image, Failed> {
    let options = PictureOptions::new().size(size).method(method).backend(Backend::Gpu);
    Ok(scene.render(&options.samples(1), &mut no_progress)?.image)
}

fn compare(dense: &Dense, drawn: &Image) -> Result<(), Failed> {
    let (mut wrong, mut errors) = (Vec::new(), Vec::new());
    for (index, pixel) in drawn.pixels().iter().enumerate() {
        let (x, y) = (index as u32 % SIZE[0], index as u32 / SIZE[0]);
        if is_edge(dense, [x, y]) {
            continue;
        }
        match (dense.depth([x, y]), pixel.status) {
            (Some(depth), HIT) => {
                errors.push((f64::from(pixel.depth) - depth).abs() / dense.pixel_width(depth));
            }
            (None, MISS) => {}
            // The picture says so itself.
            (..) if is_unproven(pixel) => {}
            (expected, status) => wrong.push(format!("({x}, {y}): {status}, not {expected:?}")),
        }
    }
    if !wrong.is_empty() {
        return Err(format!("{} pixels are wrong: {}", wrong.len(), wrong.join("; ")).into());
    }
    errors.sort_by(f64::total_cmp);
    let rank = (errors.len() * 99).div_ceil(100).saturating_sub(1);
    match errors.get(rank) {
        Some(error) if *error > DEPTH => Err(format!("depths are off by {error:.4} px").into()),
        Some(_) | None => Ok(()),
    }
}
