//! The method `auto` on the CPU, as in the shader.

use super::{Limits, Next, Walk};
use crate::cpu::ray::Real;

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

impl<T: Real> Walk<T> {
    /// Takes the distance at the current position.
    pub(super) fn auto(&mut self, distance: T, limits: &Limits<T>) -> Next<T> {
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
}

/// The distance to the surface along the ray if the field falls by `-gain` per unit of length, with
/// a slope of at least `least`.
fn secant<T: Real>(distance: T, gain: T, least: f64) -> T {
    distance.div((T::constant(0.0) - gain).max(T::constant(least)))
}
