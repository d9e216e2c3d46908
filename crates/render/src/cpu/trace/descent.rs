//! Rays through the octree: groups of neighbours, cell by cell from front to back.
//!
//! In each cell the field lies between two linear functions. They tell, without an evaluation, most
//! rays that hit nothing there, and for the others where the surface may be. If bounds of the
//! gradient show that the field only falls along the ray, there is at most one surface, which a few
//! secants find. Only the other rays are marched through the cell by the method.

use std::ops::ControlFlow;

use sdfc_graph::eval::{Packet, vectorized};

use super::group::{Bounds, GROUP, Group};
use super::march::{Fields, march_segments, march_some};
use super::solve::{Candidate, Search};
use super::{Limits, Trace, hit_within};
use crate::cpu::cells::{Beam, Cell, Cells, Cube};
use crate::cpu::method::CpuMethod;
use crate::cpu::pre_intersection::PreIntersection;
use crate::cpu::ray::{Batch, LANES, Ray, Real};
use crate::image::{CAPPED, HIT, MISS};

/// Packets that an instruction computes at a time.
const WIDTH: usize = 4;
/// Relative rounding error of slopes.
const ROUNDING: f64 = 1e-6;

/// Traces rays; the result has their order. All of `known` is without a result where there is none.
pub(super) fn descend<'c, T: Real>(
    cells: &'c Cells<'_>,
    mut range: Option<&mut Batch<'_, T>>,
    rays: &[Ray<T>],
    known: Option<&[PreIntersection<T>]>,
    limits: &Limits<T>,
) -> Vec<Trace<'c, T>> {
    let mut traces = Vec::with_capacity(rays.len());
    let (mut work, mut buffer, mut undecided) = (Work::new(), Vec::new(), Vec::new());
    for (rays, first) in rays.chunks(GROUP).zip((0..).step_by(GROUP)) {
        let known = known.map(|known| &known[first..first + rays.len()]);
        let mut group = Group::new(rays, known);
        // The octree need not contain rays that were reflected more than once.
        for index in (0..rays.len()).filter(|&index| !cells.surround(&rays[index])) {
            group.leave_undecided(index);
        }
        sample_starts(cells, &mut group);
        for octant in group.octants() {
            let bounds = group.choose(octant);
            let mut descent = Descent {
                group: &mut group,
                bounds,
                octant,
                cells,
                range: range.as_deref_mut(),
                limits,
                work: &mut work,
                buffer,
            };
            cells.visit(&mut descent);
            buffer = descent.buffer;
        }
        undecided.extend(group.undecided.iter().map(|index| first + index));
        traces.append(&mut group.traces);
    }
    march_some(cells, range, rays, known, limits, &undecided, &mut traces);
    traces
}

/// Ends rays that start inside or on a surface, or where the field is undefined: bounds do not tell
/// this.
fn sample_starts<T: Real>(cells: &Cells<'_>, group: &mut Group<'_, '_, T>) {
    let zero = T::constant(0.0);
    // Camera rays often have one origin.
    let (mut points, mut starts) = (Vec::new(), Vec::with_capacity(group.len()));
    for index in (0..group.len()).filter(|&index| group.marches(index)) {
        let point = group.point(index, zero);
        if points.last() != Some(&point) {
            points.push(point);
        }
        starts.push((index, points.len() - 1));
    }
    let values = cells.values(&points);
    for (index, point) in starts {
        group.traces[index].evaluations += 1;
        if values[point].is_nan() {
            group.finish(index, T::constant(f64::NAN), MISS, None);
        } else if values[point] <= 0.0 {
            group.finish(index, zero, HIT, None);
        }
    }
}

/// The rays of a group that may hit a surface in a cell.
struct Work<T> {
    /// By the index of a ray in the group: the part of the ray in which the surface may be, the
    /// slope of the linear function along the ray, and its value at the origin.
    from: [T; GROUP],
    to: [T; GROUP],
    slope: [T; GROUP],
    at_origin: [T; GROUP],
    is_open: [bool; GROUP],
    /// The indices of rays that may hit a surface.
    open: Vec<usize>,
    /// The indices of those that the method marches.
    rest: Vec<usize>,
    search: Search<T>,
}

