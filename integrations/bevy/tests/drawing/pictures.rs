//! Compares pictures of solids with pictures of meshes of the same shape.

use bevy::core_pipeline::prepass::{
    DeferredPrepass, DepthPrepass, MotionVectorPrepass, NormalPrepass,
};
use bevy::pbr::DefaultOpaqueRendererMethod;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::render_resource::{CachedPipelineState, PipelineCache};
use sdfc_bevy::{SdfcSolid, SdfcStatus};

use crate::support::*;

#[test]
fn a_solid_among_meshes_agrees_with_a_mesh() {
    assert_agreement("directional", 20, |world, kind| {
        ball().spawn(world, kind);
        stage(world);
        bar(world);
        sun(world);
        camera(world);
    });
}

#[test]
fn a_camera_with_parallel_rays_sees_the_same() {
    assert_agreement("parallel", 20, |world, kind| {
        ball().spawn(world, kind);
        stage(world);
        bar(world);
        sun(world);
        parallel_camera(world);
    });
}

#[test]
fn point_and_spot_lights_cast_the_same_shadows() {
    assert_agreement("point", 20, |world, kind| {
        ball().spawn(world, kind);
        stage(world);
        let light = PointLight { intensity: 9e5, shadow_maps_enabled: true, ..default() };
        world.spawn((light, Transform::from_xyz(2.0, 3.0, 1.5)));
        camera(world);
    });
    assert_agreement("spot", 20, |world, kind| {
        ball().spawn(world, kind);
        stage(world);
        let light = SpotLight { intensity: 1e6, shadow_maps_enabled: true, ..default() };
        let at = Transform::from_xyz(2.0, 3.0, 1.5).looking_at(Vec3::ZERO, Vec3::Y);
        world.spawn((light, at));
        camera(world);
    });
}

#[test]
fn a_solid_may_be_turned_and_stretched() {
    assert_agreement("stretched", 20, |world, kind| {
        let transform = Transform {
            translation: Vec3::new(0.0, 0.6, 0.0),
            rotation: Quat::from_euler(EulerRot::XYZ, 0.4, 0.7, 0.5),
            scale: Vec3::new(1.6, 0.7, 1.0),
        };
        Body { transform, ..ball() }.spawn(world, kind);
        stage(world);
        bar(world);
        sun(world);
        camera(world);
    });
}

#[test]
fn a_solid_is_drawn_in_prepasses() {
    assert_agreement("prepass", 20, |world, kind| {
        ball().spawn(world, kind);
        stage(world);
        bar(world);
        sun(world);
        let camera = camera(world);
        world.entity_mut(camera).insert((DepthPrepass, NormalPrepass, MotionVectorPrepass));
    });
}

#[test]
fn a_solid_is_drawn_beside_deferred_meshes() {
    assert_agreement("deferred", 20, |world, kind| {
        ball().spawn(world, kind);
        stage(world);
        bar(world);
        sun(world);
        let camera = camera(world);
        world.entity_mut(camera).insert((DepthPrepass, DeferredPrepass));
        world.insert_resource(DefaultOpaqueRendererMethod::deferred());
    });
}

#[test]
fn two_scenes_are_drawn_at_once() {
    assert_agreement("two", 20, |world, kind| {
        let brick = Body {
            mesh: Cuboid::new(1.0, 0.8, 0.6).into(),
            scene: "box([1, 0.8, 0.6])",
            color: Color::srgb(0.8, 0.6, 0.2),
            transform: Transform::from_xyz(-0.4, 0.9, 0.3)
                .with_rotation(Quat::from_rotation_y(0.5)),
        };
        brick.spawn(world, kind);
        ball().spawn(world, kind);
        stage(world);
        sun(world);
        camera(world);
    });
}

#[test]
fn a_param_changes_the_picture() {
    let setup = |world: &mut World| {
        stage(world);
        sun(world);
        camera(world);
    };
    let small = Body { mesh: sphere_mesh(0.55), ..ball() };
    let expected = draw(move |world| {
        small.spawn(world, Kind::Mesh);
        setup(world);
    });
    let [before, after] = with_app(move |headless| {
        let world = headless.app.world_mut();
        let solid = ball().spawn(world, Kind::Solid);
        setup(world);
        aim(headless);
        let before = headless.picture();
        let world = headless.app.world_mut();
        world.get_mut::<SdfcSolid>(solid).unwrap().set("r", 0.55);
        let after = headless.picture();
        let status = headless.app.world().get::<SdfcStatus>(solid).unwrap();
        assert_eq!(*status, SdfcStatus::Drawn);
        [before, after]
    });
    save("param", &expected, &after);
    let changed = compare(&before, &after);
    assert!(changed.at_edges + changed.elsewhere > 1000, "{changed:?}");
    let found = compare(&expected, &after);
    println!("param: {found:?}");
    assert!(found.elsewhere == 0 && found.at_edges <= 20, "{found:?}");
}

