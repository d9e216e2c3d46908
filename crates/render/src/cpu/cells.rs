//! The cells of space that the rays and points of a picture share.
//!
//! Each cell holds a shorter tape of the field, from one evaluation in affine arithmetic: it leaves
//! out the operands that cannot matter in the cell's cube. So a large formula is examined once for
//! each cell and not for each ray. Values at points do not change.

mod cache;
mod cell;
mod octree;
mod sight;

use std::sync::Arc;

use sdfc_graph::eval::{Evaluator, FrameValues, Number, Packet, Tape};

use super::ray::{LANES, Real, packed_from};
use crate::view::View;
pub(super) use cache::CachedField;
pub(super) use cell::Cell;
use octree::Octree;
use sight::Sight;

/// Smaller fields have one cell.
const MIN_OPERATIONS: usize = 200;

/// The cells of one field in one picture.
#[derive(Debug)]
pub(super) struct Cells<'a> {
    frame: &'a FrameValues,
    /// All of space.
    whole: Cell,
    octree: Option<(Arc<Octree>, Sight)>,
}

impl<'a> Cells<'a> {
    /// All of space as one cell.
    fn one(tape: &Arc<Tape>, frame: &'a FrameValues) -> Self {
        Self { frame, whole: Cell::everything(tape), octree: None }
    }

    /// The cells of an octree.
    fn of(
        octree: Arc<Octree>,
        tape: &Arc<Tape>,
        frame: &'a FrameValues,
        view: &View,
        proves: bool,
    ) -> Self {
        Self { octree: Some((octree, Sight::new(view, proves))), ..Self::one(tape, frame) }
    }

    /// The smallest cell around a point; all of space for a point outside of the octree.
    pub(super) fn at(&self, point: [f64; 3]) -> &Cell {
        match &self.octree {
            Some((octree, sight)) => octree.at(sight, point),
            None => &self.whole,
        }
    }

    /// The field in a cell, with registers.
    pub(super) fn evaluator<'c, N: Number>(&self, cell: &'c Cell) -> Evaluator<'c, N> {
        cell.tape.prepare(self.frame)
    }

    /// The values of the field at points, in their order.
    pub(super) fn values<T: Real>(&self, points: &[[T; 3]]) -> Vec<f64> {
        let mut values = vec![f64::NAN; points.len()];
        self.by_cell(points, |cell, indices| {
            let mut field = self.evaluator::<Packet<T, LANES>>(cell);
            for group in indices.chunks(LANES) {
                let group_points = group.iter().map(|&index| points[index]);
                let Packet(found) = field.scalar(packed_from(group_points));
                for (&index, value) in group.iter().zip(found) {
                    values[index] = value.into();
                }
            }
        });
        values
    }

    /// Calls a function for each tape, with a cell that has it and the indices of its points.
    pub(super) fn by_cell<T: Real>(
        &self,
        points: &[[T; 3]],
        mut each: impl FnMut(&Cell, &[usize]),
    ) {
        let cells: Vec<_> = points.iter().map(|point| self.at(point.map(Into::into))).collect();
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_unstable_by_key(|&index| (cells[index].id(), index));
        for indices in order.chunk_by(|&a, &b| cells[a].id() == cells[b].id()) {
            if let Some(&first) = indices.first() {
                each(cells[first], indices);
            }
        }
    }
}
