//! Handles in the picture.

use eframe::egui::{Event, Modifiers};
use eframe::egui::{Key, PointerButton, Pos2, vec2};
use sdfc_viewer::scene::handle_values::HandleValue;

use crate::fixture::{CTRL, Fixture};

const SCENE: &str = "param r = 1 in 0.5..2\nsphere(r).translate([-0.2, 0, 0])\n\
                     camera(eye: [0, 0, 8], target: [0, 0, 0], fov: 40deg)\n";

/// Drags the grip at a point of the window, in the direction of `by`.
fn drag(fixture: &mut Fixture, at: Pos2, by: eframe::egui::Vec2) {
    let button = |fixture: &mut Fixture, pos: Pos2, pressed: bool| {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        fixture.harness.event(Event::PointerButton { pos, button, pressed, modifiers });
        fixture.harness.run_steps(2);
    };
    fixture.harness.hover_at(at);
    fixture.harness.run_steps(2);
    button(fixture, at, true);
    for part in [0.4, 0.7, 1.0] {
        fixture.harness.hover_at(at + by * part);
        fixture.harness.run_steps(2);
    }
    button(fixture, at + by, false);
}

/// Where a point of the scene is in the window.
fn on_screen(fixture: &Fixture, point: [f64; 3]) -> Pos2 {
    let session = fixture.harness.state().opened();
    let pose = session.picture.as_ref().unwrap().request.pose;
    let rect = fixture.harness.state().picture_rect();
    let [right, up, forward] = pose.basis();
    let from_eye = glam::DVec3::from(point) - pose.eye;
    let scale = f64::from(rect.height()) / 2.0 / (pose.half_height * from_eye.dot(forward));
    let aside = [right, up].map(|axis| (from_eye.dot(axis) * scale) as f32);
    rect.center() + vec2(aside[0], -aside[1])
}

fn number(fixture: &Fixture, value: &HandleValue) -> f64 {
    let session = fixture.harness.state().opened();
    value.get(session.model.as_ref().unwrap(), &session.param_values).unwrap()
}

#[test]
fn the_arrow_of_a_length_changes_it_like_its_slider() {
    let mut fixture = Fixture::of(SCENE);
    fixture.click("choose r");
    fixture.until(|harness| harness.state().opened().value_handles().len() == 1);
    fixture.harness.run_steps(2);
    let handles = fixture.harness.state().opened().value_handles();
    let (value, handle) = (&handles[0].value, handles[0].handle);
    assert_eq!(*value, HandleValue::Param("r".to_owned()));
    // On the surface, along its normal, by 1 per unit of the radius.
    let normal = handle.origin - glam::DVec3::new(-0.2, 0.0, 0.0);
    assert!((normal.length() - 1.0).abs() < 1e-3 && !handle.is_translation, "{handle:?}");
    assert!(handle.motion.abs_diff_eq(normal, 1e-3), "{handle:?}");
    let [from, to] = [handle.origin, handle.origin + handle.motion * 0.01]
        .map(|point| on_screen(&fixture, point.to_array()));
    let direction = (to - from).normalized();
    drag(&mut fixture, from + direction * 64.0, direction * 40.0);
    let value = HandleValue::Param("r".to_owned());
    let grown = number(&fixture, &value);
    // 40 points of about 100 points per unit.
    assert!((1.2..1.8).contains(&grown), "{grown}");
    let session = fixture.harness.state().opened();
    assert_eq!(session.param_values.params["r"][0], grown);
    // The range is kept.
    let moved = session.value_handles()[0].handle.origin;
    let at = on_screen(&fixture, moved.to_array()) + direction * 64.0;
    drag(&mut fixture, at, direction * 400.0);
    assert_eq!(number(&fixture, &value), 2.0);
}

#[test]
fn the_square_of_a_vector_moves_its_part_in_the_plane_of_the_picture() {
    let mut fixture = Fixture::of(SCENE);
    fixture.type_at_end("");
    fixture.key(CTRL, Key::Home);
    for _ in 0..SCENE.find("-0.2").unwrap() + 1 {
        fixture.harness.key_press(Key::ArrowRight);
    }
    fixture.harness.run_steps(3);
    fixture.until(|harness| harness.state().opened().value_handles().len() == 3);
    let handles = fixture.harness.state().opened().value_handles();
    for (handle, axis) in handles.iter().zip([glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z]) {
        assert!(handle.handle.is_translation, "{handle:?}");
        assert!(handle.handle.motion.abs_diff_eq(axis, 1e-3), "{handle:?}");
    }
    fixture.harness.run_steps(2);
    let at = on_screen(&fixture, handles[0].handle.origin.to_array());
    let there = on_screen(
        &fixture,
        (handles[0].handle.origin + glam::DVec3::new(0.5, 0.25, 0.0)).to_array(),
    );
    drag(&mut fixture, at, there - at);
    let moved = |index: usize| number(&fixture, &handles[index].value) - handles[index].number;
    assert!((moved(0) - 0.5).abs() < 0.05, "{}", moved(0));
    assert!((moved(1) - 0.25).abs() < 0.05 && moved(2).abs() < 0.05, "{} {}", moved(1), moved(2));
    assert_eq!(fixture.harness.state().opened().param_values.changed_numbers(), 2);
}
