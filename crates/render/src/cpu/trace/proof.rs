//! Proofs that a part of a ray is free.

use sdfc_graph::eval::{Affine, Evaluator};

use super::limits::Limits;
use crate::cpu::cells::{Cell, Cells};
use crate::cpu::method::CpuMethod;
use crate::cpu::ray::{Ray, Real};

/// The cost of an operation on affine forms, in operations of the range.
const AFFINE_COST: usize = 8;

/// Lower bounds of the field on parts of rays, in cells with one tape.
pub(super) struct Proof<'p, 't, T> {
    /// The end of the current cell on the ray.
    pub(super) end: T,
    /// The field in the cells, in affine arithmetic.
    affine: Option<Evaluator<'p, Affine>>,
    /// Bounds of the whole field on a segment.
    range: Option<&'p mut Evaluator<'t, T>>,
    /// True if parts of rays do not end with the cell.
    is_cut_alike: bool,
    /// True if the affine form can be expected to prove something in the current cell.
    is_provable: bool,
    /// True if the affine form takes less time than the range.
    is_affine_first: bool,
}

impl<'p, 't, T: Real> Proof<'p, 't, T> {
    pub(super) fn new(
        cells: &'p Cells<'_>,
        cell: &'p Cell,
        range: Option<&'p mut Evaluator<'t, T>>,
        limits: &Limits<T>,
    ) -> Self {
        // Where a ray is sampled decides its clearance, so it is cut as in the shader.
        let is_cut_alike = limits.records_clearance && range.is_some();
        let proves = limits.method == CpuMethod::Interval && !is_cut_alike;
        let affine = proves.then(|| cells.evaluator(cell));
        let cost = cell.operations().saturating_mul(AFFINE_COST);
        let is_affine_first = range.is_none() || cost < limits.range_operations;
        let end = T::constant(f64::INFINITY);
        Self { end, affine, range, is_cut_alike, is_provable: cell.is_provable(), is_affine_first }
    }

    /// Goes on to a ray that leaves its cell at `end`.
    pub(super) fn enter(&mut self, cell: &Cell, end: T) {
        self.is_provable = cell.is_provable();
        if !self.is_cut_alike {
            self.end = end;
        }
    }

    /// True if there is anything to prove by.
    pub(super) fn is_possible(&self) -> bool {
        (self.affine.is_some() && self.is_provable) || self.range.is_some()
    }

    /// A lower bound of the field between two positions of a ray. `is_last` says that no shorter
    /// part will be tried.
    pub(super) fn least(&mut self, ray: &Ray<T>, part: [T; 2], is_last: bool) -> T {
        let zero = T::constant(0.0);
        let mut least = T::constant(f64::NEG_INFINITY);
        for is_affine in [self.is_affine_first, !self.is_affine_first] {
            let found =
                if is_affine { self.by_affine(ray, part) } else { self.by_range(ray, part) };
            least = found.map_or(least, |found| least.max(found));
            if least > zero || (found.is_some() && !is_last) {
                break;
            }
        }
        least
    }

    fn by_affine(&mut self, ray: &Ray<T>, part: [T; 2]) -> Option<T> {
        let affine = self.affine.as_mut().filter(|_| self.is_provable)?;
        let [from, to]: [f64; 2] = part.map(Into::into);
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let point = std::array::from_fn(|axis| {
            let [origin, direction] = [ray.origin, ray.direction].map(|v| v[axis].into());
            Affine::coordinate(origin + middle * direction, [half * direction, 0.0, 0.0])
        });
        let least = affine.scalar(point).range().lo();
        // Rounded to f32, it stays on its side of 0.
        Some(T::constant(least))
    }

    fn by_range(&mut self, ray: &Ray<T>, [from, to]: [T; 2]) -> Option<T> {
        let range = self.range.as_mut()?;
        Some(range.eval_ray(ray.at(from), ray.at(to))[0][0])
    }
}
