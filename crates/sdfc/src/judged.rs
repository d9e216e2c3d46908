//! What one ray method makes of a view, against the oracle.

use sdfc_accuracy::{Metrics, Truth, compare};
use sdfc_codegen::render_module;
use sdfc_graph::eval::FrameValues;
use sdfc_render::{Gpu, Pipeline, RenderOptions, View, uniform_values, unwatched};

use crate::accuracy::samples;
use crate::{Error, Scene};

impl Scene {
    /// Draws each view with a ray method as it is used unless told otherwise, and compares the picture with the
    /// truth of that view. The shader is compiled once for all.
    ///
    /// # Errors
    ///
    /// [`Error::NothingDrawn`], [`Error::Codegen`] for an unknown method too, [`Error::Render`].
    pub fn judged(
        &self,
        gpu: &Gpu,
        method: &str,
        views: &[(View, FrameValues, Truth)],
    ) -> Result<Vec<Metrics>, Error> {
        let oracle = self.oracle()?;
        let shader = render_module(&self.program, method)?;
        let pipeline = Pipeline::new(gpu, shader, self.program.uniforms.len())?;
        let judge = |(view, frame, truth): &(View, FrameValues, Truth)| {
            let uniforms = uniform_values(&self.program, frame);
            let options = RenderOptions::default();
            let drawn = pipeline.render(view, &uniforms, &options, &mut unwatched)?;
            Ok(compare(&oracle, frame, truth, &samples(&drawn.image)))
        };
        views.iter().map(judge).collect()
    }
}
