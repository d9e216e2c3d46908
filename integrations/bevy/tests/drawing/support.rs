//! A stage with meshes and lights, drawn by one app, and the comparison of its pictures.

use std::any::Any;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Mutex, OnceLock, PoisonError};

use bevy::camera::ScalingMode;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::CascadeShadowConfigBuilder;
use bevy::pbr::DefaultOpaqueRendererMethod;
use bevy::prelude::*;
use sdfc_bevy::{SdfcScene, SdfcSolid};

use crate::headless::{Headless, Picture};

/// Size of the pictures.
pub const SIZE: [u32; 2] = [320, 192];
/// Greatest difference of a channel, in 255ths, at which two pixels are the same.
pub const TOLERANCE: u8 = 3;
/// A pixel is at an edge if a neighbour differs by more than this.
const EDGE: u8 = 8;

const EYE: Vec3 = Vec3::new(1.5, 2.5, 5.0);
const FOCUS: Vec3 = Vec3::new(0.0, 0.4, 0.0);

type Job = Box<dyn FnOnce(&mut Headless) -> Box<dyn Any + Send> + Send>;
type Reply = Sender<Box<dyn Any + Send>>;

/// Runs a job with the app of all tests, on the thread that owns it. Compiling Bevy's shaders takes
/// seconds, so the tests share them.
pub fn with_app<T: Send + 'static>(job: impl FnOnce(&mut Headless) -> T + Send + 'static) -> T {
    static QUEUE: OnceLock<Mutex<Sender<(Job, Reply)>>> = OnceLock::new();
    let queue = QUEUE.get_or_init(|| {
        let (sender, receiver) = channel::<(Job, Reply)>();
        std::thread::spawn(move || {
            let mut headless = Headless::new(SIZE, "tests/scenes");
            while let Ok((job, reply)) = receiver.recv() {
                let result = job(&mut headless);
                clear(headless.app.world_mut());
                // The test that asked may have panicked.
                let _ = reply.send(result);
            }
        });
        Mutex::new(sender)
    });
    let (reply, result) = channel();
    let job: Job = Box::new(|headless| Box::new(job(headless)));
    queue.lock().unwrap_or_else(PoisonError::into_inner).send((job, reply)).unwrap();
    *result.recv().expect("the job did not panic").downcast().unwrap()
}

fn clear(world: &mut World) {
    let mut everything = world.query_filtered::<Entity, With<Transform>>();
    for entity in everything.iter(world).collect::<Vec<_>>() {
        world.despawn(entity);
    }
}

/// Draws a picture of what a function adds to an empty world.
pub fn draw(setup: impl FnOnce(&mut World) + Send + 'static) -> Picture {
    with_app(|headless| {
        setup(headless.app.world_mut());
        aim(headless);
        headless.picture()
    })
}

/// Makes all cameras draw to the picture.
pub fn aim(headless: &mut Headless) {
    let target = headless.target();
    let world = headless.app.world_mut();
    let mut cameras = world.query_filtered::<Entity, With<Camera>>();
    for camera in cameras.iter(world).collect::<Vec<_>>() {
        world.entity_mut(camera).insert(target.clone());
    }
}

/// How a body is drawn.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    Mesh,
    Solid,
}

/// A shape as a mesh and as a scene.
pub struct Body {
    pub mesh: Mesh,
    pub scene: &'static str,
    pub color: Color,
    pub transform: Transform,
}

pub fn sphere_mesh(radius: f32) -> Mesh {
    Sphere::new(radius).mesh().uv(256, 128)
}

/// A red ball of radius 0.8 that is sunk into the ground.
pub fn ball() -> Body {
    Body {
        mesh: sphere_mesh(0.8),
        scene: include_str!("../scenes/sphere.sdf"),
        color: Color::srgb(0.8, 0.25, 0.2),
        transform: Transform::from_xyz(0.0, 0.5, 0.0),
    }
}

