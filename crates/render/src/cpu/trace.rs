//! Marching rays on the CPU, several at a time.

mod auto;
pub(super) mod copies;
mod descent;
mod group;
mod interval;
mod limits;
mod march;
mod projection;
mod rays;
mod solve;

use super::cells::Cell;
use super::method::CpuMethod;
use super::pre_intersection::PreIntersection;
use super::ray::{Ray, Real};
use crate::image::{CAPPED, HIT, MISS};

pub(super) use limits::Limits;
pub(super) use rays::trace;

/// A sample of `auto` within this fraction of the tolerance is a hit.
const HIT_FRACTION: f64 = 0.00390625;

/// The result of a traced ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trace<'c, T> {
    pub(super) t: T,
    /// One of `MISS`, `HIT`, `CAPPED`.
    pub(super) status: u16,
    pub(super) evaluations: u32,
    /// The least ratio of the distance from the ray to the distance along it; infinite if it is not
    /// recorded.
    pub(super) clearance: T,
    /// The position of that ratio.
    pub(super) closest: T,
    /// True if the ray passed a stretch without a proof that it is free (`interval`).
    pub(super) unproven: bool,
    /// The cell of a hit, if it is known.
    pub(super) cell: Option<&'c Cell>,
}

impl<T: Real> Trace<'_, T> {
    /// The result of a ray that was not traced.
    pub(super) fn untraced() -> Self {
        let (t, clearance) = (T::constant(f64::NAN), T::constant(f64::INFINITY));
        let closest = T::constant(0.0);
        Self { t, status: MISS, evaluations: 0, clearance, closest, unproven: false, cell: None }
    }
}

/// A ray while it is marched.
#[derive(Clone, Copy)]
struct Walk<T> {
    whole: Ray<T>,
    known: PreIntersection<T>,
    /// The ray from the start of its march; positions are counted from there.
    ray: Ray<T>,
    /// The end of the march.
    end: T,
    t: T,
    evaluations: u32,
    clearance: T,
    closest: T,
    /// The last position whose gradients were followed, and the way to the surface.
    projection: (T, T),
    /// The last position, and the distance there.
    before: (T, T),
    /// The last position outside and the first one inside, with the distances there (`auto`,
    /// `interval`).
    outside: Option<(T, T)>,
    inside: Option<(T, T)>,
    /// The step from the last position outside, and the running mean of the field's slope (`auto`).
    stride: T,
    slope: T,
    /// True if the last position outside is nearer to a surface than the tolerance (`auto`).
    close: bool,
    /// Length of the next segment to examine, and whether it is part of a longer one (`interval`).
    segment: T,
    shortened: bool,
    /// The end of the segment from the last position outside whose bounds the ray waits for
    /// (`interval`).
    pending: Option<T>,
    /// How steep the field has been of late, and whether a stretch was passed without a proof
    /// (`interval`).
    steepness: T,
    unproven: bool,
}

/// What a ray towards a light passes.
#[derive(Clone, Copy)]
struct Passing<T> {
    /// Its position along the ray, and its distance from the ray.
    along: T,
    aside: T,
    /// The width of the penumbra's cone there.
    width: T,
}

/// The width of a penumbra's cone at a position of a ray, for a sharpness of 1. A light with a
/// place is a point, so the cone closes there.
pub(super) fn cone_width<T: Real>(ray: &Ray<T>, along: T, ends_at_light: bool) -> T {
    if ends_at_light { along * (T::constant(1.0) - along.div(ray.t_max)) } else { along }
}

/// The decision after a sample or bounds of the field.
enum Next<T> {
    At(T),
    Hit(T),
    /// Bounds of the field are needed, from the last position outside to here.
    Bounds(T),
}

impl<T: Real> Walk<T> {
    fn new(ray: Ray<T>, known: PreIntersection<T>) -> Self {
        let zero = T::constant(0.0);
        Self {
            whole: ray,
            known,
            ray: ray.between([known.start, known.end]),
            end: known.end - known.start,
            t: zero,
            evaluations: 0,
            clearance: T::constant(f64::INFINITY),
            closest: zero,
            projection: (zero, zero),
            before: (zero, zero),
            outside: None,
            inside: None,
            stride: zero,
            slope: T::constant(-1.0),
            close: false,
            segment: ray.t_max,
            shortened: false,
            pending: None,
            steepness: T::constant(1.0),
            unproven: false,
        }
    }

    /// A march along a part of a ray.
    fn along(ray: Ray<T>, [from, to]: [T; 2]) -> Self {
        Self { t: from, end: to, ..Self::new(ray, PreIntersection::nothing(&ray)) }
    }

