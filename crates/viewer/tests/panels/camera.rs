//! The camera: moved by buttons, the wheel and the axes, and at rest while the scene is edited.

use eframe::egui::{Event, Modifiers, MouseWheelSource, MouseWheelUnit, TouchPhase, vec2};
use sdfc_render::{HIT, Pose};

use crate::fixture::Fixture;

fn pose(fixture: &Fixture) -> Pose {
    fixture.harness.state().opened().camera().unwrap().pose()
}

#[test]
fn the_camera_follows_the_scene_until_it_is_moved() {
    let mut fixture = Fixture::new();
    assert!(fixture.has("wall"));
    assert!(fixture.harness.state_mut().session().follows_scene());
    fixture.click("Top");
    assert!(!fixture.harness.state_mut().session().follows_scene());
    fixture.click("Reset camera");
    assert!(fixture.harness.state_mut().session().follows_scene());
}

#[test]
fn a_click_on_an_axis_looks_along_it() {
    let mut fixture = Fixture::of("sphere(1)\n");
    let rect = fixture.harness.state().picture_rect();
    // The scene's camera looks from the front, right and above: the end of y is the upper one.
    let reach = 35.0;
    let middle = rect.right_top() + vec2(-reach - 8.0, reach + 8.0);
    let up = pose(&fixture).basis()[1].y as f32;
    let at = middle - vec2(0.0, 27.0 * up);
    fixture.harness.hover_at(at);
    fixture.harness.run_steps(2);
    fixture.harness.drag_at(at);
    fixture.harness.drop_at(at);
    fixture.harness.run_steps(3);
    assert!(pose(&fixture).basis()[2].y < -0.99, "{:?}", pose(&fixture));
}

#[test]
fn the_camera_rests_while_a_scene_without_a_camera_is_edited() {
    let mut fixture = Fixture::of("sphere(1)\n");
    let before = pose(&fixture);
    fixture.write("sphere(3)\n");
    fixture.until(|harness| {
        let session = harness.state().opened();
        session.model.as_ref().is_some_and(|model| model.source == "sphere(3)\n")
    });
    fixture.harness.run_steps(3);
    assert_eq!(pose(&fixture), before);
    fixture.click("Fit view");
    assert!((pose(&fixture).eye - before.eye).length() > 1.0);
}

#[test]
fn the_camera_rests_while_a_param_makes_a_scene_without_a_camera_larger() {
    let mut fixture = Fixture::of("param r = 1 in 0.5..4\nsphere(r)\n");
    let before = pose(&fixture);
    let session = fixture.harness.state_mut().session();
    session.param_values.params.insert("r".to_owned(), [3.0, 0.0, 0.0, 0.0]);
    fixture.until(|harness| {
        let picture = harness.state().opened().picture.as_ref();
        picture.is_some_and(|it| it.finished && it.request.frame.params[0][0] == 3.0)
    });
    assert_eq!(pose(&fixture), before);
}

#[test]
fn the_wheel_zooms_at_the_surface_and_never_goes_through_it() {
    // The ball is far in front of the camera's target, where the pivot is.
    let scene = "sphere(1).translate(z: 4)\n\
                 camera(eye: [0, 0, 8], target: [0, 0, 0], fov: 40deg)\n";
    let mut fixture = Fixture::of(scene);
    fixture.harness.hover_at(fixture.harness.state().picture_rect().center());
    fixture.harness.run_steps(2);
    for _ in 0..30 {
        fixture.harness.event(Event::MouseWheel {
            unit: MouseWheelUnit::Line,
            delta: vec2(0.0, 3.0),
            phase: TouchPhase::Move,
            source: MouseWheelSource::Unknown,
            modifiers: Modifiers::NONE,
        });
        fixture.harness.run_steps(2);
        let eye = pose(&fixture).eye;
        assert!(eye.z > 5.0, "{eye:?} is not in front of the ball");
    }
    assert!(pose(&fixture).eye.z < 5.1);
    fixture.until(|harness| harness.state().picture_is_finished());
    let middle = fixture.harness.state().opened().pixel_info([0.5, 0.5]).unwrap();
    assert!(middle.status == HIT && (middle.point.z - 5.0).abs() < 1e-3, "{middle:?}");
}
