//! Measures the thinnest wall of a scene.

use std::ops::ControlFlow;

use sdfc_mesh::{Progress, Wall};

use crate::error::Error;
use crate::measure::MeasureOptions;
use crate::scene::Scene;

impl Scene {
    /// The thinnest wall of the scene, as an interval that is proven to hold the truth, and where
    /// it is. [`Self::left_out`] lists solids that it ignores.
    ///
    /// The wall at a point of the surface is the segment from there along the inward normal to
    /// where the solid ends, if the surface there faces away: see [`Wall`]. The thickness is
    /// measured to a fraction of the longest side of the scene's bounds.
    ///
    /// ```
    /// use sdfc::{Compiler, MeasureOptions};
    /// use std::ops::ControlFlow;
    ///
    /// let scene = Compiler::new().compile("shell.sdf", "sphere(1) - sphere(0.75)")?;
    /// let options = MeasureOptions::new().relative(0.01);
    /// let wall = scene.thinnest_wall(&options, &mut |_| ControlFlow::Continue(()))?;
    /// let thickness = wall.thickness.unwrap_or_default();
    /// assert!(thickness[0] <= 0.25 && 0.25 <= thickness[1]);
    /// assert_eq!(wall.undecided, 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`Scene::measure`].
    pub fn thinnest_wall(
        &self,
        options: &MeasureOptions,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Wall, Error> {
        self.needs_solids("a measurement")?;
        let frame = options.frame.clone().unwrap_or_else(|| self.defaults());
        let limited = self.limited(&frame)?;
        let options = options.within(limited.bounds);
        Ok(sdfc_mesh::thinnest_wall(&limited.program, &frame, &options, progress)?)
    }
}