impl Body {
    pub fn spawn(self, world: &mut World, kind: Kind) -> Entity {
        let Self { mesh, scene, color, transform } = self;
        match kind {
            Kind::Mesh => {
                let material =
                    StandardMaterial { base_color: color, perceptual_roughness: 0.6, ..default() };
                mesh_with(world, mesh, material, transform)
            }
            Kind::Solid => {
                let mut solid = SdfcSolid::new(add_scene(world, scene));
                (solid.base_color, solid.perceptual_roughness) = (color, 0.6);
                world.spawn((solid, transform)).id()
            }
        }
    }
}

pub fn add_scene(world: &mut World, source: &str) -> Handle<SdfcScene> {
    let scene = SdfcScene::compile("test.sdf", source).expect("the scene compiles");
    world.resource_mut::<Assets<SdfcScene>>().add(scene)
}

pub fn mesh_with(
    world: &mut World,
    mesh: Mesh,
    material: StandardMaterial,
    transform: Transform,
) -> Entity {
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(material);
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material), transform)).id()
}

fn colored(color: Color) -> StandardMaterial {
    StandardMaterial { base_color: color, ..default() }
}

/// Where the cube is that stands in front of the ball.
pub const CUBE: Vec3 = Vec3::new(0.75, 0.25, 1.3);
/// Where the mesh sphere is that intersects the ball.
pub const NEIGHBOUR: Vec3 = Vec3::new(-0.75, 0.4, 0.35);

/// The ground, a cube in front of the ball, and a green mesh sphere that intersects it.
pub fn stage(world: &mut World) {
    let ground = Plane3d::default().mesh().size(9.0, 9.0).build();
    mesh_with(world, ground, colored(Color::srgb(0.55, 0.55, 0.5)), Transform::IDENTITY);
    let cube = Cuboid::from_length(0.5).into();
    let blue = colored(Color::srgb(0.2, 0.3, 0.8));
    mesh_with(world, cube, blue, Transform::from_translation(CUBE));
    let green = colored(Color::srgb(0.3, 0.7, 0.25));
    mesh_with(world, sphere_mesh(0.4), green, Transform::from_translation(NEIGHBOUR));
}

/// A bar between the light and the ball. Its shadow falls onto both ball and ground.
pub fn bar(world: &mut World) -> Entity {
    let mesh = Cuboid::new(0.25, 0.25, 3.0).into();
    let at = Transform::from_xyz(0.95, 2.1, 0.5);
    mesh_with(world, mesh, colored(Color::srgb(0.7, 0.7, 0.3)), at)
}

/// A directional light with shadows, from above on the right.
pub fn sun(world: &mut World) -> Entity {
    let light = DirectionalLight { illuminance: 4000.0, shadow_maps_enabled: true, ..default() };
    let cascades =
        CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: 12.0, ..default() };
    let at = Transform::from_xyz(2.5, 4.0, 1.0).looking_at(Vec3::ZERO, Vec3::Y);
    world.spawn((light, cascades.build(), at)).id()
}

fn camera_transform() -> Transform {
    Transform::from_translation(EYE).looking_at(FOCUS, Vec3::Y)
}

/// A camera with perspective and without anti-aliasing, which draws meshes in the forward pass.
pub fn camera(world: &mut World) -> Entity {
    world.insert_resource(DefaultOpaqueRendererMethod::forward());
    let camera = (Camera3d::default(), Tonemapping::None, Msaa::Off, camera_transform());
    world.spawn(camera).id()
}

/// A camera with parallel rays.
pub fn parallel_camera(world: &mut World) -> Entity {
    let camera = camera(world);
    let mut projection = OrthographicProjection::default_3d();
    projection.scaling_mode = ScalingMode::FixedVertical { viewport_height: 4.0 };
    world.entity_mut(camera).insert(Projection::Orthographic(projection));
    camera
}

