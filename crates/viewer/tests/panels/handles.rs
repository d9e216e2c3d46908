//! Handles in the picture.

use eframe::egui::{Event, Modifiers};
use eframe::egui::{Key, PointerButton, Pos2, vec2};
use sdfc_viewer::scene::handle_values::HandleValue;
use sdfc_viewer::session::Session;
use sdfc_viewer::session::handle_state::ValueHandle;

use crate::fixture::{CTRL, Fixture};

const SCENE: &str = "param r = 1 in 0.5..2\nsphere(r).translate([-0.2, 0, 0])\n\
                     camera(eye: [0, 0, 8], target: [0, 0, 0], fov: 40deg)\n";

/// Moves the pointer to a point of the window, and presses or releases its button.
fn press(fixture: &mut Fixture, pos: Pos2, pressed: bool) {
    let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
    fixture.harness.hover_at(pos);
    fixture.harness.run_steps(2);
    fixture.harness.event(Event::PointerButton { pos, button, pressed, modifiers });
    fixture.harness.run_steps(2);
}

/// Drags the grip at a point of the window, in the direction of `by`.
fn drag(fixture: &mut Fixture, at: Pos2, by: eframe::egui::Vec2) {
    press(fixture, at, true);
    for part in [0.4, 0.7, 1.0] {
        fixture.harness.hover_at(at + by * part);
        fixture.harness.run_steps(2);
    }
    press(fixture, at + by, false);
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

/// The scene with the arrow of its radius, and the arrow's handle.
fn with_radius() -> (Fixture, ValueHandle) {
    let mut fixture = Fixture::of(SCENE);
    fixture.click("choose r");
    fixture.until(|harness| harness.state().opened().value_handles().len() == 1);
    fixture.harness.run_steps(2);
    let handle = fixture.harness.state().opened().value_handles()[0].clone();
    (fixture, handle)
}

/// Drags the arrow of the radius outwards, in points.
fn drag_radius(fixture: &mut Fixture, ValueHandle { handle, .. }: &ValueHandle, by: f32) {
    let [from, to] = [handle.origin, handle.origin + handle.motion * 0.01]
        .map(|point| on_screen(fixture, point.to_array()));
    let direction = (to - from).normalized();
    drag(fixture, from + direction * 64.0, direction * by);
}

#[test]
fn the_arrow_of_a_length_changes_it_like_its_slider() {
    let (mut fixture, radius) = with_radius();
    let ValueHandle { value, handle, .. } = &radius;
    assert_eq!(*value, HandleValue::Param("r".to_owned()));
    // On the surface, along its normal, by 1 per unit of the radius.
    let normal = handle.origin - glam::DVec3::new(-0.2, 0.0, 0.0);
    assert!((normal.length() - 1.0).abs() < 1e-3 && !handle.is_translation, "{handle:?}");
    assert!(handle.motion.abs_diff_eq(normal, 1e-3), "{handle:?}");
    drag_radius(&mut fixture, &radius, 40.0);
    let grown = number(&fixture, value);
    // 40 points of about 100 points per unit.
    assert!((1.2..1.8).contains(&grown), "{grown}");
    assert_eq!(fixture.harness.state().opened().param_values.params["r"][0], grown);
    // The range is kept.
    let (mut fixture, radius) = with_radius();
    drag_radius(&mut fixture, &radius, 440.0);
    assert_eq!(number(&fixture, value), 2.0);
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

#[test]
fn a_value_rests_while_the_pointer_rests() {
    // The arrow points at the eye, where a point on the screen is ever less of the scene.
    let scene = "param z = 0 in -3..6\nsphere(1).translate([0.1, 0, z])\n\
                 camera(eye: [0, 0, 8], target: [0, 0, 0], fov: 40deg)\n";
    let mut fixture = Fixture::of(scene);
    fixture.click("choose z");
    fixture.until(|harness| harness.state().opened().value_handles().len() == 1);
    fixture.harness.run_steps(2);
    let handle = fixture.harness.state().opened().value_handles()[0].clone();
    let at = on_screen(&fixture, handle.handle.origin.to_array()) - vec2(0.0, 64.0);
    press(&mut fixture, at, true);
    fixture.harness.hover_at(at - vec2(0.0, 120.0));
    fixture.harness.run_steps(2);
    let first = number(&fixture, &handle.value);
    assert!(first > 0.5, "{first}");
    for _ in 0..5 {
        fixture.harness.run_steps(1);
        assert_eq!(number(&fixture, &handle.value), first);
    }
    press(&mut fixture, at - vec2(0.0, 120.0), false);
}

#[test]
fn an_arrow_stays_where_it_was_dragged_until_the_worker_answers() {
    let (mut fixture, radius) = with_radius();
    drag_radius(&mut fixture, &radius, 40.0);
    let grown = number(&fixture, &radius.value);
    assert!(grown > 1.2, "{grown}");
    let is_on_surface = |session: &Session| {
        let from_middle =
            session.value_handles()[0].handle.origin - glam::DVec3::new(-0.2, 0.0, 0.0);
        assert!((from_middle.length() - grown).abs() < 1e-2, "{from_middle} {grown}");
    };
    fixture.until(|harness| {
        let session = harness.state().opened();
        is_on_surface(session);
        let picture = session.picture.as_deref();
        picture.is_some_and(|it| it.finished && it.request.frame.params[0][0] == grown)
    });
    for _ in 0..5 {
        fixture.harness.run_steps(1);
        is_on_surface(fixture.harness.state().opened());
    }
}
