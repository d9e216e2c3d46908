//! Surfaces that mirror others: matt ones trace no reflected ray, rough ones spread highlights.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use sdfc::{Backend, Compiler, PictureOptions, no_progress};

/// Returns the evaluations and the colour of each pixel.
fn pixels(text: &str) -> Vec<(u32, [f32; 4])> {
    let scene = Compiler::new().compile("a.sdf", text);
    let scene = scene.unwrap_or_else(|errors| panic!("{text}\n{errors}"));
    let options = PictureOptions::new().size([32, 24]).backend(Backend::Cpu).hdr(true);
    let picture = scene.render(&options, &mut no_progress).unwrap();
    picture.image.pixels().iter().map(|pixel| (pixel.evaluations, pixel.color)).collect()
}

#[test]
fn a_matt_surface_traces_no_reflected_ray() {
    let evaluations = |roughness: f32, setting: &str| -> u32 {
        let ball = format!("sphere(1).displace(fn(q) = 0.1 * sin(5 * q.x)).roughness({roughness})");
        let text = format!("{ball}\nsun()\n{setting}");
        pixels(&text).iter().map(|pixel| pixel.0).sum()
    };
    assert_eq!(evaluations(1.0, "reflections()"), evaluations(1.0, ""));
    assert!(evaluations(0.5, "reflections()") > evaluations(0.5, ""));
}

#[test]
fn a_rough_mirror_shows_highlights_as_wide_as_its_own() {
    // The ball hangs above the picture, which shows its image in the floor.
    let floor = |mirror: f32, ball: f32| -> Vec<[f32; 4]> {
        let text = format!(
            "sphere(1).translate([0, 3, -2]).roughness({ball})\n\
             plane().roughness({mirror}).metallic(1)\nsun(direction: [0, 1, 1])\nreflections()\n\
             camera(eye: [0, 2, 6], target: [0, -1, 0], fov: 30deg)"
        );
        pixels(&text).iter().map(|pixel| pixel.1).collect()
    };
    assert_eq!(floor(0.4, 0.1), floor(0.4, 0.4));
    assert_ne!(floor(0.2, 0.1), floor(0.2, 0.4));
}
