//! Rays on their way through the cells of space.

use sdfc_graph::eval::{Evaluator, Packet};

use super::{Limits, Trace, Walk};
use crate::cpu::cells::{Cell, Cells};
use crate::cpu::pre_intersection::PreIntersection;
use crate::cpu::ray::{Batch, LANES, Ray, Real, packed};

/// A ray in a cell.
#[derive(Clone, Copy)]
struct Crossing<'c, T> {
    cell: &'c Cell,
    /// Index of the ray.
    index: usize,
    /// The positions between which the ray is in the cell.
    span: [T; 2],
}

/// Marches all rays; the result has their order. Rays in one cell are marched together.
pub(crate) fn trace<T: Real>(
    cells: &Cells<'_>,
    mut range: Option<&mut Evaluator<'_, T>>,
    rays: &[(Ray<T>, PreIntersection<T>)],
    limits: &Limits<T>,
) -> Vec<Trace<T>> {
    let mut traces = vec![Trace::untraced(); rays.len()];
    let mut walks: Vec<Walk<T>> = rays.iter().map(|&(ray, known)| Walk::new(ray, known)).collect();
    let mut waiting = Vec::with_capacity(rays.len());
    for (index, walk) in walks.iter().enumerate() {
        if !walk.known.must_march() {
            traces[index] = walk.without_hit();
            continue;
        }
        waiting.push(Crossing::new(cells, index, walk));
    }
    let mut onward = Vec::with_capacity(waiting.len());
    while !waiting.is_empty() {
        waiting.sort_unstable_by_key(|crossing| (crossing.cell.id(), crossing.index));
        for crossings in waiting.chunk_by(|a, b| a.cell.id() == b.cell.id()) {
            let Some(&Crossing { cell, .. }) = crossings.first() else { continue };
            let mut field = cells.evaluator(cell);
            let range = range.as_deref_mut();
            cross(crossings, &mut walks, &mut field, range, limits, |index, walk, ended| {
                if let Some(ended) = ended {
                    traces[index] = ended;
                    return None;
                }
                let crossing = Crossing::new(cells, index, walk);
                if crossing.cell.id() == cell.id() {
                    return Some(crossing);
                }
                onward.push(crossing);
                None
            });
        }
        std::mem::swap(&mut waiting, &mut onward);
        onward.clear();
    }
    traces
}

/// Marches rays in cells with one tape until they end or leave these cells. When a ray ends or
/// leaves its cell, `next` returns its next crossing of a cell with this tape. Lanes whose ray has
/// none take another ray.
fn cross<'c, T: Real>(
    crossings: &[Crossing<'c, T>],
    walks: &mut [Walk<T>],
    field: &mut Batch<'_, T>,
    mut range: Option<&mut Evaluator<'_, T>>,
    limits: &Limits<T>,
    mut next: impl FnMut(usize, &Walk<T>, Option<Trace<T>>) -> Option<Crossing<'c, T>>,
) {
    let mut waiting = crossings.iter().copied();
    let mut lanes: [Option<Crossing<'c, T>>; LANES] = std::array::from_fn(|_| waiting.next());
    let mut points = [[T::constant(0.0); 3]; LANES];
    while lanes.iter().any(Option::is_some) {
        for (point, lane) in points.iter_mut().zip(&lanes) {
            if let Some(Crossing { index, .. }) = lane {
                let walk = &walks[*index];
                *point = walk.ray.at(walk.t);
            }
        }
        let Packet(distances) = field.scalar(packed(&points));
        for (lane, distance) in lanes.iter_mut().zip(distances) {
            let Some(Crossing { index, span: [enter, exit], .. }) = *lane else { continue };
            let walk = &mut walks[index];
            let ended = walk.take_sample(distance, limits, range.as_deref_mut());
            // A position that is NaN has ended the ray.
            if ended.is_some() || walk.t < enter || walk.t >= exit {
                *lane = next(index, walk, ended).or_else(|| waiting.next());
            }
        }
    }
}

impl<'c, T: Real> Crossing<'c, T> {
    /// The crossing of the cell around the next sample of a ray.
    fn new(cells: &'c Cells<'_>, index: usize, walk: &Walk<T>) -> Self {
        let ray = [walk.ray.origin, walk.ray.direction].map(|v| v.map(Into::into));
        let cell = cells.at(walk.ray.at(walk.t).map(Into::into));
        let [enter, exit] = cell.span(ray);
        let (t, nudge): (f64, f64) = (walk.t.into(), walk.ray.rounding(walk.t).into());
        // Rounded outwards, so that each cell is left.
        let span = [enter.min(t) - nudge, exit.max(t) + nudge].map(T::constant);
        Self { index, cell, span }
    }
}
