//! The page with three.js, which shades what it meets in its own way.

use libtest_mimic::Failed;
use sdfc::graph::eval::{FieldSample, Tape, sample_field};
use sdfc::render::{View, linear_to_srgb8};
use sdfc::{FrameValues, PictureOptions, Scene, VIEW_SIZE, unwatched};

use crate::Place;
use crate::examples::{example, folder};
use crate::pages::{Pixels, SCENES, THREE, check, moves, shown};
use crate::table;

/// The scene that the page's camera is made for.
const SCENE: &str = SCENES[0];

/// Whether three.js is not installed, and not required either.
pub fn is_missing() -> bool {
    !crate::chromium::is_required() && !folder().join("embed/three/node_modules/three").exists()
}

/// Without the mesh the picture is that of the field; with it, some pixels are the mesh's.
pub fn shows_the_field(place: &mut Place) -> Result<(), Failed> {
    let scene = example(SCENE)?;
    THREE.open(place, &scene, "")?;
    let with_mesh = shown(place)?;
    place.chromium.evaluate("page.knot.visible = false; page.draw()")?;
    let field = shown(place)?;
    let found = check(&field, &expected(&scene)?, SCENE)?;
    let count = with_mesh.iter().zip(&field).filter(|(a, b)| a != b).count();
    place
        .chromium
        .evaluate("page.knot.visible = true; page.knot.material.depthTest = false; page.draw()")?;
    let whole = shown(place)?.iter().zip(&field).filter(|(a, b)| a != b).count();
    if !(2 * count > whole && 10 * count < 9 * whole) {
        return Err(format!("{count} of {whole} pixels of the mesh are seen").into());
    }
    table::check(THREE.name, &[found])
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
    let scene = example("time.sdf")?;
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
    let picture = scene.render(&options, &mut unwatched)?.image;
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
    let [color, ..] = scene.program().material.ok_or("nothing is painted")?;
    let tape = Tape::new(&scene.program().graph, &[color])?;
    let mut paint = tape.prepare::<f64>(&frame);
    let sun = [1.5, 2.0, 0.2];
    let shade = |(sample, point): (&FieldSample, &[f64; 3])| {
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let gradient = sample.gradient;
        let lengths = (dot(gradient, gradient) * dot(sun, sun)).sqrt();
        let light = 0.2 + 0.8 * (dot(gradient, sun) / lengths).max(0.0);
        let [[red, green, blue, _]] = paint.eval(*point) else { return [0; 3] };
        [red, green, blue].map(|lane| linear_to_srgb8((light * lane) as f32))
    };
    Ok(samples.iter().zip(&points).map(shade).collect())
}
