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
/// The longest step between samples: at the start of the ray as long as after this fraction of it,
/// and its growth as a multiple of 1 / steps.
const START_FRACTION: f64 = 0.03125;
const STEP_GROWTH: f64 = 1.1655;
/// A step is no longer than this fraction of the way to where the field would be 0.
const APPROACH: f64 = 0.5;
/// Weight of the steepest slope so far, beside that of the last step.
const SLOPE_MEMORY: f64 = 0.75;
/// Steps that are left for a bracket.
const BRACKET_STEPS: u32 = 48;

impl<T: Real> Walk<T> {
    /// Returns the position up to which the ray is free, or which is too near to tell; after a
    /// change of sign, the next position of false position. The rest of a ray that runs out of
    /// steps, or that has no bounds, is sampled without a proof.
    pub(super) fn interval(
        &mut self,
        distance: T,
        limits: &Limits<T>,
        range: Option<&mut Evaluator<'_, T>>,
    ) -> Next<T> {
        let zero = T::constant(0.0);
        let hit = self.hit_within(limits.tolerance(&self.ray, self.t));
        if self.evaluations == 0 && distance < hit {
            self.evaluations = 1;
            return Next::Hit(self.t);
        }
        self.steepness = self.recent_slope(distance);
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
        if let Some(range) = range
            && let Some(end) = self.proven_end([last, above], limits, range)
        {
            return Next::At(end);
        }
        self.unproven = true;
        let step = self.sampling_step(distance, limits);
        self.evaluations += 1;
        Next::At((self.t + step).min(self.ray.t_max))
    }

    /// Returns the position up to which the ray is free, or which is too near to tell; `None` if
    /// the steps for proofs are spent before.
    fn proven_end(
        &mut self,
        [last, above]: [T; 2],
        limits: &Limits<T>,
        range: &mut Evaluator<'_, T>,
    ) -> Option<T> {
        let zero = T::constant(0.0);
        let near = limits.tolerance(&self.ray, last);
        let rounding = self.ray.rounding(self.t);
        self.segment = self.segment.max(above.max(rounding));
        if limits.records_clearance {
            self.segment = self.segment.min(above.max(near));
        }
        let mut shortened = false;
        while self.evaluations < limits.steps {
            let end = (last + self.segment).min(self.ray.t_max);
            self.evaluations += 1;
            let least = range.eval_ray(self.ray.at(last), self.ray.at(end))[0][0];
            let spent = f64::from(self.evaluations) / f64::from(limits.steps);
            let finest = T::constant(FINEST.max(COARSEST * spent)) * near;
            let finest = finest.max(rounding);
            if least > zero || self.segment <= finest {
                let proven = least > zero || end - last <= near.max(rounding);
                self.unproven = self.unproven || !proven;
                self.segment = if shortened { zero } else { self.segment + self.segment };
                return Some(end);
            }
            // As far as the field would stay positive if it fell linearly to its lower bound.
            let fall = (above - least).max(T::constant(1e-30));
            let part = (T::constant(MAX_FRACTION) * above).div(fall);
            let part = part.clamp(T::constant(MIN_FRACTION), T::constant(MAX_FRACTION));
            self.segment = (part * (end - last)).max(finest);
            shortened = true;
        }
        None
    }

    /// How steep the field has been of late, with one more sample.
    fn recent_slope(&self, distance: T) -> T {
        match self.outside {
            Some((last, above)) if self.t > last => {
                let slope = (distance - above).abs().div(self.t - last);
                (T::constant(SLOPE_MEMORY) * self.steepness).max(slope)
            }
            Some(_) | None => self.steepness,
        }
    }

    /// The step from a sample to the next where nothing is proven. It is at least the tolerance,
    /// and the ray reaches its end within the budget.
    fn sampling_step(&self, distance: T, limits: &Limits<T>) -> T {
        let growth = T::constant(STEP_GROWTH / f64::from(limits.steps));
        let pixel = T::constant(2.0) * self.ray.footprint(self.t);
        let start = T::constant(START_FRACTION) * self.ray.t_max;
        let near = limits.tolerance(&self.ray, self.t);
        let longest = (growth * (self.t + start)).max(pixel).max(near);
        let approach =
            (T::constant(APPROACH) * distance).div(self.steepness.max(T::constant(1e-20)));
        let step = approach.clamp(near, longest);
        let step = if limits.records_clearance { step.min(distance.max(near)) } else { step };
        let budget = limits.method.step_budget_factor().saturating_mul(limits.steps);
        let left = budget.saturating_sub(self.evaluations);
        let samples = T::constant(f64::from(left.max(BRACKET_STEPS + 1) - BRACKET_STEPS));
        step.max((self.ray.t_max - self.t).div(samples))
    }
}
