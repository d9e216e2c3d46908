//! `normal` and `view` in materials are the unit vectors that follow from the geometry.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use sdfc::{Backend, Compiler, Error, PictureOptions, Scene, ShaderOptions, no_progress};

type Vector = [f64; 3];
/// A number that follows from the normal and the direction to the eye.
type Expected = fn([Vector; 2]) -> f64;

/// A ball of radius 1 at a centre. Its only light is what it emits: `0.5 + 0.5 * value`.
fn scene(value: &str, more: &str) -> Scene {
    let text = format!(
        "{more}\nlet glow = fn(q: vec3) = mix(#000, #fff, 0.5 + 0.5 * {value})\n\
         sphere(1).rotate(y: 40deg, z: 70deg).emission(glow).color(#000).translate([0.3, 0.2, -0.4])\n\
         camera(eye: [1, 2, 6], target: [0, 0.2, 0], fov: 25deg)\nsun(color: #000)\nbackground(#000)"
    );
    Compiler::new().compile("a.sdf", &text).unwrap_or_else(|errors| panic!("{text}\n{errors}"))
}

const CENTER: Vector = [0.3, 0.2, -0.4];
const SIZE: [u32; 2] = [40, 30];

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Normal and direction to the eye where the ray of a pixel hits the ball.
fn at_hit([origin, direction]: [Vector; 2]) -> Option<[Vector; 2]> {
    let from_center = [0, 1, 2].map(|axis| origin[axis] - CENTER[axis]);
    let along = dot(from_center, direction);
    let square = along * along - dot(from_center, from_center) + 1.0;
    // A ray along the edge hits it at an angle that rounding decides.
    let distance = (square > 0.05).then(|| -along - square.sqrt())?;
    let normal = [0, 1, 2].map(|axis| from_center[axis] + direction[axis] * distance);
    Some([normal, direction.map(|lane| -lane)])
}

#[test]
fn a_picture_shows_the_normal_and_the_direction_to_the_eye() {
    let expected: [(&str, Expected); 5] = [
        ("normal.x", |[normal, _]| normal[0]),
        ("normal.y", |[normal, _]| normal[1]),
        ("normal.z", |[normal, _]| normal[2]),
        ("view.x", |[_, view]| view[0]),
        ("dot(normal, view)", |[normal, view]| dot(normal, view)),
    ];
    for (value, expected) in expected {
        let scene = scene(value, "");
        let options = PictureOptions::new().size(SIZE).backend(Backend::Cpu).hdr(true);
        let picture = scene.render(&options, &mut no_progress).unwrap();
        let view = scene.view(&scene.defaults(), SIZE).unwrap();
        let mut seen = 0;
        for (x, y) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))) {
            let Some(vectors) = at_hit(view.ray(x, y).map(|v| v.to_array())) else { continue };
            let glow = f64::from(picture.image.pixel(x, y).unwrap().color[0]);
            let expected = 0.5 + 0.5 * expected(vectors);
            assert!((glow - expected).abs() < 2e-3, "{value} at {x}, {y}: {glow}, {expected}");
            seen += 1;
        }
        assert!(seen > 100, "{seen} pixels show the ball");
    }
}

#[test]
fn without_an_eye_the_view_is_the_normal() -> Result<(), Error> {
    let scene = scene("dot(normal, view)", "");
    let material = scene.material([0.3, 1.2, -0.4])?.unwrap();
    assert!((material.emission[0] - 1.0).abs() < 1e-9, "{material:?}");
    let up = self::scene("normal.y", "").material([0.3, -0.8, -0.4])?.unwrap();
    assert!(up.emission[0].abs() < 1e-9, "{up:?}");
    scene.write_shader(&ShaderOptions::new()).map(drop)
}

/// The words are names like any other: a declaration of the scene has priority.
#[test]
fn a_scene_may_declare_a_name_of_its_own() {
    let scene = scene("normal.x", "let normal = [0.5, 0, 0]");
    let material = scene.material([0.3, 1.2, -0.4]).unwrap().unwrap();
    assert!((material.emission[0] - 0.75).abs() < 1e-9, "{material:?}");
}
