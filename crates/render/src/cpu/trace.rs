//! Marching rays on the CPU, several at a time.

pub(super) mod copies;
mod interval;
mod limits;
mod march;

use super::method::CpuMethod;
use super::pre_intersection::PreIntersection;
use super::ray::{Ray, Real};
use crate::image::{CAPPED, HIT, MISS};

pub(super) use limits::Limits;
pub(super) use march::trace;

/// A sample of `auto` within this fraction of the tolerance is a hit.
const HIT_FRACTION: f64 = 0.00390625;
/// Weight of the last step's slope in the running mean.
const SLOPE_WEIGHT: f64 = 0.5;
/// Upper bound of a step of `auto` in distances.
const MAX_RELAXATION: f64 = 4.0;
/// Bounds of a secant step of `auto`: the distance divided by this slope, or this fraction of the
/// tolerance.
const MIN_SLOPE: f64 = 0.25;
const MIN_STEP_FRACTION: f64 = 0.25;
/// Bound of the last secant, which places the hit: the distance divided by this slope.
const MIN_FINAL_SLOPE: f64 = 0.0078125;

/// The result of a traced ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trace<T> {
    pub(super) t: T,
    /// One of `MISS`, `HIT`, `CAPPED`.
    pub(super) status: u16,
    pub(super) evaluations: u32,
    /// The least ratio of the distance from the ray to the distance along it; infinite if it is not
    /// recorded.
    pub(super) clearance: T,
    /// True if the ray passed a stretch without a proof that it is free (`interval`).
    pub(super) unproven: bool,
}

