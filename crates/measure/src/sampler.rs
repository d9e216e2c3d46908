//! Draws a view with one ray method and returns the end and the normal of each ray.

use std::borrow::Cow;

use sdfc::{Error, Marched, Method, Scene};
use sdfc_codegen::normals_module;
use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;
use sdfc_march::PixelBlock;
use sdfc_render::{Gpu, HIT, MISS, Pipeline, RenderOptions, View, no_progress, uniform_values};

use crate::metrics::{PixelSample, Status};
use crate::normals::Normal;

/// A ray method that is ready to be compared with the oracle.
#[derive(Debug)]
pub struct Sampler<'s> {
    program: Cow<'s, Program>,
    pipeline: Pipeline,
}

impl<'s> Sampler<'s> {
    /// Makes a ray method ready to be compared with the oracle.
    ///
    /// The shader has no lights and no materials; it writes the normals that they would use.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`], [`Error::Codegen`], [`Error::Render`].
    pub fn new(scene: &'s Scene, gpu: &Gpu, method: Method) -> Result<Self, Error> {
        let Marched { program, method, .. } = scene.marched(method);
        let shader = normals_module(&program, method.definition())?;
        let pipeline = Pipeline::new(gpu, shader, program.uniforms.len())?;
        Ok(Self { program, pipeline })
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
        let drawn = self.pipeline.render(view, &uniforms, &options, &mut no_progress)?;
        Ok(drawn.image.pixels().iter().map(sample).collect())
    }
}

fn sample(pixel: &PixelBlock) -> PixelSample {
    // The layout that `normals.wgsl` writes.
    let [x, y, z, u] = pixel.color.map(f64::from);
    let v = f64::from(f32::from_bits(pixel.evaluations));
    PixelSample {
        status: status(pixel),
        t: f64::from(pixel.depth),
        evaluations: pixel.primary_evaluations,
        normal: Some(Normal { point: [x, y, z], direction: folded([u, v]) }),
    }
}

/// Decodes a direction from octahedral coordinates.
fn folded([u, v]: [f64; 2]) -> [f64; 3] {
    let up = 1.0 - u.abs() - v.abs();
    if up < 0.0 {
        [(1.0 - v.abs()).copysign(u), (1.0 - u.abs()).copysign(v), up]
    } else {
        [u, v, up]
    }
}

/// Returns how the ray of a pixel ended.
pub(crate) fn status(pixel: &PixelBlock) -> Status {
    match pixel.status {
        HIT => Status::Hit,
        MISS => Status::Miss,
        _ => Status::Capped,
    }
}

#[cfg(test)]
mod tests {
    use super::folded;

    #[test]
    fn octahedral_decoding_inverts_encoding() {
        for [x, y, z] in
            [[1.0, 2.0, 5.0], [-3.0, 1.0, -2.0], [0.5, -1.0, -9.0], [0.0, 0.0, -1.0f64]]
        {
            let size = x.abs() + y.abs() + z.abs();
            let [u, v] = [x / size, y / size];
            let turned = [(1.0 - v.abs()).copysign(u), (1.0 - u.abs()).copysign(v)];
            let back = folded(if z < 0.0 { turned } else { [u, v] });
            assert!([x, y, z].iter().zip(back).all(|(a, b)| (a / size - b).abs() < 1e-15));
        }
    }
}
