//! The page with three.js, which shades what it meets in its own way.

use libtest_mimic::Failed;
use sdfc::graph::eval::{FieldSample, Tape, sample_field};
use sdfc::render::{HIT, View, linear_to_srgb8};
use sdfc::{FrameValues, PictureOptions, Scene, VIEW_SIZE, no_progress};
use sdfc_tests::{compiled_example, examples_folder};
use serde_json::json;

use crate::Place;
use crate::pages::{Pixels, SCENES, THREE, check, moves, pose, shown};
use crate::table;

/// The scene that the page's camera and mesh are made for.
const SCENE: &str = SCENES[0];

/// Where the page's rays end; behind it is black.
const FAR: f32 = 100.0;

/// Whether three.js is not installed, and not required either.
pub fn is_missing() -> bool {
    !crate::chromium::is_required()
        && !examples_folder().join("embed/three/node_modules/three").exists()
}

/// Each scene at its defaults, seen by its camera; the differences are a row of the documentation's table.
pub fn shows_every_scene(place: &mut Place) -> Result<(), Failed> {
    let mut found = Vec::new();
    for name in SCENES {
        let scene = compiled_example(name)?;
        THREE.open(place, &scene, "")?;
        let pose = pose(&scene)?;
        let (eye, target) = (pose.eye.to_array(), pose.target.to_array());
        let fov = 2.0 * pose.half_height.atan().to_degrees();
        place.chromium.apply(LOOK, &json!({ "eye": eye, "target": target, "fov": fov }))?;
        found.push(check(&shown(place)?, &expected(&scene)?, name)?);
    }
    table::check(THREE.name, &found)
}

/// Looks at the field alone.
const LOOK: &str = "({ eye, target, fov }) => {
    page.knot.visible = false;
    page.camera.position.set(...eye);
    page.camera.fov = fov;
    page.camera.lookAt(...target);
    page.camera.updateProjectionMatrix();
    page.draw();
}";

/// Some of the mesh's pixels are the field's.
pub fn hides_meshes_and_fields(place: &mut Place) -> Result<(), Failed> {
    THREE.open(place, &compiled_example(SCENE)?, "")?;
    let with_mesh = shown(place)?;
    place.chromium.evaluate("page.knot.visible = false; page.draw()")?;
    let field = shown(place)?;
    let count = with_mesh.iter().zip(&field).filter(|(a, b)| a != b).count();
    place
        .chromium
        .evaluate("page.knot.visible = true; page.knot.material.depthTest = false; page.draw()")?;
    let whole = shown(place)?.iter().zip(&field).filter(|(a, b)| a != b).count();
    if !(2 * count > whole && 10 * count < 9 * whole) {
        return Err(format!("{count} of {whole} pixels of the mesh are seen").into());
    }
    Ok(())
}

/// A scene without params, and without paint: two scenes are two pictures, and nothing is complained of.
pub fn takes_a_bare_scene(place: &mut Place) -> Result<(), Failed> {
    let mut seen = Vec::new();
    for text in ["sphere(1)", "box(3)"] {
        let scene = Scene::from_source("bare.sdf", text).map_err(|e| e.to_string())?;
        THREE.open(place, &scene, "")?;
        seen.push(shown(place)?);
    }
    if seen[0] == seen[1] { Err("two scenes look the same".into()) } else { Ok(()) }
}

/// A scene with `time` stands at the time that the page is told, and moves where it is told none.
pub fn follows_the_clock(place: &mut Place) -> Result<(), Failed> {
    let scene = compiled_example("time.sdf")?;
    let at = |place: &mut Place, query: &str| -> Result<Pixels, Failed> {
        THREE.open(place, &scene, query)?;
        shown(place)
    };
    let [one, again, later] =
        [at(place, "?time=0.5")?, at(place, "?time=0.5")?, at(place, "?time=1")?];
    if one != again || one == later {
        return Err("the page is not at the time that it is told".into());
    }
    THREE.open(place, &scene, "")?;
    moves(place)
}

/// The shading of `main.js`, on what `sdfc render` meets.
fn expected(scene: &Scene) -> Result<Pixels, Failed> {
    let options = PictureOptions { size: VIEW_SIZE, samples: Some(1), ..Default::default() };
    let picture = scene.render(&options, &mut no_progress)?.image;
    let frame = FrameValues::defaults(scene.params());
    let view = View::new(scene.program(), &frame, scene.bounds_at(&frame), VIEW_SIZE)?;
    let places = (0..VIEW_SIZE[1]).flat_map(|y| (0..VIEW_SIZE[0]).map(move |x| [x, y]));
    let points: Vec<[f64; 3]> = places
        .zip(picture.pixels())
        .map(|([x, y], pixel)| {
            let [origin, direction] = view.ray(x, y);
            (origin + f64::from(pixel.depth) * direction).to_array()
        })
        .collect();
    let samples = sample_field(scene.program(), &frame, &points)?;
    let paint = match scene.program().material {
        Some([color, ..]) => Some(Tape::new(&scene.program().graph, &[color])?),
        None => None,
    };
    let mut paint = paint.as_ref().map(|tape| tape.prepare::<f64>(&frame));
    let sun = [1.5, 2.0, 0.2];
    let mut shade = |(sample, point): (&FieldSample, &[f64; 3])| {
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let gradient = sample.gradient;
        let lengths = (dot(gradient, gradient) * dot(sun, sun)).sqrt();
        let light = 0.2 + 0.8 * (dot(gradient, sun) / lengths).max(0.0);
        let painted = paint.as_mut().and_then(|paint| paint.eval(*point).first().copied());
        let [red, green, blue, _] = painted.unwrap_or([0.5; 4]);
        [red, green, blue].map(|lane| linear_to_srgb8((light * lane) as f32))
    };
    let pixels = samples.iter().zip(&points).zip(picture.pixels());
    let pixels = pixels.map(|(at, pixel)| {
        let is_met = pixel.status == HIT && pixel.depth < FAR;
        if is_met { shade(at) } else { [0; 3] }
    });
    Ok(pixels.collect())
}
