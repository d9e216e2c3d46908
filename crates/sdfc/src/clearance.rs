//! Measures the distance between two named solids of a scene.

use std::ops::ControlFlow;

use sdfc_analyze::prepare;
use sdfc_graph::{Dim, Scene as ShapeScene, ShapeId};
use sdfc_mesh::{Clearance, MeshError, Progress};

use crate::derived_bounds::DerivedBounds;
use crate::error::Error;
use crate::measure::MeasureOptions;
use crate::scene::Scene;

impl Scene {
    /// The smallest distance between two solids that the scene names with `let` at top level, as
    /// an interval that is proven to hold the truth, and whether they collide.
    ///
    /// The distance is measured to a fraction of the longest side of a box around both.
    ///
    /// ```
    /// use sdfc::{Compiler, MeasureOptions};
    /// use std::ops::ControlFlow;
    ///
    /// let text = "let a = sphere(1)\nlet b = sphere(1).translate(x: 2.5)\na | b";
    /// let scene = Compiler::new().compile("balls.sdf", text)?;
    /// let options = MeasureOptions::new();
    /// let found = scene.clearance(["a", "b"], &options, &mut |_| ControlFlow::Continue(()))?;
    /// assert!(found.distance[0] <= 0.5 && 0.5 <= found.distance[1]);
    /// assert_eq!(found.collides, Some(false));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::UnknownSolid`]; otherwise those of [`Scene::measure`].
    pub fn clearance(
        &self,
        names: [&str; 2],
        options: &MeasureOptions,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Clearance, Error> {
        let frame = options.frame.clone().unwrap_or_else(|| self.defaults());
        let mut programs = Vec::new();
        let mut is_certified = true;
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for name in names {
            let root = Some(self.solid(name)?);
            let graph = self.elaborated.scene.graph.clone();
            let params = self.elaborated.scene.params.clone();
            let scene = ShapeScene { graph, root, params, ..ShapeScene::default() };
            let own = DerivedBounds::of(&scene).and_then(|bounds| bounds.at(&frame));
            let [lo, hi] = own.ok_or(MeshError::NothingDrawn)?;
            if (0..3).any(|axis| lo[axis] > hi[axis]) {
                return Err(MeshError::Empty.into());
            }
            let prepared = prepare(&scene)?;
            is_certified &= prepared.report.uncertified.is_empty();
            programs.push(prepared.program);
            bounds[0] = [0, 1, 2].map(|axis| bounds[0][axis].min(lo[axis]));
            bounds[1] = [0, 1, 2].map(|axis| bounds[1][axis].max(hi[axis]));
        }
        let [first, second] = &programs[..] else { return Err(Error::NothingDrawn) };
        let options = options.within(bounds);
        let solids = [first, second];
        Ok(sdfc_mesh::clearance(solids, &frame, &options, is_certified, progress)?)
    }

    /// Returns the solid that the scene gives a name.
    fn solid(&self, name: &str) -> Result<ShapeId, Error> {
        let graph = &self.elaborated.scene.graph;
        let is_solid = |id: &ShapeId| graph.shape(*id).dim == Dim::Three;
        let named = |id: ShapeId| Some((id, graph.shape(id).name.as_deref()?));
        let solids: Vec<(ShapeId, &str)> =
            graph.shape_ids().filter(is_solid).filter_map(named).collect();
        let found = solids.iter().find(|(_, known)| *known == name);
        found.map(|(id, _)| *id).ok_or_else(|| {
            let known = solids.iter().map(|(_, name)| (*name).to_owned()).collect();
            Error::UnknownSolid { name: name.to_owned(), known }
        })
    }
}
