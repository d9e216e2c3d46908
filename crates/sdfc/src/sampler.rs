//! What one ray method makes of a view: of each pixel how its ray ended, where, and with which normal.

use std::borrow::Cow;

use sdfc_accuracy::{PixelSample, Status};
use sdfc_codegen::normals_module;
use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;
use sdfc_march::{Method, PixelBlock};
use sdfc_render::{Gpu, HIT, MISS, Pipeline, RenderOptions, View, uniform_values, unwatched};

use crate::marched::with_stretches;
use crate::{Error, Scene};

/// A ray method made ready to be compared with the oracle: see [`Scene::sampler`].
#[derive(Debug)]
pub struct Sampler<'s> {
    program: Cow<'s, Program>,
    pipeline: Pipeline,
}

impl Scene {
    /// Makes a ray method ready to be compared with the oracle. Its shader has no lights and no materials, but the normals
    /// that they would see.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`], [`Error::Codegen`], [`Error::Render`].
    pub fn sampler(&self, gpu: &Gpu, method: &Method) -> Result<Sampler<'_>, Error> {
        let marched_by = self.marched_by(method.name);
        // A method that is not of the table may have the name of one that is.
        let other = sdfc_march::method(marched_by).filter(|other| other.name != method.name);
        let program = with_stretches(self.drawn(), marched_by);
        let shader = normals_module(&program, other.unwrap_or(method))?;
        let pipeline = Pipeline::new(gpu, shader, program.uniforms.len())?;
        Ok(Sampler { program, pipeline })
    }
}

impl Sampler<'_> {
    /// Every pixel of a view, row by row.
    ///
    /// # Errors
    ///
    /// [`Error::Render`].
    pub fn samples(&self, view: &View, frame: &FrameValues) -> Result<Vec<PixelSample>, Error> {
        let uniforms = uniform_values(&self.program, frame);
        let options = RenderOptions::default();
        let drawn = self.pipeline.render(view, &uniforms, &options, &mut unwatched)?;
        Ok(drawn.image.pixels().iter().map(sample).collect())
    }
}

fn sample(pixel: &PixelBlock) -> PixelSample {
    let [x, y, z, _] = pixel.color.map(f64::from);
    PixelSample {
        status: status(pixel),
        t: f64::from(pixel.depth),
        evaluations: pixel.primary_evaluations,
        normal: Some([x, y, z]),
    }
}

/// How the ray of a pixel ended.
pub(crate) fn status(pixel: &PixelBlock) -> Status {
    match pixel.status {
        HIT => Status::Hit,
        MISS => Status::Miss,
        _ => Status::Capped,
    }
}