impl<T: Real> Trace<T> {
    /// The result of a ray that was not traced.
    fn untraced() -> Self {
        let (t, clearance) = (T::constant(f64::NAN), T::constant(f64::INFINITY));
        Self { t, status: MISS, evaluations: 0, clearance, unproven: false }
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

/// The decision after a sample or bounds of the field.
enum Next<T> {
    At(T),
    Hit(T),
    /// Bounds of the field are needed, from the last position outside to here.
    Bounds(T),
}

/// A part of a ray, from its current position on, and the facts that hold for the field there.
#[derive(Clone, Copy)]
struct Stretch<T> {
    /// The position up to which it holds.
    end: T,
    /// True if there is no surface.
    is_free: bool,
    /// True if the scene has bounds along segments.
    has_bounds: bool,
}

impl<T: Real> Walk<T> {
    fn new(ray: Ray<T>, known: PreIntersection<T>) -> Self {
        let zero = T::constant(0.0);
        Self {
            whole: ray,
            known,
            ray: ray.advanced(known.start),
            end: known.end - known.start,
            t: zero,
            evaluations: 0,
            clearance: T::constant(f64::INFINITY),
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

    fn result(&self, t: T, status: u16) -> Trace<T> {
        let evaluations = self.evaluations + self.known.evaluations;
        Trace { t, status, evaluations, clearance: self.clearance, unproven: self.unproven }
    }

    /// The result of a ray that has hit nothing on its march; a position that is NaN stays NaN.
    fn without_hit(&self) -> Trace<T> {
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
        stretch: &Stretch<T>,
    ) -> Option<Trace<T>> {
        self.evaluations += limits.method.evaluations_per_sample();
        if limits.records_clearance {
            self.record_clearance(distance);
        }
        let next = match limits.method {
            CpuMethod::Sphere if distance < limits.epsilon => Next::Hit(self.t),
            CpuMethod::Sphere => Next::At(self.t + distance),
            CpuMethod::Auto => self.auto(distance, limits),
            CpuMethod::Interval => self.interval(distance, limits, stretch),
        };
        self.follow(next, limits)
    }

    /// Takes the lower bound that the ray waits for.
    fn take_bound(
        &mut self,
        least: T,
        limits: &Limits<T>,
        stretch: &Stretch<T>,
    ) -> Option<Trace<T>> {
        let next = self.bounded(least, limits, stretch);
        self.follow(next, limits)
    }

    /// Moves on, unless the ray has ended.
    fn follow(&mut self, next: Next<T>, limits: &Limits<T>) -> Option<Trace<T>> {
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
    fn ended(&self, within: bool, limits: &Limits<T>) -> Option<Trace<T>> {
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

    /// Records the clearance of the ray. The distances here and at the last position are the radii
    /// of spheres; they intersect in a circle around the ray, whose radius is taken for the
    /// distance of what lies there, if it lies between. Spheres that do not intersect tell nothing
    /// of what is between them.
    fn record_clearance(&mut self, here: T) {
        let ((last, before), zero) = (self.before, T::constant(0.0));
        self.before = (self.t, here);
        let step = self.t - last;
        if step > zero {
            let back = T::constant(0.5) * (step + (here * here - before * before).div(step));
            let (along, aside) = match back {
                back if back <= zero || step > here + before => (self.t, here),
                back if back >= step => (last, before),
                back => (self.t - back, (here * here - back * back).max(zero).sqrt()),
            };
            if along > zero {
                self.clearance = self.clearance.min(aside.div(along));
            }
        }
    }

    fn auto(&mut self, distance: T, limits: &Limits<T>) -> Next<T> {
        let zero = T::constant(0.0);
        if self.evaluations == 1 && distance < zero {
            return Next::Hit(self.t);
        }
        let near = limits.tolerance(&self.ray, self.t);
        let (last, above) = self.outside.unwrap_or((self.t, zero));
        let hit = self.hit_within(near);
        // Empty spheres that do not meet may have something between them; secants are short.
        let checked = self.inside.is_none() && !self.close;
        if checked && self.stride > above + distance.max(zero) + hit {
            (self.stride, self.slope) = (above, T::constant(-1.0));
            return Next::At(last + above);
        }
        let gain = if self.stride > zero {
            (distance - above).div(self.stride)
        } else {
            T::constant(-1.0)
        };
        // Rays with a clearance step no farther than the distance: they would hardly move.
        let small_is_near = !limits.is_loose || limits.records_clearance;
        if distance.abs() < hit && small_is_near {
            return Next::Hit(self.t + secant(distance, gain, MIN_FINAL_SLOPE));
        }
        self.record(distance);
        if let Some(next) = self.false_position(hit) {
            if let (Next::At(t), Some((last, _))) = (&next, self.outside) {
                self.stride = *t - last;
            }
            return next;
        }
        // Only the sphere of the distance is known to be empty.
        let (free, end) = (self.t + distance, self.end);
        let goes_on = free <= end;
        if !goes_on {
            return Next::At(free);
        }
        self.slope = self.slope + T::constant(SLOPE_WEIGHT) * (gain - self.slope);
        self.close = distance < near;
        let step = if self.close {
            let step = secant(distance, gain, MIN_SLOPE);
            // Along a surface, or where a change of sign is looked for, no step need be shorter.
            if limits.is_loose || gain > T::constant(-MIN_SLOPE) {
                step.max(T::constant(MIN_STEP_FRACTION) * near)
            } else {
                step
            }
        } else {
            // Two spheres beside a plane touch.
            let apart = (T::constant(1.0) - self.slope)
                .clamp(T::constant(2.0 / MAX_RELAXATION), T::constant(2.0));
            (T::constant(2.0) * distance).div(apart)
        };
        let step = if limits.records_clearance { step.min(distance) } else { step };
        self.stride = step.min(end - self.t);
        // A sum that is rounded up may be past the end, where the ray would count as a miss without
        // a sample.
        Next::At((self.t + self.stride).min(end))
    }

    /// The distance from the surface below which a sample is a hit.
    fn hit_within(&self, near: T) -> T {
        (T::constant(HIT_FRACTION) * near).max(self.ray.rounding(self.t))
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
        if first - last < hit {
            return Some(Next::Hit(first));
        }
        // The zero of a line through both samples, but within the middle 8 tenths.
        let part = above.div(above - below).clamp(T::constant(0.1), T::constant(0.9));
        Some(Next::At(last + part * (first - last)))
    }
}

/// The distance to the surface along the ray if the field falls by `-gain` per unit of length, with
/// a slope of at least `least`.
fn secant<T: Real>(distance: T, gain: T, least: f64) -> T {
    distance.div((T::constant(0.0) - gain).max(T::constant(least)))
}
