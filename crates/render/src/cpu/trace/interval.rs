//! The method `interval` on the CPU, as in the shader.

use sdfc_graph::FAR;

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
    /// Takes a sample. The ray moves to the next position of false position after a change of sign,
    /// or to the next sample where there are no bounds. Otherwise it waits for the bounds of a
    /// segment.
    pub(super) fn interval(
        &mut self,
        distance: T,
        limits: &Limits<T>,
        has_bounds: bool,
    ) -> Next<T> {
        let zero = T::constant(0.0);
        let is_first = self.outside.is_none() && self.inside.is_none();
        // A ray that starts inside or on a surface hits at its origin. A small value does not tell
        // that it does: the field may be flat there.
        if is_first && distance <= zero {
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
        if self.t >= self.end {
            return Next::At(T::constant(FAR));
        }
        if !has_bounds {
            return self.unproven_step(limits);
        }
        let rounding = self.ray.rounding(self.t);
        self.segment = self.segment.max(above.max(rounding));
        if limits.records_clearance {
            self.segment = self.segment.min(above.max(near));
        }
        self.shortened = false;
        self.bounds(limits)
    }

    /// Asks for bounds of the next segment, unless the steps for proofs are spent.
    fn bounds(&mut self, limits: &Limits<T>) -> Next<T> {
        if self.evaluations >= limits.steps {
            return self.unproven_step(limits);
        }
        self.evaluations += 1;
        let (last, _) = self.outside.unwrap_or((T::constant(0.0), T::constant(0.0)));
        Next::Bounds((last + self.segment).min(self.end))
    }

    /// Takes a lower bound of the field on a segment. The ray moves to its end if it is free or too
    /// short to tell. Otherwise its nearer part is examined next.
    pub(super) fn bounded(&mut self, least: T, limits: &Limits<T>) -> Next<T> {
        let zero = T::constant(0.0);
        let (last, above) = self.outside.unwrap_or((zero, zero));
        let end = self.pending.unwrap_or(last);
        let near = limits.tolerance(&self.ray, last);
        let rounding = self.ray.rounding(self.t);
        let spent = f64::from(self.evaluations) / f64::from(limits.steps);
        let finest = T::constant(FINEST.max(COARSEST * spent)) * near;
        let finest = finest.max(rounding);
        if least > zero || self.segment <= finest {
            let proven = least > zero || end - last <= near.max(rounding);
            self.unproven = self.unproven || !proven;
            self.segment = if self.shortened { zero } else { self.segment + self.segment };
            return Next::At(end);
        }
        // As far as the field would stay positive if it fell linearly to its lower bound.
        let fall = (above - least).max(T::constant(1e-30));
        let part = (T::constant(MAX_FRACTION) * above).div(fall);
        let part = part.clamp(T::constant(MIN_FRACTION), T::constant(MAX_FRACTION));
        self.segment = (part * (end - last)).max(finest);
        self.shortened = true;
        self.bounds(limits)
    }

    /// The next sample where nothing is proven.
    fn unproven_step(&mut self, limits: &Limits<T>) -> Next<T> {
        let zero = T::constant(0.0);
        let (_, above) = self.outside.unwrap_or((zero, zero));
        self.unproven = true;
        let step = self.sampling_step(above, limits);
        self.evaluations += 1;
        Next::At((self.t + step).min(self.end))
    }

    /// The ends of the segment whose bounds the ray waits for.
    pub(super) fn segment_to_bound(&self) -> [[T; 3]; 2] {
        let zero = T::constant(0.0);
        let (last, _) = self.outside.unwrap_or((zero, zero));
        [last, self.pending.unwrap_or(last)].map(|t| self.ray.at(t))
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

    /// The step from a sample to the next where nothing is proven. It is at least the tolerance.
    /// Once the rest of the budget is only enough for the longest steps, it is one of these or
    /// longer, so that the ray reaches its end.
    fn sampling_step(&self, distance: T, limits: &Limits<T>) -> T {
        let growth = T::constant(STEP_GROWTH / f64::from(limits.steps));
        let start = T::constant(START_FRACTION) * self.ray.t_max;
        let pixel = T::constant(2.0) * self.ray.footprint(self.t);
        let near = limits.tolerance(&self.ray, self.t);
        let longest = (growth * (self.t + start)).max(pixel);
        let approach =
            (T::constant(APPROACH) * distance).div(self.steepness.max(T::constant(1e-20)));
        let step = approach.clamp(near, longest.max(near));
        let step = if limits.records_clearance { step.min(distance.max(near)) } else { step };
        let budget = limits.method.step_budget_factor().saturating_mul(limits.steps);
        let left = budget.saturating_sub(self.evaluations);
        // Steps that multiply t + start by exp(needed) reach the end within the budget.
        let samples = T::constant(f64::from(left.max(BRACKET_STEPS + 1) - BRACKET_STEPS));
        let needed = (self.ray.t_max + start).div(self.t + start).log().div(samples);
        let forced = (self.t + start) * (needed.exp() - T::constant(1.0));
        if needed >= growth { step.max(forced) } else { step }
    }
}
