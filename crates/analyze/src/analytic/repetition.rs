//! Copies of shapes, of which few are sampled at a place.
//!
//! A shape that says `copies` is the least of samples and of a value than which nothing that is not sampled is nearer. So within a ball
//! of that radius about a ray's origin it is what is sampled there: where a cell's index jumps, other copies are sampled, but those
//! in the ball are the same. A copy is moved rigidly while the index keeps its value.

use sdfc_graph::{Dim, ExpandError, Shape, ShapeId};

use crate::analytic::copies::{Copied, taken_apart};
use crate::analytic::intervals::{Known, joined};
use crate::analytic::split::{Parts, Pass, Place, least};

impl Pass<'_> {
    /// Where a ray is inside of the copies that a shape samples at the ray's origin, and how far that is all there is.
    pub(super) fn copies(
        &mut self,
        shape: ShapeId,
        place: &Place,
    ) -> Result<Option<Known>, ExpandError> {
        let Shape { dim, level, contract, .. } = *self.graph.shape(shape);
        if !contract.copies || dim != Dim::Three || !place.is_of(level) {
            return Ok(None);
        }
        let Ok(copies) = taken_apart(self.graph, shape) else { return Ok(None) };
        let mut known = Vec::new();
        for copied in copies.samples {
            let Parts { closed, open } = self.copied(&copied, place, level)?;
            if !open.is_empty() {
                return Ok(None);
            }
            known.extend(closed.into_iter().map(|part| part.known));
        }
        let mut limits = Vec::with_capacity(copies.limits.len());
        for limit in copies.limits {
            limits.push(self.expander.node(self.graph, limit, &place.points())?);
        }
        let Some(limit) = least(self.graph, limits) else { return Ok(None) };
        let reach = Some(self.graph.mul(place.scale, limit));
        known.push(Known { spans: Vec::new(), reach });
        Ok(Some(joined(self.graph, known)).filter(Known::is_short))
    }

    /// The parts of a copy.
    fn copied(&mut self, copied: &Copied, place: &Place, level: u16) -> Result<Parts, ExpandError> {
        let (points, inside) = (place.points(), usize::from(self.graph.shape(copied.child).level));
        let own_direction = self.graph.point(level + 1, Dim::Three);
        let direction = copied.direction(self.graph, own_direction);
        let inner = Place {
            outer: points[..inside].to_vec(),
            point: self.expander.node(self.graph, copied.at, &points)?,
            direction: self.expander.node(self.graph, direction, &points)?,
            scale: place.scale,
        };
        self.shape(copied.child, &inner)
    }
}
