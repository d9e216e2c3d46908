//! A field beyond the box on which its constant holds.
//!
//! With c the point of a box B nearest to p, u = f(c) and v = |p - c|, the field sqrt(u² + (L v)²) equals f in B. If f is
//! L-Lipschitz in B it is so everywhere: projection onto a convex set is firmly nonexpansive, so
//! p -> (c, v) is 1-Lipschitz. Divided by L it never exceeds the distance to a surface that lies in B: at c the angle
//! between p and any point of B is not acute.

use crate::{Graph, NodeId, Ternary};

impl Graph {
    /// The point of `lo..hi` nearest to `point`; an end that is not finite does not bind.
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

    /// Whether no lane is known to be infinite or no number.
    fn binds(&mut self, end: NodeId, width: u8) -> bool {
        (0..width).all(|lane| {
            let lane = self.component(end, lane);
            self.as_number(lane).is_none_or(f64::is_finite)
        })
    }

    /// The field that is `value` where `nearest` is `point`, and beyond goes on from `value`, the field at
    /// `nearest`, with the constant `lipschitz`.
    pub fn continued(
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
        let away = self.length(offset);
        let risen = self.mul(away, lipschitz);
        let both = self.compose(&[value, risen]);
        let outside = self.length(both);
        let zero = self.number(0.0);
        let is_outside = self.lt(zero, away);
        self.select(is_outside, outside, value)
    }
}
