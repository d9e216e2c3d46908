//! The method `interval` on the CPU, as in the shader.

use sdfc_graph::eval::Evaluator;

use super::{Limits, Next, Walk};
use crate::cpu::ray::Real;

/// Bounds on the fraction of a segment that is examined next.
const MAX_FRACTION: f64 = 0.9;
const MIN_FRACTION: f64 = 0.0625;
/// The shortest segment, as a fraction of the tolerance. It grows up to COARSEST tolerances as a
/// ray spends its steps.
const FINEST: f64 = 0.0625;
const COARSEST: f64 = 4.0;

impl<T: Real> Walk<T> {
    /// Returns the position up to which the ray is free, or which is too near to tell; after a
    /// change of sign, the next position of false position.
    pub(super) fn interval(
        &mut self,
        distance: T,
        limits: &Limits<T>,
        range: &mut Evaluator<'_, T>,
    ) -> Next<T> {
        let zero = T::constant(0.0);
        let hit = self.hit_within(limits.tolerance(&self.ray, self.t));
        if self.evaluations == 0 && distance < hit {
            self.evaluations = 1;
            return Next::Hit(self.t);
        }
        self.record(distance);
        self.evaluations += u32::from(self.inside.is_some());
        let (last, above) = self.outside.unwrap_or((zero, zero));
        let near = limits.tolerance(&self.ray, last);
        if let Some(next) = self.false_position(self.hit_within(near)) {
            return next;
        }
        if self.t >= self.ray.t_max {
            return Next::At(self.ray.t_max + self.ray.t_max);
        }
        let rounding = self.ray.rounding(self.t);
        self.segment = self.segment.max(above.max(rounding));
        if limits.records_clearance {
            self.segment = self.segment.min(above.max(near));
        }
        let mut shortened = false;
        let mut end = last;
        while self.evaluations < limits.steps {
            end = (last + self.segment).min(self.ray.t_max);
            self.evaluations += 1;
            let least = range.eval_ray(self.ray.at(last), self.ray.at(end))[0][0];
            let spent = f64::from(self.evaluations) / f64::from(limits.steps);
            let finest = T::constant(FINEST.max(COARSEST * spent)) * near;
            let finest = finest.max(rounding);
            if least > zero || self.segment <= finest {
                break;
            }
            // As far as the field would stay positive if it fell linearly to its lower bound.
            let fall = (above - least).max(T::constant(1e-30));
            let part = (T::constant(MAX_FRACTION) * above).div(fall);
            let part = part.clamp(T::constant(MIN_FRACTION), T::constant(MAX_FRACTION));
            self.segment = (part * (end - last)).max(finest);
            shortened = true;
        }
        self.segment = if shortened { zero } else { self.segment + self.segment };
        Next::At(end)
    }
}
