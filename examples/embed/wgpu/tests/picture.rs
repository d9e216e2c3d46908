//! Compares the program's picture with that of `sdfc render`, and the distances of `slice.rs` with
//! those of the CPU.
#![allow(missing_docs)]

use embed_wgpu::{Camera, Renderer, SCENES, open};
use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{Backend, Compiler, PictureOptions, no_progress};
use sdfc_render::testing;

#[path = "../examples/slice.rs"]
#[allow(dead_code, reason = "its main is not called")]
mod slice;

const SIZE: [u32; 2] = [160, 120];
/// Largest difference of a channel, in steps of 1/255.
const MOST: u8 = 1;
/// Pixels in a thousand that may differ more, at edges.
const EDGES: usize = 5;

fn main() {
    let tests = [
        Trial::test("two_scenes_in_one_shader_are_drawn_as_sdfc_draws_them", same_picture),
        Trial::test("a_slice_is_that_of_the_cpu", same_slice),
    ];
    let ignored = testing::without_gpu();
    let tests = tests.into_iter().map(|test| test.with_ignored_flag(ignored)).collect();
    libtest_mimic::run(&Arguments::from_args(), tests).exit();
}

fn same_picture() -> Result<(), Failed> {
    let (device, queue) = open()?;
    let mut renderer = Renderer::new(device, queue)?;
    let [bowl, ring] = &mut renderer.scenes[..] else { return Err("two scenes".into()) };
    bowl.set("wall", 0.15)?;
    bowl.set("opening", 0.4)?;
    ring.frame_mut().time = 2.0;
    let drawn = renderer.draw(SIZE, &Camera::default())?;

    // The camera and lights of `Camera::default`, in the language.
    let settings = "camera(eye: [2.2, 2.4, 3], target: [0, -0.2, 0], fov: 40deg)\n\
                    sun(direction: [1, 2, 1.5])\nambient(strength: 0.15)\n\
                    background(rgb(0.1, 0.2, 0.3))";
    let [(_, bowl), (_, ring)] = SCENES;
    // The bowl has a camera of its own, for pictures of it alone.
    let bowl: String = bowl.split_inclusive('\n').filter(|it| !it.starts_with("camera(")).collect();
    let scene = Compiler::new().compile("both.sdf", &[bowl.as_str(), ring, settings].join("\n"))?;
    let mut frame = scene.defaults();
    scene.set(&mut frame, "wall", 0.15)?;
    scene.set(&mut frame, "opening", 0.4)?;
    frame.time = 2.0;
    let backend = Backend::Gpu;
    let options = PictureOptions::new().size(SIZE).backend(backend).frame(frame);
    let expected = scene.render(&options, &mut no_progress)?.image.to_srgb8();

    let far = drawn
        .chunks_exact(4)
        .zip(expected.chunks_exact(3))
        .filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > MOST));
    let (count, all) = (far.count(), expected.len() / 3);
    if count * 1000 > EDGES * all {
        return Err(format!("{count} of {all} pixels differ by more than {MOST}/255").into());
    }
    Ok(())
}

fn same_slice() -> Result<(), Failed> {
    let sliced = slice::slice(0.5)?;
    let scene = Compiler::new().compile("scene.sdf", slice::SCENE)?;
    let mut frame = scene.defaults();
    scene.set(&mut frame, "r", 0.5)?;
    let mut field = scene.field(&frame)?;
    for (i, &distance) in sliced.iter().enumerate() {
        let [x, y] = [i % 64, i / 64].map(|i| i as f64);
        let expected = field.distance([(x - 32.0) / 16.0, (12.0 - y) / 8.0, 0.0]);
        if (f64::from(distance) - expected).abs() > 1e-5 {
            return Err(format!("at {i}: {distance}, not {expected}").into());
        }
    }
    if sliced.len() == 64 * 24 { Ok(()) } else { Err(format!("{} distances", sliced.len()).into()) }
}