    fn result(&self, t: T, status: u16) -> Trace<'static, T> {
        let evaluations = self.evaluations + self.known.evaluations;
        let Self { clearance, closest, unproven, .. } = *self;
        Trace { t, status, evaluations, clearance, closest, unproven, cell: None }
    }

    /// The result of a ray that has hit nothing on its march; a position that is NaN stays NaN.
    fn without_hit(&self) -> Trace<'static, T> {
        let t_max = self.whole.t_max;
        match self.known.hit(&self.whole) {
            Some(met) if self.t > self.end => self.result(met, HIT),
            Some(_) | None if self.t <= t_max => self.result(t_max, MISS),
            Some(_) | None => self.result(self.t, MISS),
        }
    }

    /// Takes the distance at the current position: either the ray has ended, or it has moved, or it
    /// waits for bounds.
    fn take_sample(
        &mut self,
        distance: T,
        limits: &Limits<T>,
        has_bounds: bool,
    ) -> Option<Trace<'static, T>> {
        self.evaluations += limits.method.evaluations_per_sample();
        let next = match limits.method {
            CpuMethod::Sphere if distance < limits.epsilon => Next::Hit(self.t),
            CpuMethod::Sphere => Next::At(self.t + distance),
            CpuMethod::Auto => self.auto(distance, limits),
            CpuMethod::Interval => self.interval(distance, limits, has_bounds),
        };
        self.follow(next, limits)
    }

    /// Takes the lower bound that the ray waits for.
    fn take_bound(&mut self, least: T, limits: &Limits<T>) -> Option<Trace<'static, T>> {
        let next = self.bounded(least, limits);
        self.follow(next, limits)
    }

    /// Moves on, unless the ray has ended.
    fn follow(&mut self, next: Next<T>, limits: &Limits<T>) -> Option<Trace<'static, T>> {
        self.pending = None;
        if self.unproven && limits.ends_unproven {
            return Some(self.result(self.known.start + self.t, CAPPED));
        }
        match next {
            Next::Hit(t) => return Some(self.result(self.known.start + t, HIT)),
            Next::At(t) => self.t = t,
            Next::Bounds(end) => {
                self.pending = Some(end);
                return None;
            }
        }
        // A position that is NaN ends the ray too.
        self.ended(self.inside.is_some() || self.t <= self.end, limits)
    }

    /// The result of a ray that has hit nothing yet, if it is not `within` its interval or has run
    /// out of steps.
    fn ended(&self, within: bool, limits: &Limits<T>) -> Option<Trace<'static, T>> {
        if !within {
            Some(self.without_hit())
        } else if self.evaluations
            >= limits.method.step_budget_factor().saturating_mul(limits.steps)
        {
            Some(self.result(self.known.start + self.t, CAPPED))
        } else {
            None
        }
    }

    /// What the ray passes between the last position and this one. The distances there are the
    /// radii of spheres; they intersect in a circle around the ray, whose radius is taken for the
    /// distance of what lies there, if it lies between. Spheres that do not intersect tell nothing
    /// of what is between them.
    fn passing(&mut self, here: T, ends_at_light: bool) -> Option<Passing<T>> {
        let ((last, before), zero) = (self.before, T::constant(0.0));
        self.before = (self.t, here);
        let step = self.t - last;
        if step <= zero {
            return None;
        }
        let back = T::constant(0.5) * (step + (here * here - before * before).div(step));
        let (along, aside) = match back {
            back if back <= zero || step > here + before => (self.t, here),
            back if back >= step => (last, before),
            back => (self.t - back, (here * here - back * back).max(zero).sqrt()),
        };
        let width = cone_width(&self.whole, along, ends_at_light);
        (width > zero).then_some(Passing { along, aside, width })
    }

    /// Records the clearance of the ray at what it passes.
    fn record_clearance(&mut self, Passing { along, aside, width }: Passing<T>) {
        let ratio = aside.div(width);
        if ratio < self.clearance {
            (self.clearance, self.closest) = (ratio, along);
        }
    }

    /// The distance from the surface below which a sample is a hit.
    fn hit_within(&self, near: T) -> T {
        hit_within(&self.ray, self.t, near)
    }

    fn record(&mut self, distance: T) {
        if distance < T::constant(0.0) {
            self.inside = Some((self.t, distance));
        } else {
            self.outside = Some((self.t, distance));
        }
    }

    /// The next position between one outside and one inside, once there are both.
    fn false_position(&self, hit: T) -> Option<Next<T>> {
        let ((last, above), (first, below)) = (self.outside?, self.inside?);
        // The zero of a line through both samples, but within the middle 8 tenths.
        let part = above.div(above - below).clamp(T::constant(0.1), T::constant(0.9));
        let next = last + part * (first - last);
        Some(if first - last < hit { Next::Hit(next) } else { Next::At(next) })
    }
}

/// The distance from the surface below which a point of a ray is a hit, given its tolerance.
fn hit_within<T: Real>(ray: &Ray<T>, t: T, near: T) -> T {
    (T::constant(HIT_FRACTION) * near).max(ray.rounding(t))
}
