//! `auto` is right on formulas that nobody wrote for sdfc: textbook surfaces, blends and warps
//! without any promise.
//!
//! Each formula stands twice in `formulas.rs`: as a scene, and in Rust. The second one is sampled
//! densely in f64 along the rays of a small picture; that shares no code with the compiler or the
//! march. Outside edges no pixel may be wrong that the picture does not call unproven, few may be
//! wrong that it does, and 99 of 100 depths must agree to a twentieth of a pixel.

mod balls;
mod dense;
mod formulas;
mod page;

use std::fs;
use std::path::Path;

use balls::Balls;
use dense::dense;
use formulas::{FORMULAS, Formula};
use libtest_mimic::{Arguments, Failed, Trial};
use page::Page;
use sdfc::{Backend, Compiler, Method, PictureOptions, Scene, no_progress};
use sdfc_render::{Gpu, HIT, Image, edges, is_unproven, linear_to_srgb8, testing};

/// Width and height in pixels.
const SIZE: [u32; 2] = [32, 24];
/// The same for the page of letters, which has thin strokes.
const PAGE: [u32; 2] = [64, 48];
/// Largest 99th percentile of the error in depth, in widths of a pixel.
const DEPTH: f32 = 0.05;
/// Largest number of wrong pixels that the picture calls unproven, as a part of the hits.
const UNPROVEN: f64 = 0.05;
/// A picture that shows next to nothing tests nothing.
const LEAST_HITS: u64 = 20;

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
/// Largest difference of a colour channel that does not count, in steps of 1/255.
const COLOR: u8 = 8;

/// The scenes with these numbers of letters and of balls are written for measurements.
const LETTERS_OF_PAGES: [u32; 6] = [10, 20, 40, 80, 160, 320];
const BALLS: [u32; 3] = [10, 30, 60];

fn main() -> std::io::Result<()> {
    if let Some(folder) = std::env::var_os("STRANGERS_SCENES") {
        return write_scenes(Path::new(&folder));
    }
    let without_gpu = testing::without_gpu();
    let trials = FORMULAS.iter().map(|formula| {
        let trial = Trial::test(formula.name, move || check(formula));
        trial.with_ignored_flag(without_gpu)
    });
    let mut trials: Vec<Trial> = trials.collect();
    let shadows = Trial::test("shadows of letters", shadows_agree);
    trials.push(shadows.with_ignored_flag(without_gpu));
    let page = Trial::test("page of letters", page_is_right);
    trials.push(page.with_ignored_flag(without_gpu));
    trials.push(Trial::test("balls in a smooth union", balls_are_right));
    let long = Trial::test("long page of letters", long_page_is_drawn_on_the_cpu);
    trials.push(long.with_ignored_flag(without_gpu));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// Writes scenes whose times the documentation states.
fn write_scenes(folder: &Path) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    for letters in LETTERS_OF_PAGES {
        fs::write(folder.join(format!("page_{letters}.sdf")), Page::new(letters).scene())?;
    }
    for balls in BALLS {
        fs::write(folder.join(format!("balls_{balls}.sdf")), Balls::new(balls).scene())?;
    }
    Ok(())
}

/// Balls in a smooth union are right, and most of the picture is proven.
fn balls_are_right() -> Result<(), Failed> {
    let balls = Balls::new(30);
    let scene = Compiler::new().compile("balls", &balls.scene())?;
    let view = scene.view(&scene.defaults(), PAGE)?;
    let expected = dense(|p| balls.at(p), &view)?;
    let image = drawn_on_cpu(&scene, PAGE)?;
    is_right(&expected, &image)?;
    let (hits, unproven) = (image.counts().hit, image.counts().unproven);
    if hits < 300 || 10 * unproven > hits {
        return Err(format!("{unproven} unproven pixels, {hits} hits").into());
    }
    Ok(())
}

/// Rays to a light by `interval` end where those by `sphere` do, in a field with loops. A driver
/// once mixed up the rays of a workgroup there.
fn shadows_agree() -> Result<(), Failed> {
    let scene = Compiler::new().compile("letters", LETTERS)?;
    let one = drawn(&scene, Method::Interval, [64, 36])?;
    let other = drawn(&scene, Method::Sphere, [64, 36])?;
    let pixels = (0..36).flat_map(|y| (0..64).map(move |x| [x, y]));
    let (mut compared, mut wrong) = (0, Vec::new());
    for [x, y] in pixels.filter(|&at| is_even(&one, at) && is_even(&other, at)) {
        compared += 1;
        let [a, b] = [&one, &other].map(|image| color(image, [x, y]));
        if differ(a, b) {
            wrong.push([x, y]);
        }
    }
    if compared < 500 || !wrong.is_empty() {
        return Err(format!("{} of {compared} pixels differ: {wrong:?}", wrong.len()).into());
    }
    Ok(())
}

