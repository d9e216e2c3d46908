//! Tracing rays by the way that suits them.

use super::descent::descend;
use super::march::march;
use super::{Limits, Trace};
use crate::cpu::cells::Cells;
use crate::cpu::pre_intersection::PreIntersection;
use crate::cpu::ray::{Batch, Ray, Real};

/// Traces rays; the result has their order. `known` is `None` if nothing is known of any ray.
pub(crate) fn trace<'c, T: Real>(
    cells: &'c Cells<'_>,
    range: Option<&mut Batch<'_, T>>,
    rays: &[Ray<T>],
    known: Option<&[PreIntersection<T>]>,
    limits: &Limits<T>,
) -> Vec<Trace<'c, T>> {
    if !limits.descends() {
        return march(cells, range, rays, known, limits);
    }
    descend(cells, range, rays, known, limits)
}
