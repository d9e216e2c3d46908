//! An unlit surface shows its colour whatever the light.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use sdfc::{Backend, Code, Compiler, Emit, PictureOptions, Scene, ShaderOptions, no_progress};

const LIGHTS: &str = "sun(direction: [1, 1, 1], shadow: soft(8))\nsky()\nambient_occlusion()\n\
                      reflections()\nambient(#fff, 0.7)\ncamera(eye: [0, 1, 6])\n";

fn scene(text: &str) -> Scene {
    let text = format!("{text}\n{LIGHTS}");
    Compiler::new().compile("a.sdf", &text).unwrap_or_else(|errors| panic!("{text}\n{errors}"))
}

/// The colours of the pixels that show a surface.
fn colors(text: &str) -> Vec<[f32; 3]> {
    let options = PictureOptions::new().size([32, 24]).backend(Backend::Cpu).hdr(true);
    let picture = scene(text).render(&options, &mut no_progress).unwrap();
    let hits = picture.image.pixels().iter().filter(|pixel| pixel.status == sdfc_render::HIT);
    hits.map(|pixel| [0, 1, 2].map(|lane| pixel.color[lane])).collect()
}

#[test]
fn an_unlit_surface_shows_its_colour_in_any_light() {
    let shown = colors("sphere(1).metallic(1).unlit(#ff8000)");
    assert!(shown.len() > 50, "{} pixels show the ball", shown.len());
    // 0x80 is 0.2158605 in linear light.
    let is_right = |color: &[f32; 3]| {
        color.iter().zip([1.0, 0.215_860_5, 0.0]).all(|(lane, right)| (lane - right).abs() < 1e-5)
    };
    assert!(shown.iter().all(is_right), "{shown:?}");
    assert!(!colors("sphere(1).emission(#ff8000)").iter().all(is_right));
}

#[test]
fn only_shaders_of_unlit_scenes_have_code_for_them() {
    let shader = |text: &str| {
        let options = ShaderOptions::new().emit(Emit::Render);
        let Code::Text(text) = scene(text).write_shader(&options).unwrap().code else { panic!() };
        text.contains("ambient_fraction")
    };
    assert!(shader("sphere(1).unlit(#f00)"));
    assert!(!shader("sphere(1).color(#f00).paint(material(occlusion: 0.5))"));
}
