//! What one ray method makes of a view: of each pixel how its ray ended, where, and with which normal.

use sdfc_accuracy::{PixelSample, Status};
use sdfc_codegen::normals_module;
use sdfc_graph::eval::FrameValues;
use sdfc_march::{Method, PixelBlock};
use sdfc_render::{Gpu, HIT, MISS, Pipeline, RenderOptions, View, uniform_values, unwatched};

use crate::{Error, Scene};

/// A ray method made ready to be compared with the oracle: see [`Scene::sampler`].
#[derive(Debug)]
pub struct Sampler<'s> {
    scene: &'s Scene,
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
        let shader = normals_module(self.drawn(), method)?;
        let pipeline = Pipeline::new(gpu, shader, self.drawn().uniforms.len())?;
        Ok(Sampler { scene: self, pipeline })
    }
}

impl Sampler<'_> {
    /// Every pixel of a view, row by row.
    ///
    /// # Errors
    ///
    /// [`Error::Render`].
    pub fn samples(&self, view: &View, frame: &FrameValues) -> Result<Vec<PixelSample>, Error> {
        let uniforms = uniform_values(self.scene.drawn(), frame);
        let options = RenderOptions::default();
        let drawn = self.pipeline.render(view, &uniforms, &options, &mut unwatched)?;
        Ok(drawn.image.pixels().iter().map(sample).collect())
    }
}

fn sample(pixel: &PixelBlock) -> PixelSample {
    let [x, y, z, _] = pixel.color.map(f64::from);
    PixelSample {
        status: match pixel.status {
            HIT => Status::Hit,
            MISS => Status::Miss,
            _ => Status::Capped,
        },
        t: f64::from(pixel.depth),
        evaluations: pixel.primary_evaluations,
        normal: Some([x, y, z]),
    }
}
