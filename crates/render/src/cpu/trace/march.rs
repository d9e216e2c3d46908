//! Marching rays by the steps of their method.

use sdfc_graph::eval::Packet;

use super::projection::project;
use super::{Limits, Passing, Trace, Walk};
use crate::cpu::cells::{Cell, Cells};
use crate::cpu::pre_intersection::PreIntersection;
use crate::cpu::ray::{Batch, LANES, Ray, Real, packed_from};

/// A ray in a cell.
#[derive(Clone, Copy)]
struct Crossing<'c, T> {
    cell: &'c Cell,
    /// Index of the ray.
    index: usize,
    /// The positions between which the ray is in the cell.
    span: [T; 2],
}

/// Rays in cells with one tape, by what they wait for.
struct Crossings<'c, T> {
    samples: Vec<Crossing<'c, T>>,
    bounds: Vec<Crossing<'c, T>>,
}

/// The functions of rays in cells with one tape.
pub(super) struct Fields<'c, 'w, 'r, T> {
    pub(super) field: Batch<'c, T>,
    /// Bounds of the field on a segment.
    pub(super) range: Option<&'w mut Batch<'r, T>>,
    /// The gradient and the value of the whole field, if soft shadows follow its gradients.
    pub(super) projection: Option<&'w mut Batch<'r, T>>,
}

/// Marches those of the rays that have these indices, and replaces their results.
pub(super) fn march_some<'c, T: Real>(
    cells: &'c Cells<'_>,
    range: Option<&mut Batch<'_, T>>,
    rays: &[Ray<T>],
    known: Option<&[PreIntersection<T>]>,
    limits: &Limits<T>,
    indices: &[usize],
    traces: &mut [Trace<'c, T>],
) {
    let chosen: Vec<Ray<T>> = indices.iter().map(|&index| rays[index]).collect();
    let known: Option<Vec<_>> =
        known.map(|known| indices.iter().map(|&index| known[index]).collect());
    let found = march(cells, range, None, &chosen, known.as_deref(), limits);
    for (&index, found) in indices.iter().zip(found) {
        let evaluations = traces[index].evaluations + found.evaluations;
        traces[index] = Trace { evaluations, ..found };
    }
}

