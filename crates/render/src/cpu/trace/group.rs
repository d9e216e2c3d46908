//! Groups of rays that go through the octree together.

use super::Trace;
use crate::cpu::cells::{Cell, Cube};
use crate::cpu::pre_intersection::PreIntersection;
use crate::cpu::ray::{Ray, Real};
use crate::image::{HIT, MISS};

/// The number of rays of a group: a square of pixels.
pub(super) const GROUP: usize = 256;
/// The least size of a component of a direction whose inverse is used.
const MIN_COMPONENT: f64 = 1e-20;

/// Rays that lie beside each other, and what is known of them. Positions are counted from where
/// their marches start.
pub(super) struct Group<'r, 'c, T> {
    rays: &'r [Ray<T>],
    known: Option<&'r [PreIntersection<T>]>,
    pub(super) origin: [[T; GROUP]; 3],
    pub(super) direction: [[T; GROUP]; 3],
    pub(super) inverse: [[T; GROUP]; 3],
    /// The distance of the origin from that of the scene.
    pub(super) distance: [T; GROUP],
    /// The end of the march; negative if the ray has ended.
    end: [T; GROUP],
    /// The same, but negative for rays of other octants than the chosen one.
    pub(super) chosen_end: [T; GROUP],
    /// The signs of the direction, as the index of the child of a cube.
    octant: [u8; GROUP],
    /// The results, if nothing is hit from here on.
    pub(super) traces: Vec<Trace<'c, T>>,
    /// The rays that are to be marched by themselves.
    pub(super) undecided: Vec<usize>,
}

impl<'r, 'c, T: Real> Group<'r, 'c, T> {
    /// A group of at most [`GROUP`] rays.
    pub(super) fn new(rays: &'r [Ray<T>], known: Option<&'r [PreIntersection<T>]>) -> Self {
        let zeros = [T::constant(0.0); GROUP];
        let mut group = Self {
            rays,
            known,
            origin: [zeros; 3],
            direction: [zeros; 3],
            inverse: [zeros; 3],
            distance: zeros,
            end: zeros,
            chosen_end: zeros,
            octant: [0; GROUP],
            traces: Vec::with_capacity(rays.len()),
            undecided: Vec::new(),
        };
        for (index, ray) in rays.iter().enumerate().take(GROUP) {
            let known = known.map_or_else(|| PreIntersection::nothing(ray), |known| known[index]);
            group.traces.push(without_march(&known, ray));
            let march = ray.advanced(known.start);
            let is_marched = known.must_march();
            group.end[index] = if is_marched { known.end - known.start } else { T::constant(-1.0) };
            for axis in 0..3 {
                group.origin[axis][index] = march.origin[axis];
                group.direction[axis][index] = march.direction[axis];
            }
        }
        group.derive();
        group
    }

    /// Fills the rows that follow from origins and directions.
    fn derive(&mut self) {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        let least = T::constant(MIN_COMPONENT);
        for index in 0..self.rays.len().min(GROUP) {
            let (mut octant, mut square) = (0, zero);
            for axis in 0..3 {
                let along = self.direction[axis][index];
                let is_negative = along < zero;
                octant |= u8::from(is_negative) << axis;
                let size = along.abs().max(least);
                self.inverse[axis][index] = one.div(if is_negative { zero - size } else { size });
                square = square + self.origin[axis][index] * self.origin[axis][index];
            }
            self.octant[index] = octant;
            self.distance[index] = square.sqrt();
        }
    }

    /// Number of rays.
    pub(super) fn len(&self) -> usize {
        self.rays.len()
    }

    /// The octants of the rays that march.
    pub(super) fn octants(&self) -> Vec<u8> {
        let marches = (0..self.len()).filter(|&index| self.marches(index));
        let found = marches.fold(0u8, |found, index| found | 1 << self.octant[index]);
        (0..8).filter(|octant| found >> octant & 1 == 1).collect()
    }

