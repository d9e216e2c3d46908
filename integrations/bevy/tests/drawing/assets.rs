//! Scenes as assets, and the errors that solids report.

use std::time::Duration;

use bevy::asset::LoadState;
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use sdfc_bevy::{SdfcScene, SdfcSolid, SdfcStatus};

use crate::headless::Headless;
use crate::support::*;

/// Runs frames until a scene is loaded or has failed.
fn load(headless: &mut Headless, path: &'static str) -> (Handle<SdfcScene>, LoadState) {
    let assets = headless.app.world().resource::<AssetServer>().clone();
    let scene = assets.load(path);
    for _ in 0..1000 {
        headless.app.update();
        let state = assets.load_state(&scene);
        if matches!(state, LoadState::Loaded | LoadState::Failed(_)) {
            return (scene, state);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("{path} is neither loaded nor failed");
}

/// The status of a solid that shows a scene, after some frames.
fn status(source: &'static str, change: fn(&mut SdfcSolid)) -> SdfcStatus {
    with_app(move |headless| {
        let world = headless.app.world_mut();
        let mut solid = SdfcSolid::new(add_scene(world, source));
        change(&mut solid);
        let solid = world.spawn(solid).id();
        for _ in 0..3 {
            headless.app.update();
        }
        headless.app.world().get::<SdfcStatus>(solid).unwrap().clone()
    })
}

#[test]
fn a_file_and_its_imports_are_loaded() {
    let picture = with_app(|headless| {
        let (scene, state) = load(headless, "imports.sdf");
        assert!(state.is_loaded(), "{state:?}");
        let world = headless.app.world_mut();
        let mut solid = SdfcSolid::new(scene);
        solid.base_color = Color::srgb(0.9, 0.1, 0.1);
        world.spawn(solid);
        sun(world);
        camera(world);
        aim(headless);
        headless.picture()
    });
    let [red, green, _] = picture.at(pixel(Vec3::new(0.6, 0.3, 0.3)));
    assert!(red > 2 * green, "{red} {green}");
}

#[test]
fn a_file_with_an_error_fails_with_its_source_line() {
    let state = with_app(|headless| load(headless, "broken.sdf").1);
    let LoadState::Failed(error) = state else { panic!("{state:?}") };
    let message = error.to_string();
    assert!(message.contains("broken.sdf:1:1"), "{message}");
    assert!(message.contains("did you mean `sphere`?"), "{message}");
}

#[test]
fn time_moves_a_scene() {
    let setup = |world: &mut World| {
        stage(world);
        sun(world);
        camera(world);
    };
    let expected = draw(move |world| {
        let body = Body { transform: Transform::from_xyz(1.5, 0.5, 0.0), ..ball() };
        body.spawn(world, Kind::Mesh);
        setup(world);
    });
    let picture = with_app(move |headless| {
        let world = headless.app.world_mut();
        let scene = "sphere(0.8).translate(x: time)";
        Body { scene, ..ball() }.spawn(world, Kind::Solid);
        setup(world);
        aim(headless);
        headless.picture();
        // The virtual clock takes at most 0.25 seconds of a frame.
        for _ in 0..6 {
            let step = Duration::from_millis(250);
            headless.app.insert_resource(TimeUpdateStrategy::ManualDuration(step));
            headless.app.update();
        }
        headless.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
        headless.picture()
    });
    save("time", &expected, &picture);
    let found = compare(&expected, &picture);
    assert!(found.elsewhere == 0 && found.at_edges <= 20, "{found:?}");
}

#[test]
fn a_scene_that_is_replaced_is_drawn_anew() {
    let [before, after] = with_app(|headless| {
        let world = headless.app.world_mut();
        let scene = add_scene(world, "sphere(0.3).color(#ff0000)");
        world.spawn((SdfcSolid::new(scene.clone()), Transform::from_translation(CUBE)));
        sun(world);
        camera(world);
        aim(headless);
        let before = headless.picture();
        let world = headless.app.world_mut();
        let edited = SdfcScene::compile("edited.sdf", "box([0.9, 0.9, 0.9]).color(#00ff00)");
        let mut scenes = world.resource_mut::<Assets<SdfcScene>>();
        scenes.insert(&scene, edited.unwrap()).unwrap();
        [before, headless.picture()]
    });
    let [red, ..] = before.at(pixel(CUBE));
    let [.., green, _] = after.at(pixel(CUBE));
    assert!(red > 100 && green > 100, "{red} {green}");
    // The box of the new scene is wider.
    let aside = CUBE + Vec3::new(0.4, 0.4, 0.4);
    assert!(before.at(pixel(aside))[1] < 60 && after.at(pixel(aside))[1] > 100);
}

#[test]
fn a_scene_without_a_limit_needs_a_box() {
    let SdfcStatus::Failed(message) = status("plane()", |_| {}) else { panic!("it is drawn") };
    assert!(message.contains("`SdfcSolid::bounds`"), "{message}");
    let bounded = status("plane()", |solid| solid.bounds = Some([Vec3::splat(-1.0), Vec3::ONE]));
    assert_eq!(bounded, SdfcStatus::Drawn);
    let empty = status("plane()", |solid| solid.bounds = Some([Vec3::ONE, Vec3::splat(-1.0)]));
    let SdfcStatus::Failed(message) = empty else { panic!("it is drawn") };
    assert!(message.contains("is empty"), "{message}");
}

#[test]
fn a_wrong_param_is_reported() {
    let source = "param wall = 0.5 in 0.1..1\nsphere(wall)";
    let SdfcStatus::Failed(message) = status(source, |solid| solid.set("wal", 0.2)) else {
        panic!("it is drawn")
    };
    assert!(message.contains("did you mean `wall`?"), "{message}");
    let SdfcStatus::Failed(message) = status(source, |solid| solid.set("wall", true)) else {
        panic!("it is drawn")
    };
    assert!(message.contains("the param `wall` takes"), "{message}");
}

#[test]
fn regions_are_an_error() {
    let error = SdfcScene::compile("plan.sdf", "circle(1)").unwrap_err().to_string();
    assert!(error.contains("plan.sdf: the scene draws regions"), "{error}");
}
