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

use super::ray::{LANES, Ray, Real, packed_from};
use crate::view::View;
pub(super) use cache::CachedField;
pub(super) use cell::{Cell, Cube};
pub(super) use octree::Beam;
use octree::Octree;
use sight::Sight;

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

    /// Visits the cells of the octree that a beam passes and that may contain a surface, in the
    /// order of the beam.
    pub(super) fn visit<'c>(&'c self, beam: &mut impl Beam<'c>) {
        if let Some((octree, sight)) = &self.octree {
            octree.visit(sight, beam);
        }
    }

    /// True if there is an octree that contains a ray of this length.
    pub(super) fn surround<T: Real>(&self, ray: &Ray<T>) -> bool {
        let Some((octree, _)) = &self.octree else { return false };
        octree.surrounds(ray.origin.map(Into::into), ray.t_max.into())
    }

    /// The values that the field depends on.
    pub(super) fn frame(&self) -> &FrameValues {
        self.frame
    }

    /// The field in a cell, with registers for `width` packets in the memory of another evaluator.
    pub(super) fn wide_evaluator<'c, N: Number>(
        &self,
        cell: &'c Cell,
        width: usize,
        buffer: Vec<N>,
    ) -> Evaluator<'c, N> {
        cell.tape.prepare_in_buffer(self.frame, width, buffer)
    }

    /// The field in a cell, with registers.
    pub(super) fn evaluator<'c, N: Number>(&self, cell: &'c Cell) -> Evaluator<'c, N> {
        cell.tape.prepare(self.frame)
    }

    /// The values of the field at points, in their order.
    pub(super) fn values<T: Real>(&self, points: &[[T; 3]]) -> Vec<f64> {
        let mut values = vec![f64::NAN; points.len()];
        let mut cells: Vec<&Cell> = Vec::with_capacity(points.len());
        for point in points.iter().map(|point| point.map(Into::into)) {
            // Neighbours are often in one cell.
            let last = cells.last().filter(|last| last.cube.contains(point));
            cells.push(last.map_or_else(|| self.at(point), |last| *last));
        }
        by_tape(
            points.len(),
            |index| cells[index],
            |cell, indices| {
                let mut field = self.evaluator::<Packet<T, LANES>>(cell);
                for group in indices.chunks(LANES) {
                    let group_points = group.iter().map(|&index| points[index]);
                    let Packet(found) = field.scalar(packed_from(group_points));
                    for (&index, value) in group.iter().zip(found) {
                        values[index] = value.into();
                    }
                }
            },
        );
        values
    }
}

/// Calls a function for each tape, with a cell that has it and the indices below `count` of what is
/// in such cells.
pub(super) fn by_tape<'c>(
    count: usize,
    cell: impl Fn(usize) -> &'c Cell,
    mut each: impl FnMut(&'c Cell, &[usize]),
) {
    let cells: Vec<&Cell> = (0..count).map(cell).collect();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_unstable_by_key(|&index| (cells[index].id(), index));
    for indices in order.chunk_by(|&a, &b| cells[a].id() == cells[b].id()) {
        if let Some(&first) = indices.first() {
            each(cells[first], indices);
        }
    }
}