/// True if one channel of a pixel is at least 1.5 times as great as each of the others.
fn is_mostly(channel: usize, pixel: [u8; 3]) -> bool {
    let others = (0..3).filter(|&other| other != channel);
    others.into_iter().all(|other| 2 * u32::from(pixel[channel]) > 3 * u32::from(pixel[other]))
}

const RED: usize = 0;
const GREEN: usize = 1;
const BLUE: usize = 2;

#[test]
fn what_is_nearer_hides_what_is_behind() {
    let setup = |world: &mut World| {
        stage(world);
        sun(world);
        camera(world);
    };
    let meshes = draw(setup);
    let all = draw(move |world| {
        ball().spawn(world, Kind::Solid);
        setup(world);
    });
    // The front of the cube, in front of the ball.
    let cube = CUBE + Vec3::new(-0.15, 0.15, 0.25);
    assert!(is_mostly(BLUE, all.at(pixel(cube))), "{:?}", all.at(pixel(cube)));
    // The half of the green sphere that is inside the ball, and the half that is not.
    let toward_ball = Vec3::new(0.38, 0.05, 0.0);
    let (inside, outside) = (NEIGHBOUR + toward_ball, NEIGHBOUR - toward_ball / 2.0);
    assert!(is_mostly(GREEN, meshes.at(pixel(inside))), "{:?}", meshes.at(pixel(inside)));
    assert!(is_mostly(RED, all.at(pixel(inside))), "{:?}", all.at(pixel(inside)));
    assert!(is_mostly(GREEN, all.at(pixel(outside))), "{:?}", all.at(pixel(outside)));
    // The box of the solid reaches farther than the solid, and what is behind its corners is seen.
    let corner = Vec3::new(0.75, 1.25, 0.0);
    assert_eq!(all.at(pixel(corner)), meshes.at(pixel(corner)));
}

#[test]
fn a_solid_casts_a_shadow() {
    // A ball in the air, and the point of the ground below it as the sun sees it. The second ball
    // is nearer to the sun than the near plane of the shadow's view.
    let in_shadow = Vec3::new(-1.25, 0.0, -0.5);
    let pictures = [None, Some(1.0), Some(8.0)].map(|distance| {
        draw(move |world| {
            if let Some(distance) = distance {
                let at = in_shadow + distance * Vec3::new(2.5, 4.0, 1.0);
                let transform = Transform::from_translation(at).with_scale(Vec3::splat(0.5));
                Body { transform, ..ball() }.spawn(world, Kind::Solid);
            }
            let ground = Plane3d::default().mesh().size(9.0, 9.0).build();
            mesh_with(world, ground, StandardMaterial::default(), Transform::IDENTITY);
            sun(world);
            camera(world);
        })
    });
    let [without, near, far] = pictures.map(|picture| picture.brightness(in_shadow));
    assert!(2 * near < without, "{near} in the shadow, {without} without it");
    assert!(2 * far < without, "{far} in the shadow of a ball far away, {without} without it");
}

#[test]
fn a_solid_receives_shadows() {
    // On the ball, below the bar as the sun sees it.
    let sun_direction = Vec3::new(2.5, 4.0, 1.0).normalize();
    let bar_at = Vec3::new(0.95, 2.1, 0.5);
    let center = Vec3::new(0.0, 0.5, 0.0);
    let along = (bar_at - center).dot(sun_direction);
    let aside = bar_at - center - along * sun_direction;
    let in_shadow = center + aside + (0.64 - aside.length_squared()).sqrt() * sun_direction;
    let [without, with] = [false, true].map(|has_bar| {
        draw(move |world| {
            ball().spawn(world, Kind::Solid);
            if has_bar {
                bar(world);
            }
            sun(world);
            camera(world);
        })
    });
    let [without, with] = [without, with].map(|picture| picture.brightness(in_shadow));
    assert!(2 * with < without, "{with} in the shadow, {without} without it");
}