impl<T: Real> Work<T> {
    fn new() -> Self {
        let zeros = [T::constant(0.0); GROUP];
        Self {
            from: zeros,
            to: zeros,
            slope: zeros,
            at_origin: zeros,
            is_open: [false; GROUP],
            open: Vec::with_capacity(GROUP),
            rest: Vec::with_capacity(GROUP),
            search: Search::new(),
        }
    }
}

/// Rays of one octant on their way through the octree.
struct Descent<'d, 'c, 'g, 'w, 'r, T> {
    group: &'d mut Group<'g, 'c, T>,
    bounds: Bounds,
    octant: u8,
    cells: &'d Cells<'d>,
    range: Option<&'w mut Batch<'r, T>>,
    limits: &'d Limits<T>,
    work: &'d mut Work<T>,
    /// The memory of evaluators.
    buffer: Vec<Packet<T, LANES>>,
}

impl<'c, T: Real> Beam<'c> for Descent<'_, 'c, '_, '_, '_, T> {
    fn first_child(&self) -> usize {
        usize::from(self.octant)
    }

    fn passes(&self, cube: &Cube, margin: f64) -> bool {
        self.bounds.pass(cube, margin)
    }

    fn visit(&mut self, cell: &'c Cell) -> ControlFlow<()> {
        self.clip(cell);
        if self.work.open.is_empty() {
            return ControlFlow::Continue(());
        }
        self.classify(cell);
        self.search(cell);
        self.march(cell);
        if self.group.is_done() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl<'c, T: Real> Descent<'_, 'c, '_, '_, '_, T> {
    /// Finds the rays that may hit a surface in a cell by linear bounds of the field, and where.
    fn clip(&mut self, cell: &Cell) {
        let bounds = CellBounds::new(cell);
        vectorized(
            #[inline(always)]
            || bounds.clip(self.group, self.work),
        );
        self.work.open.clear();
        let is_open = self.work.is_open.iter().take(self.group.len()).enumerate();
        self.work.open.extend(is_open.filter_map(|(index, is_open)| is_open.then_some(index)));
    }

    /// Sorts the rays by how the field changes along them in the cell: a search for those along
    /// which it falls, nothing for those along which it rises, and all others.
    fn classify(&mut self, cell: &Cell) {
        let (group, zero) = (&*self.group, T::constant(0.0));
        let Work { from, to, slope, at_origin, open, rest, search, .. } = &mut *self.work;
        rest.clear();
        search.clear();
        let Some(gradient) = cell.gradient(self.cells.frame()) else {
            rest.extend(open.iter().filter(|&&index| group.marches(index)));
            return;
        };
        let ends = [0, 1, 2].map(|axis| {
            let ends = [gradient[axis].lo(), gradient[axis].hi()].map(T::constant);
            if self.octant >> axis & 1 == 1 { [ends[1], ends[0]] } else { ends }
        });
        for &index in open.iter().filter(|&&index| group.marches(index)) {
            let (mut least, mut most, mut size) = (zero, zero, zero);
            for (axis, ends) in ends.iter().enumerate() {
                let [low, high] = ends.map(|end| end * group.direction[axis][index]);
                least = least + low;
                most = most + high;
                size = size + low.abs().max(high.abs());
            }
            let rounding = T::constant(ROUNDING) * size;
            if most <= zero - rounding {
                let (from, to) = (from[index], to[index]);
                let slope = slope[index];
                let guess = (zero - at_origin[index]).div(slope);
                search.push(Candidate {
                    index,
                    from,
                    to,
                    guess: if slope < zero { guess.max(from).min(to) } else { to },
                    slope: zero - slope,
                    flat: zero - most - rounding,
                    steep: zero - least + rounding,
                    error: self.limits.hit_within(&group.ray(index), from),
                });
            } else if least < rounding {
                rest.push(index);
            }
        }
    }

    /// Finds the surface along the rays on which the field falls.
    fn search(&mut self, cell: &'c Cell) {
        if self.work.search.is_empty() {
            return;
        }
        let buffer = std::mem::take(&mut self.buffer);
        let mut field = self.cells.wide_evaluator(cell, WIDTH, buffer);
        let group = &*self.group;
        self.work.search.run(&mut field, |index, t| group.point(index, t));
        self.buffer = field.into_buffer();
        for &(index, hit, evaluations) in self.work.search.found() {
            self.group.traces[index].evaluations += evaluations;
            if let Some(t) = hit {
                let status = if is_nan(t) { MISS } else { HIT };
                self.group.finish(index, t, status, Some(cell));
            }
        }
    }

    /// Marches the other rays through the cell.
    fn march(&mut self, cell: &'c Cell) {
        let Work { from, to, rest, .. } = &*self.work;
        if rest.is_empty() {
            return;
        }
        let segments: Vec<(Ray<T>, [T; 2])> =
            rest.iter().map(|&index| (self.group.ray(index), [from[index], to[index]])).collect();
        let mut fields = Fields {
            field: self.cells.evaluator(cell),
            range: self.range.as_deref_mut(),
            projection: None,
        };
        let factor = self.limits.method.step_budget_factor();
        for (&index, found) in
            rest.iter().zip(march_segments(cell, &mut fields, &segments, self.limits))
        {
            let trace = &mut self.group.traces[index];
            trace.evaluations += found.evaluations;
            trace.unproven |= found.unproven;
            let is_spent = trace.evaluations >= factor.saturating_mul(self.limits.steps);
            if found.status == HIT || is_nan(found.t) {
                self.group.finish(index, found.t, found.status, Some(cell));
            } else if found.status == CAPPED || is_spent {
                self.group.finish(index, found.t, CAPPED, None);
            }
        }
    }
}

fn is_nan<T: Real>(number: T) -> bool {
    Into::<f64>::into(number).is_nan()
}

/// The cube of a cell and linear bounds of the field in it, in the number type of rays.
struct CellBounds<T> {
    center: [T; 3],
    half: T,
    slopes: [T; 3],
    value: T,
    error: T,
}

impl<T: Real> CellBounds<T> {
    fn new(cell: &Cell) -> Self {
        let Cube { center, half } = cell.cube;
        let (value, slopes, error) = cell.linear();
        Self {
            center: center.map(T::constant),
            half: T::constant(half),
            slopes: slopes.map(T::constant),
            value: T::constant(value),
            error: T::constant(error),
        }
    }

    #[inline(always)]
    fn clip(&self, group: &Group<'_, '_, T>, work: &mut Work<T>) {
        let zero = T::constant(0.0);
        for index in 0..group.len().min(GROUP) {
            let end = group.chosen_end[index];
            let (mut enter, mut exit) = (zero, end);
            let (mut at_origin, mut slope) = (self.value, zero);
            for axis in 0..3 {
                let offset = self.center[axis] - group.origin[axis][index];
                let inverse = group.inverse[axis][index];
                let (middle, reach) = (offset * inverse, self.half * inverse.abs());
                enter = enter.max(middle - reach);
                exit = exit.min(middle + reach);
                at_origin = at_origin - self.slopes[axis] * offset;
                slope = slope + self.slopes[axis] * group.direction[axis][index];
            }
            // Rounded outwards, so that no part of the ray lies between two cells.
            let nudge = T::constant(ROUNDING) * (group.distance[index] + exit);
            let from = (enter - nudge).max(zero);
            let to = (exit + nudge).min(end);
            let [first, last] = [from, to].map(|t| at_origin + slope * t - self.error);
            // The lower bound is 0 here.
            let root = (self.error - at_origin).div(slope).max(from).min(to);
            let (is_first_free, is_last_free) = (first > zero, last > zero);
            work.from[index] = if is_first_free { root } else { from };
            work.to[index] = if is_last_free { root } else { to };
            work.slope[index] = slope;
            work.at_origin[index] = at_origin;
            work.is_open[index] = (from <= to) & !(is_first_free & is_last_free);
        }
    }
}

impl<T: Real> Limits<T> {
    /// The largest error of a hit.
    fn hit_within(&self, ray: &Ray<T>, t: T) -> T {
        hit_within(ray, t, self.tolerance(ray, t))
    }

    /// True if rays go through the octree in groups. Rays that record their clearance take all of
    /// their steps, and those of `sphere` and `auto` the steps of the shader.
    pub(super) fn descends(&self) -> bool {
        match self.method {
            CpuMethod::Sphere | CpuMethod::Auto => false,
            CpuMethod::Interval => !self.records_clearance,
        }
    }
}
