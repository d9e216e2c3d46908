//! Analytic intersection of copies, as `auto` does it in the shader: at each position those that
//! are sampled there, as far as there are no others.

use sdfc_graph::eval::Packet;

use super::{Limits, Trace, Walk};
use crate::cpu::pre_intersection::PreIntersection;
use crate::cpu::ray::{Batch, LANES, Ray, Real, packed};
use crate::image::HIT;

/// Traces all rays to their ends; the result has their order.
pub(crate) fn trace_among_copies<T: Real>(
    copies: &mut Batch<'_, T>,
    rays: &[Ray<T>],
    known: &[PreIntersection<T>],
    limits: &Limits<T>,
) -> Vec<Trace<'static, T>> {
    let mut traces = vec![Trace::untraced(); rays.len()];
    let groups = rays.chunks(LANES).zip(known.chunks(LANES));
    for ((group, known), traces) in groups.zip(traces.chunks_mut(LANES)) {
        let mut walks: Vec<Option<Walk<T>>> = Vec::with_capacity(LANES);
        for ((&ray, &known), trace) in group.iter().zip(known).zip(traces.iter_mut()) {
            let walk = Walk::new(ray, known);
            let must_march = walk.known.must_march();
            if !must_march {
                *trace = walk.without_hit();
            }
            walks.push(must_march.then_some(walk));
        }
        let mut ends = [[[T::constant(0.0); 3]; LANES]; 2];
        while walks.iter().any(Option::is_some) {
            for (lane, walk) in walks.iter().enumerate() {
                if let Some(walk) = walk {
                    (ends[0][lane], ends[1][lane]) = (walk.ray.at(walk.t), walk.ray.direction);
                }
            }
            let sampled = copies.eval_ray(packed(&ends[0]), packed(&ends[1]));
            let [Packet(met), Packet(reach), ..] = sampled[0];
            for (lane, slot) in walks.iter_mut().enumerate() {
                let Some(walk) = slot else { continue };
                if let Some(ended) = walk.step_over([met[lane], reach[lane]], limits) {
                    traces[lane] = ended;
                    *slot = None;
                }
            }
        }
    }
    traces
}

impl<T: Real> Walk<T> {
    /// Moves by the result for the current position: where the ray hits a copy that is sampled
    /// here, and how far there are no other copies.
    fn step_over(&mut self, [met, reach]: [T; 2], limits: &Limits<T>) -> Option<Trace<'static, T>> {
        self.evaluations += 1;
        let [met, reach] = [met, reach].map(|way| self.t + way);
        if met <= reach && met <= self.end {
            return Some(self.result(self.known.start + met, HIT));
        }
        let within = reach <= self.end;
        let rounding = self.ray.rounding(self.t);
        self.t = if within { reach.max(self.t + rounding) } else { reach };
        self.ended(within, limits)
    }
}
