//! Compares pictures of solids with pictures of meshes of the same shape.

#[path = "../examples/headless/mod.rs"]
mod headless;

use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;
use headless::Headless;
use sdfc_bevy::{SdfcScene, SdfcSolid};

#[test]
fn first() {
    let start = std::time::Instant::now();
    let mut it = Headless::new([320, 192], "tests/scenes");
    eprintln!("app {:?}", start.elapsed());
    let target = it.target();
    let world = it.app.world_mut();
    let scene = SdfcScene::compile("a.sdf", include_str!("scenes/sphere.sdf")).unwrap();
    let scene = world.resource_mut::<Assets<SdfcScene>>().add(scene);
    world.spawn((SdfcSolid::new(scene), Transform::from_xyz(0.0, 0.5, 0.0)));
    let plane = world.resource_mut::<Assets<Mesh>>().add(Plane3d::default().mesh().size(8.0, 8.0));
    let grey = world.resource_mut::<Assets<StandardMaterial>>().add(Color::srgb(0.5, 0.6, 0.5));
    world.spawn((Mesh3d(plane), MeshMaterial3d(grey)));
    world.spawn((
        DirectionalLight { illuminance: 8000.0, shadow_maps_enabled: true, ..default() },
        CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: 12.0, ..default() }.build(),
        Transform::from_xyz(2.0, 4.0, 1.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    world.spawn((
        Camera3d::default(),
        target,
        Tonemapping::None,
        Transform::from_xyz(0.0, 2.5, 5.0).looking_at(Vec3::new(0.0, 0.4, 0.0), Vec3::Y),
    ));
    let picture = it.picture();
    eprintln!("picture {:?}", start.elapsed());
    picture.save("target/first.png").unwrap();
}
