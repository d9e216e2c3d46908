//! The box of a shape: derived by rules, then tightened by search where a rule lost precision.

use rustc_hash::FxHashSet;

use super::deriver::{Deriver, RED_ZONE, STACK_STEP};
use super::zone::Zone;
use crate::node::{NodeId, ShapeId};
use crate::shape::Shape;

/// Shapes of more parts than this are not tightened if their box is bounded: a search of 32
/// evaluations, all that it could afford, hardly moves a face.
const MOST_TIGHTENED: usize = 512;

impl Deriver<'_> {
    pub(super) fn corners(&mut self, shape: ShapeId) -> [NodeId; 2] {
        let zone = self.tight_zone(shape);
        let axes = zone.axes.map(|[lo, hi]| {
            let (lowest, highest) = (self.range(lo).lo(), self.range(hi).hi());
            [self.per_frame(lo, lowest), self.per_frame(hi, highest)]
        });
        let dim = self.graph.shape(shape).dim;
        [0, 1].map(|side| self.vector(dim, axes.map(|ends| ends[side])))
    }

    /// A box around the points where a shape's field is not above 0, tightened if a rule lost
    /// precision.
    fn tight_zone(&mut self, shape: ShapeId) -> Zone {
        if let Some(&known) = self.memo.tightened.get(&shape) {
            return known;
        }
        let zone = match self.moved(shape) {
            Some(zone) => zone,
            None => self.tightened(shape),
        };
        self.memo.tightened.insert(shape, zone);
        zone
    }

    fn tightened(&mut self, shape: ShapeId) -> Zone {
        let zero = self.graph.number(0.0);
        let zone = self.shape_zone(shape, zero);
        if zone.tight {
            return zone;
        }
        let start = zone.axes.map(|[lo, hi]| [self.range(lo).lo(), self.range(hi).hi()]);
        let width = self.graph.shape(shape).dim.point_type().width();
        let is_closed = start[..width].iter().flatten().all(|end| end.is_finite());
        if is_closed && self.is_large(shape) {
            return zone;
        }
        let region = self.searched_within(shape, start);
        let found = Zone::of_numbers(self.graph, region);
        zone.overlap(self.graph, found)
    }

    /// The box of a shape that is another shape, moved or scaled along the axes: derived from the
    /// other shape's box. Copies and material changes need no search of their own.
    fn moved(&mut self, shape: ShapeId) -> Option<Zone> {
        let Shape { formula, level, dim, contract, .. } = *self.graph.shape(shape);
        let (child, at) = self.graph.as_sample(formula)?;
        let to = self.graph.shape(child).dim;
        if contract.bounds.is_some() || dim != to {
            return None;
        }
        let rows = self.affine(at, level);
        if !self.is_along_axes(&rows, dim) {
            return None;
        }
        let zone = stacker::maybe_grow(RED_ZONE, STACK_STEP, || self.tight_zone(child));
        Some(self.preimage(zone, &rows, dim, to))
    }

    /// True if the shape has so many parts that a search cannot afford to tighten its box.
    fn is_large(&self, shape: ShapeId) -> bool {
        let mut seen = FxHashSet::default();
        let mut left = vec![shape];
        while let Some(shape) = left.pop() {
            if seen.insert(shape) {
                left.extend(&self.graph.shape(shape).children);
            }
            if seen.len() > MOST_TIGHTENED {
                return true;
            }
        }
        false
    }
}
