//! Gradients of the field at hits.

use glam::DVec3;
use sdfc_graph::eval::{Dual, Packet};

use super::cells::{Cell, Cells};
use super::ray::{Batch, Real, values_at};

/// The cost of an operation on dual numbers, in operations of the gradient's own tape.
const DUAL_COST: usize = 4;
/// The number of dual numbers evaluated together: as many bytes as those of a packet of rays.
const DUAL_LANES: usize = 2;

/// The gradient of the whole field, which takes this many operations.
#[derive(Clone)]
pub(super) struct Gradient<'a, T> {
    pub(super) whole: Batch<'a, T>,
    pub(super) operations: usize,
}

impl<T: Real> Gradient<'_, T> {
    /// The gradients at points, in their order: of the shorter field in a cell by dual numbers
    /// where that takes less time, else of the whole field.
    pub(super) fn at(&mut self, cells: &Cells<'_>, points: &[[T; 3]]) -> Vec<DVec3> {
        let mut gradients = vec![DVec3::NAN; points.len()];
        let mut others = Vec::new();
        cells.by_cell(points, |cell, indices| {
            if cell.operations().saturating_mul(DUAL_COST) < self.operations {
                by_duals(cells, cell, points, indices, &mut gradients);
            } else {
                others.extend_from_slice(indices);
            }
        });
        // A kink or a pole, where the whole gradient has rules of its own.
        let is_open = |gradient: &DVec3| !gradient.is_finite() || *gradient == DVec3::ZERO;
        others.extend((0..points.len()).filter(|&index| is_open(&gradients[index])));
        others.sort_unstable();
        others.dedup();
        let rest: Vec<[T; 3]> = others.iter().map(|&index| points[index]).collect();
        for (index, roots) in others.into_iter().zip(values_at(&mut self.whole, &rest)) {
            let [x, y, z, _] = roots.first().copied().unwrap_or_default();
            gradients[index] = DVec3::new(x, y, z);
        }
        gradients
    }
}

fn by_duals<T: Real>(
    cells: &Cells<'_>,
    cell: &Cell,
    points: &[[T; 3]],
    indices: &[usize],
    gradients: &mut [DVec3],
) {
    let mut field = cells.evaluator::<Packet<Dual, DUAL_LANES>>(cell);
    for group in indices.chunks(DUAL_LANES) {
        let mut filled = [[0.0; 3]; DUAL_LANES];
        for (point, &index) in filled.iter_mut().zip(group) {
            *point = points[index].map(Into::into);
        }
        let duals = filled.map(Dual::point);
        let point = std::array::from_fn(|axis| Packet(duals.map(|dual| dual[axis])));
        let Packet(found) = field.scalar(point);
        for (&index, Dual { partials, .. }) in group.iter().zip(found) {
            gradients[index] = DVec3::from(partials);
        }
    }
}
