//! Draws two scenes among meshes and writes the picture to a file:
//!
//! ```text
//! cargo run --example among_meshes -- among_meshes.png
//! ```
//!
//! It opens no window, so it runs on machines without a display. In a program with a window,
//! `setup` is the same: add `DefaultPlugins` and `SdfcPlugin`, and leave out the target of the
//! camera.

mod headless;

use std::error::Error;

use bevy::asset::LoadState;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;
use headless::Headless;
use sdfc_bevy::{SdfcError, SdfcScene, SdfcSolid};

/// A scene with materials of its own.
const LANTERN: &str = "\
param cell = 0.42 in 0.2..1
let skin = gyroid(cell, wall: 0.07)
intersection(skin, sphere(0.75) - sphere(0.66), blend: smooth(0.02)).color(#e0902c).roughness(0.35)
sphere(0.2).color(#ffd9a0).emission(#ffd9a0)
";

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "among_meshes.png".to_owned());
    // The folder of `bowl.sdf`.
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/embed");
    let mut headless = Headless::new([960, 540], folder);
    let target = headless.target();
    let bowl = setup(headless.app.world_mut())?;
    let world = headless.app.world_mut();
    world.spawn((
        Camera3d::default(),
        target,
        Tonemapping::AcesFitted,
        Transform::from_xyz(1.6, 2.6, 4.6).looking_at(Vec3::new(0.0, 0.75, 0.0), Vec3::Y),
    ));
    let picture = headless.picture();
    if let LoadState::Failed(error) =
        headless.app.world().resource::<AssetServer>().load_state(&bowl)
    {
        return Err(error.to_string().into());
    }
    picture.save(path)
}

/// Adds solids, meshes and a light. Returns the scene that is loaded from a file.
fn setup(world: &mut World) -> Result<Handle<SdfcScene>, SdfcError> {
    // A scene from a file, with a param that is not at its default.
    let bowl = world.resource::<AssetServer>().load("bowl.sdf");
    let mut solid = SdfcSolid::new(bowl.clone()).with("opening", 0.35);
    solid.base_color = Color::srgb(0.35, 0.55, 0.65);
    world.spawn((solid, Transform::from_xyz(-0.6, 1.15, 0.0)));

    // A scene from a string.
    let lantern = SdfcScene::compile("lantern.sdf", LANTERN)?;
    let lantern = world.resource_mut::<Assets<SdfcScene>>().add(lantern);
    world.spawn((SdfcSolid::new(lantern), Transform::from_xyz(1.35, 0.75, 0.5)));

    let plane = Plane3d::default().mesh().size(14.0, 14.0).build();
    mesh(world, plane, Color::srgb(0.62, 0.6, 0.55), Vec3::ZERO);
    // It intersects the wall of the bowl.
    let ball = Sphere::new(0.5).mesh().uv(128, 64);
    mesh(world, ball, Color::srgb(0.75, 0.2, 0.2), Vec3::new(-0.75, 1.15, 0.85));
    // Its shadow falls on the bowl.
    let cube = Cuboid::from_length(0.5).into();
    mesh(world, cube, Color::srgb(0.85, 0.75, 0.3), Vec3::new(0.35, 2.15, 0.65));

    world.insert_resource(ClearColor(Color::srgb(0.75, 0.82, 0.88)));
    world.insert_resource(GlobalAmbientLight { brightness: 500.0, ..default() });
    world.spawn((
        DirectionalLight { illuminance: 7000.0, shadow_maps_enabled: true, ..default() },
        CascadeShadowConfigBuilder { maximum_distance: 15.0, ..default() }.build(),
        Transform::from_xyz(3.0, 3.6, 1.6).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    Ok(bowl)
}

fn mesh(world: &mut World, mesh: Mesh, color: Color, at: Vec3) {
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(color);
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material), Transform::from_translation(at)));
}
