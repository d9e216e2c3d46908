//! Gradients of the field at hits.

use glam::DVec3;
use sdfc_graph::eval::{Dual, Evaluator, Packet};

use super::cells::{Cell, Cells, by_tape};
use super::ray::{Batch, LANES, Real, packed_from};

/// The cost of an operation on dual numbers, in operations of the gradient's own tape.
const DUAL_COST: usize = 4;
/// The gradient of the whole field, which takes this many operations.
#[derive(Clone)]
pub(super) struct Gradient<'a, T> {
    pub(super) whole: Batch<'a, T>,
    pub(super) operations: usize,
}

impl<T: Real> Gradient<'_, T> {
    /// The gradients at points, in their order: of the shorter field in a cell by dual numbers
    /// where that takes less time, else of the whole field. `cell` gives the cell of a point, if it
    /// is known.
    pub(super) fn at<'c>(
        &mut self,
        cells: &'c Cells<'_>,
        points: &[[T; 3]],
        cell: impl Fn(usize) -> Option<&'c Cell>,
    ) -> Vec<DVec3> {
        let mut gradients = vec![DVec3::NAN; points.len()];
        let mut others = Vec::new();
        let cell =
            |index: usize| cell(index).unwrap_or_else(|| cells.at(points[index].map(Into::into)));
        by_tape(points.len(), cell, |cell, indices| {
            if cell.operations().saturating_mul(DUAL_COST) < self.operations {
                by_duals(&mut cells.evaluator(cell), points, indices, &mut gradients);
            } else {
                others.extend_from_slice(indices);
            }
        });
        // A kink or a pole, where the whole gradient has rules of its own.
        let is_open = |gradient: &DVec3| !gradient.is_finite() || *gradient == DVec3::ZERO;
        others.extend((0..points.len()).filter(|&index| is_open(&gradients[index])));
        others.sort_unstable();
        others.dedup();
        for group in others.chunks(LANES) {
            let roots = self.whole.eval(packed_from(group.iter().map(|&index| points[index])));
            let Some(&[x, y, z, _]) = roots.first() else { return gradients };
            read([x, y, z], group, &mut gradients);
        }
        gradients
    }
}

fn by_duals<T: Real>(
    field: &mut Evaluator<'_, Dual<Packet<T, LANES>>>,
    points: &[[T; 3]],
    indices: &[usize],
    gradients: &mut [DVec3],
) {
    for group in indices.chunks(LANES) {
        let point = packed_from(group.iter().map(|&index| points[index]));
        read(field.scalar(Dual::point(point)).partials, group, gradients);
    }
}

/// Writes packed vectors to some places.
fn read<T: Real>(vectors: [Packet<T, LANES>; 3], places: &[usize], result: &mut [DVec3]) {
    let [x, y, z] = vectors;
    for (lane, &place) in places.iter().enumerate() {
        result[place] = DVec3::from([x, y, z].map(|Packet(lanes)| lanes[lane].into()));
    }
}
