//! The page with three.js shows every scene, with a shading of its own.

use libtest_mimic::Failed;
use sdfc::{Compiler, FrameValues, PictureOptions, Scene, VIEW_SIZE, no_progress};
use sdfc_graph::eval::{FieldSample, Tape, sample_field};
use sdfc_render::{HIT, View, linear_to_srgb8};
use sdfc_tests::{compiled_example, examples_folder};
use serde_json::json;

use crate::Session;
use crate::pages::{Pixels, SCENES, THREE, check, moves, pose, shown};
use crate::table;

/// The scene for which the page's camera and mesh are made.
const SCENE: &str = SCENES[0];

/// The length of the page's rays. Pixels behind it are black.
const FAR: f32 = 100.0;

/// Returns true if three.js is neither installed nor required.
pub fn is_missing() -> bool {
    !crate::chromium::is_required()
        && !examples_folder().join("embed/three/node_modules/three").exists()
}

/// Shows each scene at its defaults with its own camera. The differences are a row of a table in
/// the documentation.
pub fn shows_every_scene(session: &mut Session) -> Result<(), Failed> {
    let mut found = Vec::new();
    for name in SCENES {
        let scene = compiled_example(name)?;
        THREE.open(session, &scene, "")?;
        let pose = pose(&scene)?;
        let (eye, target) = (pose.eye.to_array(), pose.target.to_array());
        let fov = 2.0 * pose.half_height.atan().to_degrees();
        session.chromium.apply(LOOK, &json!({ "eye": eye, "target": target, "fov": fov }))?;
        found.push(check(&shown(session)?, &expected(&scene)?, name)?);
    }
    table::check(THREE.name, &found)
}

/// Shows the field without the mesh.
const LOOK: &str = "({ eye, target, fov }) => {
    page.knot.visible = false;
    page.camera.position.set(...eye);
    page.camera.fov = fov;
    page.camera.lookAt(...target);
    page.camera.updateProjectionMatrix();
    page.draw();
}";

/// The field hides some of the mesh's pixels.
pub fn hides_meshes_and_fields(session: &mut Session) -> Result<(), Failed> {
    THREE.open(session, &compiled_example(SCENE)?, "")?;
    let with_mesh = shown(session)?;
    session.chromium.evaluate("page.knot.visible = false; page.draw()")?;
    let field = shown(session)?;
    let count = with_mesh.iter().zip(&field).filter(|(a, b)| a != b).count();
    session
        .chromium
        .evaluate("page.knot.visible = true; page.knot.material.depthTest = false; page.draw()")?;
    let whole = shown(session)?.iter().zip(&field).filter(|(a, b)| a != b).count();
    if !(2 * count > whole && 10 * count < 9 * whole) {
        return Err(format!("{count} of {whole} pixels of the mesh are seen").into());
    }
    Ok(())
}

/// Shows scenes without params and materials: two scenes are two pictures, without errors.
pub fn takes_a_bare_scene(session: &mut Session) -> Result<(), Failed> {
    let mut seen = Vec::new();
    for text in ["sphere(1)", "box(3)"] {
        let scene = Compiler::new().compile("bare.sdf", text).map_err(|e| e.to_string())?;
        THREE.open(session, &scene, "")?;
        seen.push(shown(session)?);
    }
    if seen[0] == seen[1] { Err("two scenes look the same".into()) } else { Ok(()) }
}

/// A scene with `time` is shown at the time in the URL, and moves without one.
pub fn follows_the_clock(session: &mut Session) -> Result<(), Failed> {
    let scene = compiled_example("time.sdf")?;
    let at = |session: &mut Session, query: &str| -> Result<Pixels, Failed> {
        THREE.open(session, &scene, query)?;
        shown(session)
    };
    let [one, again, later] =
        [at(session, "?time=0.5")?, at(session, "?time=0.5")?, at(session, "?time=1")?];
    if one != again || one == later {
        return Err("the page does not show the time in the URL".into());
    }
    THREE.open(session, &scene, "")?;
    moves(session)
}

/// Computes the shading of `main.js` at the hits of `sdfc render`.
fn expected(scene: &Scene) -> Result<Pixels, Failed> {
    let options = PictureOptions::new().size(VIEW_SIZE).samples(Some(1));
    let picture = scene.render(&options, &mut no_progress)?.image;
    let frame = FrameValues::defaults(scene.params());
    let view = View::new(scene.program(), &frame, scene.bounds_at(&frame), VIEW_SIZE)?;
    let pixels = (0..VIEW_SIZE[1]).flat_map(|y| (0..VIEW_SIZE[0]).map(move |x| [x, y]));
    let points: Vec<[f64; 3]> = pixels
        .zip(picture.pixels())
        .map(|([x, y], pixel)| {
            let [origin, direction] = view.ray(x, y);
            (origin + f64::from(pixel.depth) * direction).to_array()
        })
        .collect();
    let samples = sample_field(scene.program(), &frame, &points)?;
    let material = match scene.program().material {
        Some([color, ..]) => Some(Tape::new(&scene.program().graph, &[color])?),
        None => None,
    };
    let mut material = material.as_ref().map(|tape| tape.prepare::<f64>(&frame));
    let sun = [1.5, 2.0, 0.2];
    let mut shade = |(sample, point): (&FieldSample, &[f64; 3])| {
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let gradient = sample.gradient;
        let lengths = (dot(gradient, gradient) * dot(sun, sun)).sqrt();
        let light = 0.2 + 0.8 * (dot(gradient, sun) / lengths).max(0.0);
        let color = material.as_mut().and_then(|material| material.eval(*point).first().copied());
        let [red, green, blue, _] = color.unwrap_or([0.5; 4]);
        [red, green, blue].map(|lane| linear_to_srgb8((light * lane) as f32))
    };
    let pixels = samples.iter().zip(&points).zip(picture.pixels());
    let pixels = pixels.map(|(at, pixel)| {
        let is_met = pixel.status == HIT && pixel.depth < FAR;
        if is_met { shade(at) } else { [0; 3] }
    });
    Ok(pixels.collect())
}