/// A flat formula of over a thousand operations is right. Software drivers once compiled the shader
/// of such a formula again for each tile.
fn page_is_right() -> Result<(), Failed> {
    let page = Page::new(35);
    let scene = Compiler::new().compile("page", &page.scene())?;
    let view = scene.view(&scene.defaults(), PAGE)?;
    let expected = dense(|p| page.at(p), &view)?;
    is_right(&expected, &drawn_on_cpu(&scene, PAGE)?)?;
    is_right(&expected, &drawn(&scene, Method::Auto, PAGE)?)
}

/// By default, the CPU draws a flat formula that is too long for a software driver, and the picture
/// is that of the shader.
fn long_page_is_drawn_on_the_cpu() -> Result<(), Failed> {
    let scene = Compiler::new().compile("page", &Page::new(140).scene())?;
    let options = PictureOptions::new().size(SIZE).samples(1);
    let picture = scene.render(&options, &mut no_progress)?;
    let is_software = Gpu::new()?.info().software;
    if is_software != picture.stats.adapter.is_none() {
        return Err(format!("drawn on {:?}", picture.stats.adapter).into());
    }
    is_right(&drawn(&scene, Method::Auto, SIZE)?, &picture.image)
}

/// True if the pixels around a pixel have its colour: no edge and no shadow ends there.
fn is_even(image: &Image, [x, y]: [u32; 2]) -> bool {
    let around =
        (0..9).map(|index| [(x + index % 3).saturating_sub(1), (y + index / 3).saturating_sub(1)]);
    let own = color(image, [x, y]);
    around.into_iter().all(|at| color(image, at).is_none() || !differ(own, color(image, at)))
}

/// The colour of a pixel in sRGB; `None` outside the picture.
fn color(image: &Image, [x, y]: [u32; 2]) -> Option<[u8; 3]> {
    let [red, green, blue, _] = image.pixel(x, y)?.color;
    Some([red, green, blue].map(linear_to_srgb8))
}

fn differ(a: Option<[u8; 3]>, b: Option<[u8; 3]>) -> bool {
    let pairs = a.into_iter().flatten().zip(b.into_iter().flatten());
    pairs.into_iter().any(|(a, b)| a.abs_diff(b) > COLOR)
}

fn check(formula: &Formula) -> Result<(), Failed> {
    let scene = Compiler::new().compile(formula.name, &formula.scene())?;
    let view = scene.view(&scene.defaults(), SIZE)?;
    let expected = dense(formula.field, &view)?;
    let hits = expected.counts().hit;
    if hits < LEAST_HITS {
        return Err(format!("only {hits} pixels show the surface").into());
    }
    is_right(&expected, &drawn_on_cpu(&scene, SIZE)?)?;
    is_right(&expected, &drawn(&scene, Method::Auto, SIZE)?)
}

fn drawn(scene: &Scene, method: Method, size: [u32; 2]) -> Result<Image, Failed> {
    let options = PictureOptions::new().size(size).method(method).backend(Backend::Gpu);
    Ok(scene.render(&options.samples(1), &mut no_progress)?.image)
}

fn drawn_on_cpu(scene: &Scene, size: [u32; 2]) -> Result<Image, Failed> {
    let options = PictureOptions::new().size(size).backend(Backend::Cpu);
    Ok(scene.render(&options.samples(1), &mut no_progress)?.image)
}

fn is_right(expected: &Image, drawn: &Image) -> Result<(), Failed> {
    let (mut wrong, mut unproven, mut errors) = (Vec::new(), 0, Vec::new());
    let pixels = expected.pixels().iter().zip(drawn.pixels()).zip(edges(expected));
    for (index, ((expected_pixel, pixel), is_edge)) in (0..).zip(pixels) {
        if is_edge {
            continue;
        }
        let depth = expected_pixel.depth;
        match [expected_pixel.status, pixel.status] {
            [HIT, HIT] => errors.push((pixel.depth - depth).abs() / expected.pixel_width(depth)),
            [a, b] if a == b => {}
            // The picture says so itself.
            _ if is_unproven(pixel) => unproven += 1,
            [a, b] => {
                let width = expected.size()[0];
                wrong.push(format!("({}, {}): {b}, not {a}", index % width, index / width));
            }
        }
    }
    if !wrong.is_empty() {
        return Err(format!("{} pixels are wrong: {}", wrong.len(), wrong.join("; ")).into());
    }
    if f64::from(unproven) > UNPROVEN * expected.counts().hit as f64 {
        return Err(
            format!("{unproven} unproven pixels of {} are wrong", expected.counts().hit).into()
        );
    }
    errors.sort_by(f32::total_cmp);
    let rank = (errors.len() * 99).div_ceil(100).saturating_sub(1);
    match errors.get(rank) {
        Some(error) if *error > DEPTH => Err(format!("depths are off by {error:.4} px").into()),
        Some(_) | None => Ok(()),
    }
}
