//! Measures a scene.

use std::ops::ControlFlow;

use sdfc_graph::eval::FrameValues;
use sdfc_mesh::{Measurements, Progress};

use crate::error::Error;
use crate::scene::Scene;

/// Options of [`Scene::measure`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeasureOptions {
    /// The volume is measured to this fraction of itself; the center of mass, the extent, the
    /// clearance and the thinnest wall to this fraction of the longest side of the scene's bounds.
    pub relative: f64,
    /// Values of params, time and frame; `None` takes the defaults at time 0.
    pub frame: Option<FrameValues>,
    /// The most boxes that are examined.
    pub max_cells: u64,
}

impl Default for MeasureOptions {
    fn default() -> Self {
        let relative = sdfc_mesh::MeasureOptions::RELATIVE;
        Self { relative, frame: None, max_cells: sdfc_mesh::MeasureOptions::MAX_CELLS }
    }
}

impl MeasureOptions {
    /// The default options: an error of a thousandth.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets how exact the measurements are.
    #[must_use]
    pub fn relative(self, relative: f64) -> Self {
        Self { relative, ..self }
    }

    /// Sets the values of params, time and frame.
    #[must_use]
    pub fn frame(self, frame: FrameValues) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// Sets the most boxes that are examined.
    #[must_use]
    pub fn max_cells(self, max_cells: u64) -> Self {
        Self { max_cells, ..self }
    }

    /// Returns the options for solids in a box.
    pub(crate) fn within(&self, bounds: [[f64; 3]; 2]) -> sdfc_mesh::MeasureOptions {
        sdfc_mesh::MeasureOptions::new(bounds).relative(self.relative).max_cells(self.max_cells)
    }
}

impl Scene {
    /// Volume, center of mass, inertia and extent of the scene, as intervals that are proven to
    /// hold the truth, and an estimate of its area. [`Self::left_out`] lists solids that it
    /// ignores.
    ///
    /// The work runs on all cores. It stops if `progress` breaks.
    ///
    /// ```
    /// use sdfc::{Compiler, MeasureOptions};
    /// use std::ops::ControlFlow;
    ///
    /// let scene = Compiler::new().compile("ball.sdf", "sphere(1)")?;
    /// let options = MeasureOptions::new().relative(0.01);
    /// let found = scene.measure(&options, &mut |_| ControlFlow::Continue(()))?;
    /// let volume = 4.0 / 3.0 * std::f64::consts::PI;
    /// assert!(found.volume[0] <= volume && volume <= found.volume[1]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::Mesh`]: the scene draws nothing, is empty or has no limit, the fraction is not
    /// above 0, or `progress` stopped the work.
    pub fn measure(
        &self,
        options: &MeasureOptions,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Measurements, Error> {
        self.needs_solids("a measurement")?;
        let frame = options.frame.clone().unwrap_or_else(|| self.defaults());
        let limited = self.limited(&frame)?;
        let options = options.within(limited.bounds);
        Ok(sdfc_mesh::measure(&limited.program, &frame, &options, progress)?)
    }
}