/// The pixel of [`camera`] that shows a point.
pub fn pixel(point: Vec3) -> [u32; 2] {
    let view = camera_transform().to_matrix().inverse();
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let clip = Mat4::perspective_infinite_reverse_rh(std::f32::consts::FRAC_PI_4, aspect, 0.1);
    let seen = (clip * view).project_point3(point);
    let at = |x: f32, size: u32| ((0.5 + 0.5 * x) * size as f32) as u32;
    [at(seen.x, SIZE[0]), at(-seen.y, SIZE[1])]
}

impl Picture {
    /// Red, green and blue of a pixel.
    pub fn at(&self, [x, y]: [u32; 2]) -> [u8; 3] {
        let start = 4 * (y * self.size[0] + x) as usize;
        [self.bytes[start], self.bytes[start + 1], self.bytes[start + 2]]
    }

    /// Sum of red, green and blue of the pixel that shows a point.
    pub fn brightness(&self, point: Vec3) -> u32 {
        self.at(pixel(point)).map(u32::from).iter().sum()
    }

    fn is_at_edge(&self, [x, y]: [u32; 2]) -> bool {
        let around = |x: u32, size: u32| x.saturating_sub(1)..(x + 2).min(size);
        let pixel = self.at([x, y]);
        around(x, self.size[0])
            .flat_map(|i| around(y, self.size[1]).map(move |j| [i, j]))
            .any(|other| difference(pixel, self.at(other)) > EDGE)
    }
}

fn difference(a: [u8; 3], b: [u8; 3]) -> u8 {
    let channels = a.into_iter().zip(b).map(|(a, b)| a.abs_diff(b));
    channels.max().unwrap_or_default()
}

/// How two pictures differ by more than [`TOLERANCE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Pixels beside edges of either picture.
    pub at_edges: usize,
    /// Other pixels.
    pub elsewhere: usize,
    /// The greatest difference of a channel, in 255ths, of pixels that are not at edges.
    pub greatest: u8,
}

pub fn compare(a: &Picture, b: &Picture) -> Difference {
    let mut found = Difference { at_edges: 0, elsewhere: 0, greatest: 0 };
    for y in 0..a.size[1] {
        for x in 0..a.size[0] {
            let here = difference(a.at([x, y]), b.at([x, y]));
            let is_at_edge = a.is_at_edge([x, y]) || b.is_at_edge([x, y]);
            if !is_at_edge {
                found.greatest = found.greatest.max(here);
            }
            if here > TOLERANCE {
                *(if is_at_edge { &mut found.at_edges } else { &mut found.elsewhere }) += 1;
            }
        }
    }
    found
}

/// Saves both pictures and a third, which shows where they differ, in the folder of the tests.
pub fn save(name: &str, mesh: &Picture, solid: &Picture) {
    let folder = env!("CARGO_TARGET_TMPDIR");
    let pairs = mesh.bytes.chunks_exact(4).zip(solid.bytes.chunks_exact(4));
    let apart = pairs.flat_map(|(a, b)| {
        let [r, g, b] = std::array::from_fn(|i| a[i].abs_diff(b[i]).saturating_mul(8));
        [r, g, b, 255]
    });
    let apart = Picture { size: mesh.size, bytes: apart.collect() };
    for (kind, picture) in [("mesh", mesh), ("solid", solid), ("difference", &apart)] {
        picture.save(format!("{folder}/{name}-{kind}.png")).expect("the folder is writable");
    }
}

/// Draws a world with a body as a mesh and as a solid, and checks that the pictures agree: no pixel
/// but those at edges differs, and at most `at_edges` of these do.
pub fn assert_agreement(name: &str, at_edges: usize, setup: fn(&mut World, Kind)) {
    let [mesh, solid] = [Kind::Mesh, Kind::Solid].map(|kind| draw(move |world| setup(world, kind)));
    save(name, &mesh, &solid);
    let found = compare(&mesh, &solid);
    println!("{name}: {found:?}");
    assert!(
        found.elsewhere == 0 && found.at_edges <= at_edges,
        "{name}: {found:?}, with at most {at_edges} at edges; the pictures are in {}",
        env!("CARGO_TARGET_TMPDIR")
    );
}
