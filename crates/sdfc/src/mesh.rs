//! Makes meshes and contours of a scene.

use std::ops::ControlFlow;

use sdfc_graph::eval::FrameValues;
use sdfc_mesh::{Contour, Mesh, Plane, Progress};

use crate::derived_bounds::Corners;
use crate::error::Error;
use crate::limited::Limited;
use crate::scene::Scene;

/// How exact a mesh or a contour is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeshSize {
    /// A distance in scene units.
    Length(f64),
    /// A fraction of the longest side of the scene's bounds.
    Relative(f64),
}

/// Options of [`Scene::mesh`] and [`Scene::contour`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshOptions {
    /// The greatest distance between mesh and surface, or contour and section.
    pub error: MeshSize,
    /// Values of params, time and frame; `None` takes the defaults at time 0.
    pub frame: Option<FrameValues>,
    /// The most cells that are examined.
    pub max_cells: u64,
    /// True if contours may have circular arcs; by default they are made of lines alone. Meshes
    /// ignore it.
    pub has_arcs: bool,
}

impl Default for MeshOptions {
    fn default() -> Self {
        let max_cells = sdfc_mesh::MeshOptions::MAX_CELLS;
        Self { error: MeshSize::Relative(1e-3), frame: None, max_cells, has_arcs: false }
    }
}

impl MeshOptions {
    /// The default options: an error of a thousandth of the scene's size.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the greatest distance between mesh and surface.
    #[must_use]
    pub fn error(self, error: MeshSize) -> Self {
        Self { error, ..self }
    }

    /// Sets the values of params, time and frame.
    #[must_use]
    pub fn frame(self, frame: FrameValues) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// Sets the most cells that are examined.
    #[must_use]
    pub fn max_cells(self, max_cells: u64) -> Self {
        Self { max_cells, ..self }
    }

    /// Sets whether contours may have circular arcs.
    #[must_use]
    pub fn has_arcs(self, has_arcs: bool) -> Self {
        Self { has_arcs, ..self }
    }

    /// Returns the options for what has bounds.
    fn within(&self, bounds: Corners) -> sdfc_mesh::MeshOptions {
        let error = match self.error {
            MeshSize::Length(length) => length,
            MeshSize::Relative(fraction) => {
                let side = |axis: usize| bounds[1][axis] - bounds[0][axis];
                fraction * side(0).max(side(1)).max(side(2))
            }
        };
        sdfc_mesh::MeshOptions::new(bounds, error).max_cells(self.max_cells).has_arcs(self.has_arcs)
    }
}

impl Scene {
    /// A closed mesh of the scene's surface, with a certificate. [`Self::left_out`] lists solids
    /// that it ignores.
    ///
    /// The work runs on all cores. It stops if `progress` breaks.
    ///
    /// ```
    /// use sdfc::{Compiler, MeshOptions, MeshSize};
    /// use std::ops::ControlFlow;
    ///
    /// let scene = Compiler::new().compile("ball.sdf", "sphere(1)")?;
    /// let options = MeshOptions::new().error(MeshSize::Length(0.05));
    /// let mesh = scene.mesh(&options, &mut |_| ControlFlow::Continue(()))?;
    /// assert!(mesh.certificate.is_proven);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::Planar`]; [`Error::Mesh`]: the scene is empty or has no limit, the error is too
    /// small or greater than the longest side of the scene's bounds, the mesh needs too many cells,
    /// or `progress` stopped the work.
    pub fn mesh(
        &self,
        options: &MeshOptions,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Mesh, Error> {
        self.needs_solids("a mesh")?;
        let frame = options.frame.clone().unwrap_or_else(|| self.defaults());
        let Limited { program, bounds, .. } = self.limited(&frame)?;
        Ok(sdfc_mesh::mesh(&program, &frame, &options.within(bounds), progress)?)
    }

    /// The closed paths around the section of the scene by a plane, with a certificate. Regions lie
    /// in the plane z = 0. [`Self::left_out`] lists what is ignored.
    ///
    /// The work runs on all cores. It stops if `progress` breaks.
    ///
    /// ```
    /// use sdfc::{Compiler, MeshOptions, Plane};
    /// use std::ops::ControlFlow;
    ///
    /// let scene = Compiler::new().compile("tube.sdf", "sphere(1) - sphere(0.5)")?;
    /// let plane = Plane::new([0.0, 0.0, 1.0], 0.1).expect("a normal");
    /// let mut progress = |_| ControlFlow::Continue(());
    /// let contour = scene.contour(plane, &MeshOptions::new(), &mut progress)?;
    /// assert!(contour.certificate.is_proven);
    /// assert_eq!(contour.paths.iter().filter(|path| path.is_hole).count(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::Mesh`]: the same as for a mesh, or the plane meets no inside.
    /// [`Error::PlaneOfRegions`].
    pub fn contour(
        &self,
        plane: Plane,
        options: &MeshOptions,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Contour, Error> {
        if self.is_planar() && Some(plane) != Plane::new([0.0, 0.0, 1.0], 0.0) {
            return Err(Error::PlaneOfRegions);
        }
        let frame = options.frame.clone().unwrap_or_else(|| self.defaults());
        let Limited { program, bounds, .. } = self.limited(&frame)?;
        Ok(sdfc_mesh::contour(&program, &frame, plane, &options.within(bounds), progress)?)
    }
}