/// Marches rays along all of their length; the result has their order. Rays in one cell are marched
/// together.
pub(super) fn march<'a, T: Real>(
    cells: &Cells<'_>,
    mut range: Option<&mut Batch<'a, T>>,
    mut projection: Option<&mut Batch<'a, T>>,
    rays: &[Ray<T>],
    known: Option<&[PreIntersection<T>]>,
    limits: &Limits<T>,
) -> Vec<Trace<'static, T>> {
    let mut traces = vec![Trace::untraced(); rays.len()];
    let walk = |(index, ray): (usize, &Ray<T>)| {
        Walk::new(*ray, known.map_or_else(|| PreIntersection::nothing(ray), |known| known[index]))
    };
    let mut walks: Vec<Walk<T>> = rays.iter().enumerate().map(walk).collect();
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
            let mut fields = Fields {
                field: cells.evaluator(cell),
                range: range.as_deref_mut(),
                projection: projection.as_deref_mut(),
            };
            cross(crossings, &mut walks, &mut fields, limits, |index, walk, ended| {
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

/// Marches rays in a cell, each from one position to another one. A ray that hits nothing there is
/// a miss.
pub(super) fn march_segments<T: Real>(
    cell: &Cell,
    fields: &mut Fields<'_, '_, '_, T>,
    segments: &[(Ray<T>, [T; 2])],
    limits: &Limits<T>,
) -> Vec<Trace<'static, T>> {
    let mut traces = vec![Trace::untraced(); segments.len()];
    let mut walks: Vec<Walk<T>> =
        segments.iter().map(|&(ray, segment)| Walk::along(ray, segment)).collect();
    let span = [f64::NEG_INFINITY, f64::INFINITY].map(T::constant);
    let crossings: Vec<_> =
        (0..segments.len()).map(|index| Crossing { cell, index, span }).collect();
    cross(&crossings, &mut walks, fields, limits, |index, _, ended| {
        if let Some(ended) = ended {
            traces[index] = ended;
        }
        None
    });
    traces
}

/// Marches rays in cells with one tape until they end or leave these cells. When a ray ends or
/// leaves its cell, `next` returns its next crossing of a cell with this tape.
fn cross<'c, T: Real>(
    crossings: &[Crossing<'c, T>],
    walks: &mut [Walk<T>],
    fields: &mut Fields<'_, '_, '_, T>,
    limits: &Limits<T>,
    mut next: impl FnMut(usize, &mut Walk<T>, Option<Trace<'static, T>>) -> Option<Crossing<'c, T>>,
) {
    let has_bounds = fields.range.is_some();
    let mut waiting =
        Crossings { samples: crossings.iter().rev().copied().collect(), bounds: Vec::new() };
    let mut group = Vec::with_capacity(LANES);
    while let Some(is_sample) = waiting.take(&mut group) {
        let results =
            if is_sample { fields.samples(&group, walks) } else { fields.bounds(&group, walks) };
        if is_sample && limits.records_clearance {
            fields.record_clearances(&group, walks, &results, limits);
        }
        for (crossing, result) in group.drain(..).zip(results).rev() {
            let (walk, [enter, exit]) = (&mut walks[crossing.index], crossing.span);
            let ended = if is_sample {
                walk.take_sample(result, limits, has_bounds)
            } else {
                walk.take_bound(result, limits)
            };
            // A position that is NaN has ended the ray.
            let leaves = ended.is_some() || walk.t < enter || walk.t >= exit;
            if !leaves {
                waiting.put(crossing, walk);
            } else if let Some(crossing) = next(crossing.index, walk, ended) {
                waiting.put(crossing, &walks[crossing.index]);
            }
        }
    }
}

impl<'c, T: Real> Crossings<'c, T> {
    fn put(&mut self, crossing: Crossing<'c, T>, walk: &Walk<T>) {
        match walk.pending {
            Some(_) => self.bounds.push(crossing),
            None => self.samples.push(crossing),
        }
    }

    /// Takes the rays that are evaluated next; returns whether they wait for samples. Bounds cost
    /// more, so they wait until they fill a packet.
    fn take(&mut self, group: &mut Vec<Crossing<'c, T>>) -> Option<bool> {
        let is_sample = !self.samples.is_empty() && self.bounds.len() < LANES;
        let queue = if is_sample { &mut self.samples } else { &mut self.bounds };
        group.extend(queue.drain(queue.len().saturating_sub(LANES)..));
        (!group.is_empty()).then_some(is_sample)
    }
}

impl<T: Real> Fields<'_, '_, '_, T> {
    /// The field where each ray is.
    fn samples(&mut self, group: &[Crossing<'_, T>], walks: &[Walk<T>]) -> [T; LANES] {
        let walks = group.iter().map(|crossing| &walks[crossing.index]);
        let Packet(distances) =
            self.field.scalar(packed_from(walks.map(|walk| walk.ray.at(walk.t))));
        distances
    }

    /// Records the clearance of rays, from the distances where they are.
    fn record_clearances(
        &mut self,
        group: &[Crossing<'_, T>],
        walks: &mut [Walk<T>],
        distances: &[T],
        limits: &Limits<T>,
    ) {
        let mut passings: Vec<(usize, Passing<T>)> = Vec::with_capacity(group.len());
        for (&Crossing { index, .. }, &distance) in group.iter().zip(distances) {
            let passing = walks[index].passing(distance, limits.ends_at_light);
            passings.extend(passing.map(|passing| (index, passing)));
        }
        if let Some(projection) = &mut self.projection {
            project(projection, walks, &mut passings, limits);
        }
        for (index, passing) in passings {
            walks[index].record_clearance(passing);
        }
    }

    /// The lower bounds for which rays wait.
    fn bounds(&mut self, group: &[Crossing<'_, T>], walks: &[Walk<T>]) -> [T; LANES] {
        let segments = group.iter().map(|crossing| walks[crossing.index].segment_to_bound());
        let Some(range) = &mut self.range else { return [T::constant(f64::NAN); LANES] };
        let [starts, ends] = [0, 1].map(|end| packed_from(segments.clone().map(|s| s[end])));
        let Packet(least) = range.eval_ray(starts, ends)[0][0];
        least
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
