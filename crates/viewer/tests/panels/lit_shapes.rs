//! The code at the cursor lights its shapes in the picture.

use eframe::egui::Key;
use sdfc_viewer::render::shape_mask::Lit;

use crate::fixture::{CTRL, Fixture};

const SCENE: &str = "sphere(1).translate(x: 1.5) | box(1).translate(x: -1.5)\n\
                     camera(eye: [0, 0, 8], target: [0, 0, 0], fov: 40deg)\n";

/// The part of the lit pixels in the left half of the picture, once there is a mask.
fn left_part(fixture: &mut Fixture, offset: usize) -> f64 {
    fixture.type_at_end("");
    fixture.key(CTRL, Key::Home);
    for _ in 0..offset {
        fixture.harness.key_press(Key::ArrowRight);
    }
    fixture.harness.run_steps(3);
    fixture.until(|harness| harness.state().opened().lit_mask().is_some());
    let mask = fixture.harness.state().opened().lit_mask().unwrap();
    let columns = mask.size[0] as usize;
    let lit = |left: bool| {
        let pixels = mask.pixels.iter().enumerate().filter(|(_, lit)| **lit != Lit::No);
        pixels.filter(|(at, _)| (at % columns < columns / 2) == left).count() as f64
    };
    assert!(lit(true) + lit(false) > 500.0);
    lit(true) / (lit(true) + lit(false))
}

#[test]
fn the_cursor_in_a_call_lights_the_pixels_of_its_shapes() {
    let mut fixture = Fixture::of(SCENE);
    let at = |found: &str| SCENE.find(found).unwrap();
    assert_eq!(left_part(&mut fixture, at("sphere")), 0.0);
    assert_eq!(left_part(&mut fixture, at("1.5) |")), 0.0);
    assert_eq!(left_part(&mut fixture, at("box") + 2), 1.0);
    // Without a cursor nothing is lit.
    fixture.click("Drag numbers");
    assert!(fixture.harness.state().opened().lit_mask().is_none());
    fixture.click("Edit");
    assert_eq!(left_part(&mut fixture, at("box") + 2), 1.0);
    // Without the keyboard in the editor nothing is lit.
    fixture.key(eframe::egui::Modifiers::NONE, Key::Escape);
    assert!(fixture.harness.state().opened().lit_mask().is_none());
}
