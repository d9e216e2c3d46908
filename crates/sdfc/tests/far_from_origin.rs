//! A scene that is moved far away together with its camera and lights gives the same picture, on
//! the CPU in f32 and on the GPU.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{Backend, Compiler, PictureOptions, no_progress};
use sdfc_render::testing;

const SIZE: [u32; 2] = [96, 54];
/// The positions that the scenes are moved to.
const PLACES: [&str; 2] = ["[1000000, -20000, 700000.25]", "[-1000000, 1000000, 1000000]"];

/// The scenes, at the position `at`: analytic shapes, a marched blend, a rotated part, a pattern, a
/// param, lights and a mirror.
const SCENES: [(&str, &str); 3] = [
    (
        "solids",
        "param r = 0.6 in 0.1..1
         sphere(r).translate([-1, 0.6, 0]).translate(at).color(#d94f30)
         (box([1, 1, 1]) - cylinder(r: 0.3, h: 2)).rotate(x: 40deg, y: 20deg).translate(y: 0.7).translate(at)
         plane(y: -0.5).translate(at).color(#7a8b99)
         camera(eye: at + [4, 3, 5], target: at + [0, 0.2, 0], fov: 35deg)
         sun(direction: [1, 2, 1], shadow: hard)
         ambient(strength: 0.2)",
    ),
    (
        "blend",
        "union(sphere(0.9).translate(y: 0.6), box([1.6, 1, 1.6]), blend: smooth(0.4)).color(checker(#eee, #333, size: 0.5))
           .translate(at)
         plane(y: -0.5).color(#7a8b99).translate(at)
         camera(eye: at + [4, 3, 5], target: at + [0, 0.2, 0], fov: 35deg)
         point_light(position: at + [2, 5, 3], strength: 30, shadow: soft(8))
         ambient(strength: 0.2)
         ambient_occlusion()",
    ),
    (
        "fitted",
        "(torus(major: 0.8, minor: 0.25) | capsule([0, -0.5, 0], [0.3, 0.5, 0], r: 0.2)).translate(at)",
    ),
];

fn main() {
    let mut trials = Vec::new();
    for (name, text) in SCENES {
        for place in PLACES {
            for backend in [Backend::Cpu, Backend::Gpu] {
                let is_gpu = backend == Backend::Gpu;
                let trial = Trial::test(format!("{name} at {place} {backend:?}"), move || {
                    is_the_same(text, place, backend)
                });
                trials.push(trial.with_ignored_flag(is_gpu && testing::without_gpu()));
            }
        }
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn is_the_same(text: &str, place: &str, backend: Backend) -> Result<(), Failed> {
    let near = drawn(text, "[0, 0, 0]", backend)?;
    let far = drawn(text, place, backend)?;
    let differs = |at: usize| near.1[at].abs_diff(far.1[at]) > 1;
    let wrong = (0..near.0.len())
        .filter(|&pixel| (3 * pixel..3 * pixel + 3).any(differs) && !is_edge(&near.0, pixel));
    match wrong.count() {
        0 => Ok(()),
        count => Err(format!("{count} pixels differ").into()),
    }
}

/// Depths and colours.
type Drawn = (Vec<f32>, Vec<u8>);

fn drawn(text: &str, at: &str, backend: Backend) -> Result<Drawn, Failed> {
    let scene = Compiler::new().compile("far.sdf", &format!("let at = {at}\n{text}\n"))?;
    let options = PictureOptions::new().size(SIZE).backend(backend);
    let image = scene.render(&options, &mut no_progress)?.image;
    Ok((image.pixels().iter().map(|pixel| pixel.depth).collect(), image.to_srgb8()))
}

/// Returns true if the depths around a pixel do not lie on a plane, or differ too much.
fn is_edge(depths: &[f32], pixel: usize) -> bool {
    let [width, height] = SIZE.map(|side| side as usize);
    let (x, y) = (pixel % width, pixel / width);
    let around = |dx: usize, dy: usize| {
        let (x, y) =
            ((x + dx).saturating_sub(1).min(width - 1), (y + dy).saturating_sub(1).min(height - 1));
        depths[y * width + x]
    };
    let here = depths[pixel];
    let bend = |a: f32, b: f32| (a + b - 2.0 * here).abs() > 0.02 * here.min(a).min(b);
    bend(around(0, 1), around(2, 1)) || bend(around(1, 0), around(1, 2))
}