#[test]
fn a_camera_inside_the_box_sees_the_solid() {
    // The camera is in the hole of a ring, which fills its box but for the middle.
    let picture = draw(|world| {
        let scene = add_scene(world, "torus(4, 1).color(#ff0000)");
        world.spawn(SdfcSolid::new(scene));
        sun(world);
        let camera = camera(world);
        let at = Transform::from_xyz(0.0, 0.2, 0.0).looking_at(Vec3::new(3.0, 0.0, 1.0), Vec3::Y);
        world.entity_mut(camera).insert(at);
    });
    assert!(is_mostly(RED, picture.at([SIZE[0] / 2, SIZE[1] / 2])));
}

#[test]
fn materials_of_a_scene_are_those_of_bevy() {
    assert_agreement("material", 20, |world, kind| {
        let rows = [(0.3, 1.0, -0.9), (0.7, 0.0, 0.9)];
        for (roughness, metallic, x) in rows {
            let transform = Transform::from_xyz(x, 0.5, 0.0);
            match kind {
                Kind::Mesh => {
                    let material = StandardMaterial {
                        base_color: Color::srgb_u8(0xd4, 0xaf, 0x37),
                        perceptual_roughness: roughness,
                        metallic,
                        ..default()
                    };
                    mesh_with(world, sphere_mesh(0.8), material, transform);
                }
                Kind::Solid => {
                    let scene = format!(
                        "sphere(0.8).color(#d4af37).roughness({roughness}).metallic({metallic})"
                    );
                    let scene = add_scene(world, &scene);
                    world.spawn((SdfcSolid::new(scene), transform));
                }
            }
        }
        stage(world);
        sun(world);
        camera(world);
    });
}

#[test]
fn a_scene_with_long_lists_is_drawn() {
    let picture = draw(|world| {
        let scene = add_scene(
            world,
            "polygon([for i in 0..80: [cos(i * tau / 80), sin(i * tau / 80)]]).extrude(0.5)",
        );
        let mut solid = SdfcSolid::new(scene);
        solid.base_color = Color::srgb(0.9, 0.1, 0.1);
        world.spawn((solid, Transform::from_xyz(0.0, 0.5, 0.0)));
        sun(world);
        camera(world);
    });
    assert!(is_mostly(RED, picture.at(pixel(Vec3::new(0.3, 0.5, 0.25)))));
}

/// Scenes of `examples` that together use loops, lists, patterns, several ray methods and the time.
const EXAMPLES: [&str; 6] =
    ["gyroid_lattice", "mandelbulb", "materials", "menger_sponge", "params", "time"];

#[test]
fn bevy_accepts_the_shaders_of_examples() {
    let (picture, errors) = with_app(|headless| {
        let world = headless.app.world_mut();
        for (name, x) in EXAMPLES.into_iter().zip(0u8..) {
            let path = format!("{}/../../examples/{name}.sdf", env!("CARGO_MANIFEST_DIR"));
            let text = std::fs::read_to_string(path).unwrap();
            let mut solid = SdfcSolid::new(add_scene(world, &text));
            // Some of them stand on a floor without a limit.
            solid.bounds = Some([Vec3::splat(-1.2), Vec3::splat(1.2)]);
            let at = Transform::from_xyz(f32::from(x) - 2.5, 0.0, 0.0);
            world.spawn((solid, at.with_scale(Vec3::splat(0.35))));
        }
        sun(world);
        let camera = parallel_camera(world);
        let at = Transform::from_xyz(0.0, 2.0, 5.0).looking_at(Vec3::ZERO, Vec3::Y);
        world.entity_mut(camera).insert(at);
        aim(headless);
        let picture = headless.picture();
        let cache = headless.app.sub_app(RenderApp).world().resource::<PipelineCache>();
        let failed = |state: &CachedPipelineState| match state {
            CachedPipelineState::Err(error) => Some(error.to_string()),
            CachedPipelineState::Ok(_)
            | CachedPipelineState::Queued
            | CachedPipelineState::Creating(_) => None,
        };
        let errors: Vec<_> = cache.pipelines().filter_map(|it| failed(&it.state)).collect();
        (picture, errors)
    });
    picture.save(format!("{}/examples.png", env!("CARGO_TARGET_TMPDIR"))).unwrap();
    assert!(errors.is_empty(), "{errors:?}");
    let background = picture.at([0, 0]);
    for (name, x) in EXAMPLES.into_iter().zip(0..) {
        // 48 pixels show one unit.
        let left = SIZE[0] / 2 + 48 * x - 3 * 48;
        let pixels = (left..left + 48).flat_map(|x| (0..SIZE[1]).map(move |y| [x, y]));
        let drawn = pixels.filter(|&at| picture.at(at) != background).count();
        assert!(drawn > 200, "{name} has {drawn} pixels");
    }
}
