//! Scalar products, lengths, directions, vector products and matrices.

use super::encloser::Encloser;
use super::values::{Affine, COARSE, Interval, ROUNDING, TINY, Values};
use crate::graph::Graph;
use crate::node::{Binary, Type, Unary};

impl Encloser<'_> {
    /// The scalar product of two vectors.
    pub(super) fn dot(&mut self, x: Values, y: Values) -> Values {
        match (x, y) {
            (Values::Constant(x), Values::Constant(y)) => Values::Constant(self.graph.dot(x, y)),
            (Values::Affine(affine), Values::Constant(by))
            | (Values::Constant(by), Values::Affine(affine)) => {
                let ends = affine.ends.map(|end| self.graph.dot(end, by));
                let factor = self.graph.abs(by);
                Values::Affine(Affine { ends, magnitude: self.graph.dot(affine.magnitude, factor) })
            }
            (Values::Affine(x), Values::Affine(y)) if x.is_constant() || y.is_constant() => {
                self.affine_product(x, y, Graph::dot)
            }
            (Values::Interval(_), _)
            | (_, Values::Interval(_))
            | (Values::Affine(_), Values::Affine(_)) => {
                let products = self.product(x, y);
                self.sum_of_lanes(products)
            }
        }
    }

    fn sum_of_lanes(&mut self, x: Values) -> Values {
        let x = self.interval(x);
        let (lo, hi) = (x.lo, x.hi);
        let ones = self.number_like(lo, 1.0);
        let sums = [lo, hi].map(|end| self.graph.dot(end, ones));
        // The terms may cancel, so the margin is relative to their magnitudes.
        let sizes = [lo, hi].map(|end| self.graph.abs(end));
        let size = self.graph.max(sizes[0], sizes[1]);
        let size = self.graph.dot(size, ones);
        let margin = self.scaled(size, 2.0 * ROUNDING);
        let sum = self
            .expand(Interval { lo: sums[0], hi: sums[1], may_overflow: x.may_overflow }, margin);
        self.overflow_sum(sum, x).into()
    }

    pub(super) fn square_of_length(&mut self, x: Values) -> Values {
        if let Values::Constant(value) = x {
            return Values::Constant(self.graph.dot(value, value));
        }
        let length = self.length(x);
        self.square(length)
    }

    pub(super) fn length(&mut self, x: Values) -> Values {
        if self.ty(x).width() == 1 {
            return self.magnitudes(x);
        }
        match x {
            Values::Constant(value) => Values::Constant(self.graph.length(value)),
            Values::Affine(Affine { ends: [value, end], magnitude: size }) if value == end => {
                let length = self.graph.length(value);
                let size = self.graph.length(size);
                let margin = self.scaled(size, 4.0 * ROUNDING);
                self.expand(Interval::new(length, length), margin).into()
            }
            Values::Affine(affine) => self.length_along(affine).into(),
            Values::Interval(_) => {
                let sizes = self.magnitudes(x);
                let sizes = self.interval(sizes);
                let length = self.monotone(Unary::Length, sizes);
                self.widen_relative(length, COARSE).into()
            }
        }
    }

    /// The length of an affine vector: greatest at an end, least at the point of the segment
    /// nearest to the origin.
    fn length_along(&mut self, Affine { ends: [a, b], magnitude: size }: Affine) -> Interval {
        let along = self.graph.sub(b, a);
        let toward = self.graph.dot(a, along);
        let square = self.graph.dot(along, along);
        let square = self.at_least(square, TINY);
        let t = self.graph.div(toward, square);
        let t = self.graph.neg(t);
        let t = self.graph.unary(Unary::Saturate, t);
        let offset = self.graph.mul(along, t);
        let nearest = self.graph.add(a, offset);
        let lo = self.graph.length(nearest);
        let ends = [a, b].map(|end| self.graph.length(end));
        let hi = self.graph.max(ends[0], ends[1]);
        let size = self.graph.length(size);
        let margin = self.scaled(size, 4.0 * ROUNDING);
        let result = self.expand(Interval::new(lo, hi), margin);
        Interval { lo: self.above_zero(result.lo), ..result }
    }

    /// A vector divided by its length; for the zero vector, anything of length up to 1.
    pub(super) fn direction(&mut self, x: Values) -> Values {
        if let Values::Constant(value) = x {
            return Values::Constant(self.graph.unary(Unary::Normalize, value));
        }
        let ty = self.ty(x);
        let length = self.length(x);
        let length = self.splat(ty, length);
        let (x, length) = (self.interval(x), self.interval(length));
        let ratio = self.quotient_by_positive(x, length);
        self.clamp(ratio, -1.0 - COARSE, 1.0 + COARSE).into()
    }

    pub(super) fn cross(&mut self, x: Values, y: Values) -> Values {
        if let (Values::Constant(x), Values::Constant(y)) = (x, y) {
            return Values::Constant(self.graph.binary(Binary::Cross, x, y));
        }
        let mut turned =
            |x, lanes: [u8; 3]| self.map_nodes(x, |graph, node| graph.swizzle(node, &lanes));
        let [a, b] = [turned(x, [1, 2, 0]), turned(x, [2, 0, 1])];
        let [c, d] = [turned(y, [2, 0, 1]), turned(y, [1, 2, 0])];
        let (first, second) = (self.product(a, c), self.product(b, d));
        self.difference(first, second)
    }

    /// A matrix, given by its columns, times a vector.
    pub(super) fn transform(&mut self, columns: [Values; 3], v: Values) -> Values {
        if let (
            [Values::Constant(a), Values::Constant(b), Values::Constant(c)],
            Values::Affine(affine),
        ) = (columns, v)
        {
            let ends = affine.ends.map(|end| self.graph.transform([a, b, c], end));
            let sizes = [a, b, c].map(|column| self.graph.abs(column));
            return Values::Affine(Affine {
                ends,
                magnitude: self.graph.transform(sizes, affine.magnitude),
            });
        }
        let mut sum = None;
        for (lane, column) in (0..).zip(columns) {
            let factor = self.component(v, lane);
            let factor = self.splat(Type::Vec3, factor);
            let term = self.product(column, factor);
            sum = Some(sum.map_or(term, |sum| self.sum(sum, term)));
        }
        sum.unwrap_or(v)
    }
}
