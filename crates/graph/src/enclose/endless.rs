//! What counts as infinite goes on to do so.
//!
//! A bound of [`LARGE`] and more stands for any number beyond. A root of it, its logarithm, a part of it or what is left of it
//! after a sum are numbers like any others, but no bounds: there the bound is [`LARGE`] again. What is divided by it may
//! be 0. Only spans that are marked as wild reach so far, so that no others pay.

use super::Enclosing;
use super::extent::{LARGE, Span, TINY};
use crate::{Binary, NodeId, Type};

impl Enclosing<'_> {
    /// The result of what rises with all that it is made `from`.
    pub(super) fn endless_as(&mut self, result: Span, from: &[Span]) -> Span {
        let mut result = result;
        for x in from.iter().filter(|x| x.wild) {
            if self.graph.range(x.hi).hi >= LARGE {
                let reach = self.reach_above(x.hi);
                result.hi = self.graph.max(result.hi, reach);
            }
            if self.graph.range(x.lo).lo <= -LARGE {
                let low = self.graph.neg(x.lo);
                let reach = self.reach_above(low);
                let reach = self.graph.neg(reach);
                result.lo = self.graph.min(result.lo, reach);
            }
        }
        result
    }

    /// A product; 0 by anything is 0.
    pub(super) fn endless_product(&mut self, result: Span, x: Span, y: Span) -> Span {
        if !x.wild && !y.wild {
            return result;
        }
        let sizes = [x, y].map(|factor| self.magnitude(factor));
        let greater = self.graph.max(sizes[0], sizes[1]);
        let lesser = self.graph.min(sizes[0], sizes[1]);
        let (endless, some) = (self.is_endless(greater), self.reaches(TINY, lesser));
        let reach = self.graph.mul(endless, some);
        let reach = self.reach(reach);
        let hi = self.graph.max(result.hi, reach);
        if self.graph.range(result.lo).lo >= 0.0 {
            return Span { hi, ..result };
        }
        let reach = self.graph.neg(reach);
        Span { lo: self.graph.min(result.lo, reach), hi, ..result }
    }

    /// What falls to 0 as `x` grows.
    pub(super) fn endless_below(&mut self, result: Span, x: Span) -> Span {
        if !x.wild {
            return result;
        }
        let endless = self.is_endless(x.hi);
        let far = self.scaled(endless, -LARGE);
        let far = self.offset(far, LARGE);
        let near = self.graph.neg(far);
        Span { lo: self.graph.min(result.lo, far), hi: self.graph.max(result.hi, near), ..result }
    }

    /// The sum of a span's lanes.
    pub(super) fn endless_sum(&mut self, result: Span, lanes: Span) -> Span {
        if !lanes.wild {
            return result;
        }
        let low = self.graph.neg(lanes.lo);
        let [above, below] = [lanes.hi, low].map(|end| {
            let endless = self.is_endless(end);
            let ones = self.number_like(end, 1.0);
            let count = self.graph.dot(endless, ones);
            let any = self.at_most(count, 1.0);
            self.reach(any)
        });
        let below = self.graph.neg(below);
        Span {
            lo: self.graph.min(result.lo, below),
            hi: self.graph.max(result.hi, above),
            ..result
        }
    }

    /// [`LARGE`] where a number is endless, else its negative, which is no bound at all.
    fn reach_above(&mut self, x: NodeId) -> NodeId {
        let endless = self.is_endless(x);
        self.reach(endless)
    }

    /// [`LARGE`] for 1, its negative for 0.
    fn reach(&mut self, endless: NodeId) -> NodeId {
        let twice = self.scaled(endless, 2.0 * LARGE);
        self.offset(twice, -LARGE)
    }

    fn is_endless(&mut self, x: NodeId) -> NodeId {
        self.reaches(LARGE, x)
    }

    /// 1 where a number is no less than another, else 0, lane by lane.
    fn reaches(&mut self, edge: f64, x: NodeId) -> NodeId {
        debug_assert!(self.graph.ty(x) != Type::Bool);
        let edge = self.number_like(x, edge);
        self.graph.binary(Binary::Step, edge, x)
    }
}
