//! Propagation of values that count as infinite.
//!
//! A bound of [`LARGE`] or more stands for any number beyond. Its root, its logarithm, a fraction
//! of it or what is left of it after a sum are ordinary numbers, but no bounds; there the bound is
//! reset to [`LARGE`]. A number divided by it may be 0. Only intervals marked as `may_overflow` can
//! reach that far, so others have no extra cost.

use super::encloser::Encloser;
use super::values::{Interval, LARGE, TINY};
use crate::node::{Binary, NodeId, Type};

impl Encloser<'_> {
    /// The result of an operation that is increasing in all values it is computed `from`.
    pub(super) fn overflow_monotone(&mut self, result: Interval, from: &[Interval]) -> Interval {
        let mut result = result;
        for x in from.iter().filter(|x| x.may_overflow) {
            if self.graph.range(x.hi).hi >= LARGE {
                let large = self.large_if_overflow(x.hi);
                result.hi = self.graph.max(result.hi, large);
            }
            if self.graph.range(x.lo).lo <= -LARGE {
                let low = self.graph.neg(x.lo);
                let large = self.large_if_overflow(low);
                let large = self.graph.neg(large);
                result.lo = self.graph.min(result.lo, large);
            }
        }
        result
    }

    /// A product; 0 times anything is 0.
    pub(super) fn overflow_product(
        &mut self,
        result: Interval,
        x: Interval,
        y: Interval,
    ) -> Interval {
        if !x.may_overflow && !y.may_overflow {
            return result;
        }
        let sizes = [x, y].map(|factor| self.magnitude(factor));
        let greater = self.graph.max(sizes[0], sizes[1]);
        let lesser = self.graph.min(sizes[0], sizes[1]);
        let (overflow, some) = (self.overflows(greater), self.step_at(TINY, lesser));
        let large = self.graph.mul(overflow, some);
        let large = self.signed_large(large);
        let hi = self.graph.max(result.hi, large);
        if self.graph.range(result.lo).lo >= 0.0 {
            return Interval { hi, ..result };
        }
        let large = self.graph.neg(large);
        Interval { lo: self.graph.min(result.lo, large), hi, ..result }
    }

    /// The result of an operation that falls to 0 as `x` grows.
    pub(super) fn overflow_reciprocal(&mut self, result: Interval, x: Interval) -> Interval {
        if !x.may_overflow {
            return result;
        }
        let overflow = self.overflows(x.hi);
        let far = self.scaled(overflow, -LARGE);
        let far = self.offset(far, LARGE);
        let near = self.graph.neg(far);
        Interval {
            lo: self.graph.min(result.lo, far),
            hi: self.graph.max(result.hi, near),
            ..result
        }
    }

    /// The sum of the lanes of an interval.
    pub(super) fn overflow_sum(&mut self, result: Interval, lanes: Interval) -> Interval {
        if !lanes.may_overflow {
            return result;
        }
        let low = self.graph.neg(lanes.lo);
        let [above, below] = [lanes.hi, low].map(|end| {
            let overflow = self.overflows(end);
            let ones = self.number_like(end, 1.0);
            let count = self.graph.dot(overflow, ones);
            let any = self.at_most(count, 1.0);
            self.signed_large(any)
        });
        let below = self.graph.neg(below);
        Interval {
            lo: self.graph.min(result.lo, below),
            hi: self.graph.max(result.hi, above),
            ..result
        }
    }

    /// [`LARGE`] where a number overflows, else -[`LARGE`], which is no bound at all.
    fn large_if_overflow(&mut self, x: NodeId) -> NodeId {
        let overflow = self.overflows(x);
        self.signed_large(overflow)
    }

    /// [`LARGE`] for 1, -[`LARGE`] for 0.
    fn signed_large(&mut self, overflow: NodeId) -> NodeId {
        let twice = self.scaled(overflow, 2.0 * LARGE);
        self.offset(twice, -LARGE)
    }

    fn overflows(&mut self, x: NodeId) -> NodeId {
        self.step_at(LARGE, x)
    }

    /// 1 where a number is at least the edge, else 0, lane by lane.
    fn step_at(&mut self, edge: f64, x: NodeId) -> NodeId {
        debug_assert!(self.graph.ty(x) != Type::Bool);
        let edge = self.number_like(x, edge);
        self.graph.binary(Binary::Step, edge, x)
    }
}
