//! Tracing rays by the way that suits them.

use super::descent::descend;
use super::march::march;
use super::{Limits, Trace};
use crate::cpu::cells::Cells;
use crate::cpu::pre_intersection::PreIntersection;
use crate::cpu::ray::{Batch, Ray, Real};

/// Traces rays; the result has their order. `known` is `None` if nothing is known of any ray. Rays
/// that record their clearance follow the gradients of `projection`, if there is one.
pub(crate) fn trace<'a, 'c, T: Real>(
    cells: &'c Cells<'_>,
    range: Option<&mut Batch<'a, T>>,
    projection: Option<&mut Batch<'a, T>>,
    rays: &[Ray<T>],
    known: Option<&[PreIntersection<T>]>,
    limits: &Limits<T>,
) -> Vec<Trace<'c, T>> {
    if !limits.descends() {
        return march(cells, range, projection, rays, known, limits);
    }
    descend(cells, range, rays, known, limits)
}
