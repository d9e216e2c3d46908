//! The default look: which scenes get it, what it leaves alone, and that it fits scenes of any
//! size.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sdfc::{Backend, Code, Compiler, Emit, PictureOptions, Scene, ShaderOptions, no_progress};
use sdfc_graph::Settings;

fn compiled(text: &str) -> Scene {
    Compiler::new().compile("look.sdf", text).unwrap()
}

fn settings(text: &str) -> Settings {
    compiled(text).program().settings.clone()
}

#[test]
fn a_scene_without_a_light_gets_the_look() {
    let found = settings("sphere(1)");
    assert_eq!(found.lights.len(), 2);
    assert!(found.ambient.is_some() && found.occlusion.is_some() && found.sky.is_some());
    assert!(found.exposure.is_some() && found.samples == Some(4));
    assert!(compiled("union(sphere(1), box(1), blend: smooth(0.1))").diagnostics().is_empty());
}

#[test]
fn a_scene_with_a_light_gets_nothing_of_the_look() {
    for light in ["sun()", "ambient()", "point_light([0, 3, 0])", "spot_light([0, 3, 0])"] {
        let found = settings(&format!("sphere(1)\n{light}"));
        assert!(
            found.lights.len() < 2 && found.sky.is_none() && found.exposure.is_none(),
            "{light}"
        );
        assert!(found.occlusion.is_none() && found.samples.is_none(), "{light}");
    }
}

#[test]
fn a_stated_setting_replaces_that_of_the_look() {
    let found = settings("sphere(1)\nbackground(#123)\nantialias(9)\ncamera(eye: [0, 0, 5])");
    assert!(found.sky.is_none() && found.background.is_some());
    assert_eq!((found.lights.len(), found.samples), (2, Some(9)));
}

#[test]
fn the_field_has_no_code_of_the_look() {
    let field = |text: &str| {
        let written = compiled(text).write_shader(&ShaderOptions::new().emit(Emit::Field)).unwrap();
        let Code::Text(text) = written.code else { unreachable!("WGSL is text") };
        let is_code = |line: &&str| !line.starts_with("//");
        text.lines().filter(is_code).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(field("sphere(1).color(#f00)"), field("sphere(1).color(#f00)\nsun()"));
}

#[test]
fn a_fitted_camera_looks_at_what_is_bounded() {
    let focus = |text: &str| {
        let scene = compiled(text);
        scene.focus_at(&scene.defaults()).unwrap()
    };
    let ball = [[-1.0; 3], [1.0; 3]];
    assert_eq!(focus("sphere(1)"), ball);
    assert_eq!(focus("sphere(1)\nplane(y: -1)"), ball);
    assert_eq!(focus("union(sphere(1), plane(y: -1), blend: smooth(0.2))"), ball);
    assert_eq!(focus("plane(y: -1) - sphere(1)"), ball);
    assert!(focus("plane()")[0][0].is_infinite());
    // The rays still go to the floor.
    let scene = compiled("sphere(1)\nplane(y: -1)");
    let frame = scene.defaults();
    assert!(scene.bounds_at(&frame).unwrap()[0][0].is_infinite());
    assert!(scene.view(&frame, [64, 36]).unwrap().t_max > 100.0);
}

/// Mean brightness of the shape and of everything, from 0 to 1; and the fraction of pixels that
/// show the shape.
fn brightness(text: &str, size: [u32; 2]) -> [f64; 3] {
    let options = PictureOptions::new().size(size).backend(Backend::Cpu).samples(1);
    let image = compiled(text).render(&options, &mut no_progress).unwrap().image;
    let of = |color: [f32; 4]| f64::from(color[0] + color[1] + color[2]) / 3.0;
    let pixels = image.pixels();
    let hit: Vec<f64> = pixels.iter().filter(|it| it.status == 1).map(|it| of(it.color)).collect();
    let all: f64 = pixels.iter().map(|it| of(it.color)).sum();
    let count = pixels.len() as f64;
    [hit.iter().sum::<f64>() / hit.len() as f64, all / count, hit.len() as f64 / count]
}

/// A field that is divided by a Lipschitz constant is flatter than the distance. Soft shadows and
/// ambient occlusion of it are those of the distance.
#[test]
fn a_flat_field_is_shaded_as_a_distance() {
    let image = |ball: &str| {
        let text = format!("{ball}\nplane(y: -1.2)\ncamera(eye: [3, 2, 4])");
        let options = PictureOptions::new().size([60, 40]).backend(Backend::Cpu).samples(1);
        compiled(&text).render(&options, &mut no_progress).unwrap().image
    };
    let distance = image("sphere(1)");
    // Outside, this is the distance.
    let flat = image(
        "solid flat() lipschitz 8 = { let d = length(p) - 1\n if d < 0 { 8 * d } else { d } }\nflat()",
    );
    let colors = |image: &sdfc_render::Image| -> Vec<[f32; 4]> {
        image.pixels().iter().map(|pixel| pixel.color).collect()
    };
    let apart = |(a, b): (&[f32; 4], &[f32; 4])| {
        (0..3).map(|lane| f64::from(a[lane] - b[lane]).abs()).fold(0.0, f64::max)
    };
    let apart: Vec<f64> = colors(&distance).iter().zip(&colors(&flat)).map(apart).collect();
    let mean = apart.iter().sum::<f64>() / apart.len() as f64;
    assert!(mean < 0.004, "the mean colours differ by {mean}");
}

#[test]
fn scenes_of_any_size_and_place_look_alike_at_any_aspect() {
    for size in [[48, 27], [36, 36], [27, 48]] {
        let blend = "union(sphere(0.9), box(1.4), blend: smooth(0.3))";
        let [shape, all, part] = brightness(blend, size);
        assert!(shape > 0.25 && shape < 0.85 && all > 0.3 && all < 0.85, "{shape} {all}");
        assert!(part > 0.08 && part < 0.6, "{part} of the picture shows the shape");
        let moved = [".scale(500)", ".scale(0.002)", ".translate([90000, 0, -40000])"];
        for moved in moved {
            let found = brightness(&format!("{blend}{moved}"), size);
            let near = found.iter().zip([shape, all, part]).all(|(a, b)| (a - b).abs() < 0.02);
            assert!(near, "{moved} at {size:?}: {found:?}, not {:?}", [shape, all, part]);
        }
    }
}

#[test]
fn a_linear_picture_has_no_tone_curve() {
    let draw = |hdr| {
        let options = PictureOptions::new().size([8, 8]).backend(Backend::Cpu).hdr(hdr);
        let scene = compiled("sphere(1).emission(#fff)\nexposure(stops: 2)\nbackground(#000)");
        let image = scene.render(&options, &mut no_progress).unwrap().image;
        image.pixel(4, 4).unwrap().color[0]
    };
    let [shown, linear] = [draw(false), draw(true)];
    assert!(shown > 0.9 && shown < 1.0, "{shown}");
    assert!(linear > 1.0 && linear < 2.5, "{linear}: without the factor 4");
}
