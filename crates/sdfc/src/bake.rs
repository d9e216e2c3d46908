//! Samples a scene on a grid.

use std::ops::ControlFlow;

use sdfc_graph::eval::FrameValues;
use sdfc_mesh::{DistanceGrid, Progress};

use crate::error::Error;
use crate::scene::Scene;

/// Options of [`Scene::bake`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BakeOptions {
    /// Number of samples along the longest side of the scene's bounds.
    pub resolution: usize,
    /// Values of params, time and frame; `None` takes the defaults at time 0.
    pub frame: Option<FrameValues>,
}

impl Default for BakeOptions {
    fn default() -> Self {
        Self { resolution: sdfc_mesh::BakeOptions::RESOLUTION, frame: None }
    }
}

impl BakeOptions {
    /// The default options: 64 samples along the longest side.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the number of samples along the longest side.
    #[must_use]
    pub fn resolution(self, resolution: usize) -> Self {
        Self { resolution, ..self }
    }

    /// Sets the values of params, time and frame.
    #[must_use]
    pub fn frame(self, frame: FrameValues) -> Self {
        Self { frame: Some(frame), ..self }
    }
}

impl Scene {
    /// Samples of the field at the points of a grid, with a proven error of interpolation.
    /// [`Self::left_out`] lists solids that it ignores.
    ///
    /// The work runs on all cores. It stops if `progress` breaks.
    ///
    /// ```
    /// use sdfc::{BakeOptions, Compiler};
    /// use std::ops::ControlFlow;
    ///
    /// let scene = Compiler::new().compile("ball.sdf", "sphere(1)")?;
    /// let options = BakeOptions::new().resolution(16);
    /// let grid = scene.bake(&options, &mut |_| ControlFlow::Continue(()))?;
    /// assert_eq!((grid.shape, grid.values.len()), ([16; 3], 16 * 16 * 16));
    /// assert!(grid.surface_error < grid.interpolation_error);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::Mesh`]: the scene draws nothing, is empty or has no limit, the grid has too few or
    /// too many samples, or `progress` stopped the work.
    pub fn bake(
        &self,
        options: &BakeOptions,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<DistanceGrid, Error> {
        self.needs_solids("a grid of samples")?;
        let frame = options.frame.clone().unwrap_or_else(|| self.defaults());
        let limited = self.limited(&frame)?;
        let options = sdfc_mesh::BakeOptions::new(limited.bounds)
            .resolution(options.resolution)
            .lipschitz(limited.is_certified.then_some(1.0));
        Ok(sdfc_mesh::bake(&limited.program, &frame, &options, progress)?)
    }
}
