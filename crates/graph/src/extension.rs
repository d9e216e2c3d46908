//! Lipschitz extension of a field beyond the box on which its constant holds.
//!
//! Let c be the point of a box B nearest to p, u = f(c) and v = |p - c|. The field sqrt(u² + (L
//! v)²) equals f in B. If f is L-Lipschitz in B, the extension is so everywhere: projection onto a
//! convex set is firmly nonexpansive, so p -> (c, v) is 1-Lipschitz. Divided by L it never exceeds
//! the distance to a surface that lies in B: at c the angle between p and any point of B is not
//! acute.

use crate::graph::Graph;
use crate::node::{NodeId, Ternary};

impl Graph {
    /// The point of the box `lo..hi` nearest to `point`. An end that is not finite does not bind.
    pub fn nearest_within(&mut self, point: NodeId, [lo, hi]: [NodeId; 2]) -> NodeId {
        let width = self.ty(point).width() as u8;
        if self.binds(lo, width) && self.binds(hi, width) {
            return self.ternary(Ternary::Clamp, point, lo, hi);
        }
        let mut lanes = Vec::with_capacity(usize::from(width));
        for lane in 0..width {
            let [mut value, lo, hi] = [point, lo, hi].map(|v| self.component(v, lane));
            if self.binds(lo, 1) {
                value = self.max(value, lo);
            }
            if self.binds(hi, 1) {
                value = self.min(value, hi);
            }
            lanes.push(value);
        }
        self.compose(&lanes)
    }

    /// True if no lane is known to be infinite or NaN.
    fn binds(&mut self, end: NodeId, width: u8) -> bool {
        (0..width).all(|lane| {
            let lane = self.component(end, lane);
            self.as_number(lane).is_none_or(f64::is_finite)
        })
    }

    /// The field that is `value` where `nearest == point`; elsewhere it extends `value`, the field
    /// at `nearest`, with the Lipschitz constant `lipschitz`.
    pub fn lipschitz_extension(
        &mut self,
        point: NodeId,
        nearest: NodeId,
        value: NodeId,
        lipschitz: NodeId,
    ) -> NodeId {
        if nearest == point {
            return value;
        }
        let offset = self.sub(point, nearest);
        let distance = self.length(offset);
        let rise = self.mul(distance, lipschitz);
        let both = self.compose(&[value, rise]);
        let outside = self.length(both);
        let zero = self.number(0.0);
        let is_outside = self.lt(zero, distance);
        self.select(is_outside, outside, value)
    }
}