    /// Chooses the rays of an octant. Returns their bounds.
    pub(super) fn choose(&mut self, octant: u8) -> Bounds {
        let infinite = T::constant(f64::INFINITY);
        let none = [infinite, T::constant(0.0) - infinite];
        let (mut origin, mut inverse, mut last) = ([none; 3], [none; 3], T::constant(0.0));
        for index in 0..self.len().min(GROUP) {
            let is_chosen = self.octant[index] == octant && self.marches(index);
            self.chosen_end[index] = if is_chosen { self.end[index] } else { T::constant(-1.0) };
            if !is_chosen {
                continue;
            }
            last = last.max(self.end[index]);
            for axis in 0..3 {
                origin[axis] = extended(origin[axis], self.origin[axis][index]);
                inverse[axis] = extended(inverse[axis], self.inverse[axis][index]);
            }
        }
        let [origin, inverse] = [origin, inverse].map(|ranges| ranges.map(|r| r.map(Into::into)));
        Bounds { origin, inverse, end: last.into() }
    }

    /// True if none of the chosen rays is left.
    pub(super) fn is_done(&self) -> bool {
        let zero = T::constant(0.0);
        !self.chosen_end.iter().take(self.len()).any(|end| *end >= zero)
    }

    /// True if a ray has not ended.
    pub(super) fn marches(&self, index: usize) -> bool {
        self.end[index] >= T::constant(0.0)
    }

    /// A ray from the start of its march on.
    pub(super) fn ray(&self, index: usize) -> Ray<T> {
        match self.known {
            Some(known) => {
                let PreIntersection { start, end, .. } = known[index];
                self.rays[index].between([start, end])
            }
            None => self.rays[index],
        }
    }

    pub(super) fn point(&self, index: usize, t: T) -> [T; 3] {
        [0, 1, 2].map(|axis| self.origin[axis][index] + t * self.direction[axis][index])
    }

    /// Ends a ray that is to be marched by itself.
    pub(super) fn leave_undecided(&mut self, index: usize) {
        if self.marches(index) {
            self.finish(index, T::constant(f64::NAN), MISS, None);
            self.undecided.push(index);
        }
    }

    /// Ends a ray, in a cell if it is known.
    pub(super) fn finish(&mut self, index: usize, t: T, status: u16, cell: Option<&'c Cell>) {
        let start = self.known.map_or(T::constant(0.0), |known| known[index].start);
        let trace = &mut self.traces[index];
        (trace.t, trace.status, trace.cell) = (start + t, status, cell);
        self.end[index] = T::constant(-1.0);
        self.chosen_end[index] = T::constant(-1.0);
    }
}

/// The result of a ray whose march hits nothing.
fn without_march<T: Real>(known: &PreIntersection<T>, ray: &Ray<T>) -> Trace<'static, T> {
    let (t, status) = known.hit(ray).map_or((ray.t_max, MISS), |met| (met, HIT));
    Trace { t, status, evaluations: known.evaluations, ..Trace::untraced() }
}

/// The range, extended to a number.
fn extended<T: Real>([least, most]: [T; 2], value: T) -> [T; 2] {
    [least.min(value), most.max(value)]
}

/// Bounds of rays of one octant: their origins, the inverses of their directions, and their ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    origin: [[f64; 2]; 3],
    inverse: [[f64; 2]; 3],
    end: f64,
}

impl Bounds {
    /// True if a ray may pass a cube that is grown by a margin.
    pub(super) fn pass(&self, cube: &Cube, margin: f64) -> bool {
        let (mut enter, mut exit) = (0.0f64, self.end);
        let half = cube.half + margin;
        for axis in 0..3 {
            let ([first, last], [least, most]) = (self.origin[axis], self.inverse[axis]);
            let (lower, upper) = (cube.center[axis] - half, cube.center[axis] + half);
            // The least distance to the nearer face and the greatest one to the farther face, in
            // the direction of the rays, and the range of the inverse speed.
            let (near, far, least, most) = if most > 0.0 {
                (lower - last, upper - first, least, most)
            } else {
                (first - upper, last - lower, -most, -least)
            };
            enter = enter.max(near * if near > 0.0 { least } else { most });
            exit = exit.min(far * if far > 0.0 { most } else { least });
        }
        enter <= exit
    }
}
