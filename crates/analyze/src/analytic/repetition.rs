//! The intervals of repeated shapes, of which a point samples only a few copies.
//!
//! A shape with the clause `copies` is the minimum of samples and of a limit, which bounds the
//! distance to every other copy from below. Within a ball of that radius around a ray's origin, the
//! shape equals the copies that are sampled at the origin: where the index of a cell jumps, other
//! copies are sampled, but those within the ball stay the same. A copy is moved rigidly while the
//! index is constant.

use sdfc_graph::{Dim, ExpandError, Shape, ShapeId};

use crate::analytic::copies::{CopySample, split_copies};
use crate::analytic::intervals::{RayIntervals, union};
use crate::analytic::operands::Operands;
use crate::analytic::split::{LocalRay, Splitter};
use crate::shapes::minimum;

impl Splitter<'_> {
    /// The intervals of the copies that a shape samples at the ray's origin, and the distance
    /// within which there are no others. Returns `None` for other shapes.
    pub(super) fn repetition(
        &mut self,
        shape: ShapeId,
        ray: &LocalRay,
    ) -> Result<Option<RayIntervals>, ExpandError> {
        let Shape { dim, level, contract, .. } = *self.graph.shape(shape);
        if !contract.copies || dim != Dim::Three || !ray.has_level(level) {
            return Ok(None);
        }
        let Ok(copies) = split_copies(self.graph, shape) else { return Ok(None) };
        let mut all = Vec::new();
        for sample in copies.samples {
            let Operands { analytic, marched } = self.split_copy(&sample, ray, level)?;
            if !marched.is_empty() {
                return Ok(None);
            }
            all.extend(analytic.into_iter().map(|operand| operand.intervals));
        }
        let mut limits = Vec::with_capacity(copies.limits.len());
        for limit in copies.limits {
            limits.push(self.expander.node(self.graph, limit, &ray.points())?);
        }
        let Some(limit) = minimum(self.graph, limits) else { return Ok(None) };
        let reach = Some(self.graph.mul(ray.scale, limit));
        all.push(RayIntervals { list: Vec::new(), reach });
        Ok(Some(union(self.graph, all)).filter(RayIntervals::is_short))
    }

    /// Splits one copy.
    fn split_copy(
        &mut self,
        sample: &CopySample,
        ray: &LocalRay,
        level: u16,
    ) -> Result<Operands, ExpandError> {
        let (points, inside) = (ray.points(), usize::from(self.graph.shape(sample.child).level));
        let own_direction = self.graph.point(level + 1, Dim::Three);
        let direction = sample.direction(self.graph, own_direction);
        let inner = LocalRay {
            outer: points[..inside].to_vec(),
            point: self.expander.node(self.graph, sample.at, &points)?,
            direction: self.expander.node(self.graph, direction, &points)?,
            scale: ray.scale,
        };
        self.shape(sample.child, &inner)
    }
}
