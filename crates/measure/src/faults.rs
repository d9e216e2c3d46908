//! Counts the wrong pixels of a naive ray marcher on the scenes of `examples/faults`, and those of
//! sdfc.

use sdfc::{Method, Scene};
use sdfc_codegen::{FieldSource, benchmark_module};
use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;
use sdfc_render::{
    CpuScene, Gpu, HIT, Image, Pipeline, RenderOptions, View, edges, linear_to_srgb8, no_progress,
    uniform_values,
};
use serde::Serialize;

use crate::baseline::{self, Inexpressible};
use crate::error::MeasureError;

/// Tolerance of the reference picture, as a fraction of the scene's.
const REFERENCE_PART: f64 = 1e-5;
/// Step limit of the reference picture. Rays that graze a surface need many steps.
const REFERENCE_STEPS: u32 = 1_000_000;
/// A colour that differs by more sRGB steps of 1/255 counts as wrong.
const COLOR_STEPS: u8 = 8;

/// The results, as `bench --faults --json` writes them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultReport {
    /// Name of the GPU.
    pub adapter: String,
    /// Name and version of its driver.
    pub driver: String,
    /// One for each scene.
    pub rows: Vec<FaultRow>,
}

/// One scene, drawn in several ways.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultRow {
    /// Name of the scene.
    pub scene: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Number of compared pixels: all except those at the reference's edges.
    pub compared: usize,
    /// One for each combination of field and method.
    pub variants: Vec<FaultVariant>,
}

/// Numbers of wrong pixels of a picture, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct FaultVariant {
    /// Field and ray method.
    pub name: &'static str,
    /// Missed surface.
    pub missed: usize,
    /// Hit where there is no surface.
    pub false_hits: usize,
    /// Hit with an error in depth of more than the width of a pixel.
    pub misplaced: usize,
    /// Hit at the right depth with a colour that differs by more than 8 of 255 steps.
    pub miscolored: usize,
    /// Fraction of the compared pixels that are wrong.
    pub wrong: f64,
    /// Mean number of field evaluations per pixel.
    pub evals_per_pixel: f64,
}

/// Returns names and sources of the scenes.
pub fn fault_scenes() -> [(&'static str, &'static str); 4] {
    sdfc_examples::FAULTS
}

/// Name, field and ray method of the compared pictures.
const VARIANTS: [(&str, FieldSource, Method); 3] = [
    ("units, practical", FieldSource::Units, Method::Practical),
    ("units, sphere", FieldSource::Units, Method::Sphere),
    ("scene, auto", FieldSource::Scene, Method::Auto),
];

/// Draws the scene without materials in three ways, and compares each picture with one drawn in f64
/// Draws the scene without materials in three ways, and compares each picture with one drawn in f64
/// on the CPU: with a naive interpreter and marcher, with that interpreter and a ray method of
/// sdfc, and with sdfc alone.
/// # Errors
///
/// [`MeasureError::Scene`] for a failure of the scene or the machine;
/// [`MeasureError::Inexpressible`] if the interpreter cannot hold the scene.
pub fn count_faults(
    scene: &Scene,
    name: &str,
    gpu: &Gpu,
    size: [u32; 2],
) -> Result<FaultRow, MeasureError> {
    let program = Program { material: None, seen_material: None, ..scene.program().clone() };
    let frame = FrameValues::defaults(scene.params());
    let view = View::new(&program, &frame, scene.bounds_at(&frame), size)?;
    let reference = reference(&program, &frame, &view)?;
    let units = baseline::units(scene.graph(), &frame);
    let units = units.map_err(|Inexpressible(why)| MeasureError::Inexpressible(why))?;
    let draw = |(name, field, method)| {
        let (tables, uniforms) = match field {
            FieldSource::Units | FieldSource::Tape => (&units.tables[..], Vec::new()),
            FieldSource::Scene | FieldSource::Distance => {
                (&[][..], uniform_values(&program, &frame))
            }
        };
        let shader = benchmark_module(&program, method, field)?;
        let pipeline = Pipeline::with_tables(gpu, shader, uniforms.len(), tables)?;
        let options = RenderOptions::default();
        let drawn = pipeline.render(&view, &uniforms, &options, &mut no_progress)?;
        Ok(compared(name, &drawn.image, &reference))
    };
    let variants = VARIANTS.into_iter().map(draw).collect::<Result<_, MeasureError>>()?;
    let compared = edges(&reference).iter().filter(|edge| !**edge).count();
    Ok(FaultRow { scene: name.to_owned(), size, compared, variants })
}

/// Draws the reference on the CPU in f64, by sphere tracing with small steps. It shares only the
/// formula with the shader.
fn reference(program: &Program, frame: &FrameValues, view: &View) -> Result<Image, MeasureError> {
    let (epsilon, steps) = (view.epsilon * REFERENCE_PART, REFERENCE_STEPS);
    let view = View { epsilon, steps, ..view.clone() };
    let scene = CpuScene::new(program)?;
    let options = RenderOptions::default();
    Ok(scene.render_in::<f64>(&view, frame, Method::Sphere, &options, &mut no_progress)?.image)
}

fn compared(name: &'static str, image: &Image, reference: &Image) -> FaultVariant {
    let mut found = FaultVariant { name, ..FaultVariant::default() };
    let (mut compared, mut evaluations) = (0usize, 0u64);
    let pairs = image.pixels().iter().zip(reference.pixels()).zip(edges(reference));
    for ((pixel, right), edge) in pairs {
        evaluations += u64::from(pixel.evaluations);
        if edge {
            continue;
        }
        compared += 1;
        match [pixel, right].map(|pixel| pixel.status == HIT) {
            [false, false] => continue,
            [false, true] => found.missed += 1,
            [true, false] => found.false_hits += 1,
            [true, true] => {
                let width = reference.pixel_width(right.depth);
                let off = |channel: usize| {
                    let [a, b] = [pixel, right].map(|pixel| linear_to_srgb8(pixel.color[channel]));
                    a.abs_diff(b) > COLOR_STEPS
                };
                // NaN is not near.
                let near = (pixel.depth - right.depth).abs() <= width;
                match (near, (0..3).any(off)) {
                    (false, _) => found.misplaced += 1,
                    (true, true) => found.miscolored += 1,
                    (true, false) => {}
                }
            }
        }
    }
    let wrong = found.missed + found.false_hits + found.misplaced + found.miscolored;
    found.wrong = wrong as f64 / compared.max(1) as f64;
    found.evals_per_pixel = evaluations as f64 / image.pixels().len().max(1) as f64;
    found
}
