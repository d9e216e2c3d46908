//! The box of a shape: derived by rules, then tightened by search where a rule lost precision.

use rustc_hash::FxHashSet;

use super::deriver::{Deriver, RED_ZONE, STACK_STEP};
use super::search::Region;
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
        if zone.tight || (self.is_closed(shape, zone) && self.is_large(shape)) {
            return zone;
        }
        self.search_in(shape, zone, zero)
    }

    /// The box of an operator whose rule left it open, although all its operands have closed boxes:
    /// closed by a search, if one succeeds. The operators around it have rules that keep a closed
    /// box, such as that of a rotation, while a search of their formulas would fail. An operator
    /// with an open operand is open for that reason, and is not searched.
    pub(super) fn closed(&mut self, shape: ShapeId, zone: Zone, limit: NodeId) -> Zone {
        let children = self.graph.shape(shape).children.clone();
        if zone.tight || children.is_empty() || self.is_closed(shape, zone) || self.is_large(shape)
        {
            return zone;
        }
        let zero = self.graph.number(0.0);
        for child in children {
            let operand = self.shape_zone(child, zero);
            if !self.is_closed(child, operand) {
                return zone;
            }
        }
        self.search_in(shape, zone, limit).loose()
    }

    fn search_in(&mut self, shape: ShapeId, zone: Zone, limit: NodeId) -> Zone {
        let start = self.region(zone);
        let region = self.searched_within(shape, start, limit);
        let found = Zone::of_numbers(self.graph, region);
        zone.overlap(self.graph, found)
    }

    /// True if the box has an end on each axis of the shape.
    fn is_closed(&mut self, shape: ShapeId, zone: Zone) -> bool {
        let width = self.graph.shape(shape).dim.point_type().width();
        self.region(zone)[..width].iter().flatten().all(|end| end.is_finite())
    }

    /// The box for all values of the params.
    fn region(&mut self, zone: Zone) -> Region {
        zone.axes.map(|[lo, hi]| [self.range(lo).lo(), self.range(hi).hi()])
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
