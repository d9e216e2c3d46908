//! Sums, products, quotients and what is made of them.

use super::Enclosing;
use super::extent::{COARSE, Extent, LARGE, Line, ROUNDING, Span, TINY};
use crate::{Binary, NodeId, Ternary, Type, Unary};

impl Enclosing<'_> {
    pub(super) fn negative(&mut self, x: Extent) -> Extent {
        match x {
            Extent::Fixed(value) => Extent::Fixed(self.graph.neg(value)),
            Extent::Line(Line { ends, size }) => {
                Extent::Line(Line { ends: ends.map(|end| self.graph.neg(end)), size })
            }
            Extent::Span(Span { lo, hi, wild }) => {
                Span { lo: self.graph.neg(hi), hi: self.graph.neg(lo), wild }.into()
            }
        }
    }

    pub(super) fn magnitudes(&mut self, x: Extent) -> Extent {
        if let Extent::Fixed(value) = x {
            return Extent::Fixed(self.graph.abs(value));
        }
        let x = self.span(x);
        let low = self.graph.neg(x.lo);
        let negated = self.graph.neg(x.hi);
        let apart = self.graph.max(x.lo, negated);
        Span { lo: self.above_zero(apart), hi: self.graph.max(low, x.hi), ..x }.into()
    }

    pub(super) fn sum(&mut self, x: Extent, y: Extent) -> Extent {
        if let (Extent::Fixed(x), Extent::Fixed(y)) = (x, y) {
            return Extent::Fixed(self.graph.add(x, y));
        }
        if let Some([x, y]) = self.lines([x, y]) {
            let ends = [0, 1].map(|end| self.graph.add(x.ends[end], y.ends[end]));
            return Extent::Line(Line { ends, size: self.graph.add(x.size, y.size) });
        }
        let (x, y) = (self.span(x), self.span(y));
        let sum = self.monotone2(Binary::Add, x, y);
        let sum = self.widened(sum, ROUNDING);
        self.endless_as(sum, &[x, y]).into()
    }

    pub(super) fn difference(&mut self, x: Extent, y: Extent) -> Extent {
        if let (Extent::Fixed(x), Extent::Fixed(y)) = (x, y) {
            return Extent::Fixed(self.graph.sub(x, y));
        }
        let y = self.negative(y);
        self.sum(x, y)
    }

    /// The difference of two values of the field that is none of the field's own. Of what is known per frame the field has both rounded
    /// to f32 before they meet, this has the difference rounded once: where they nearly cancel that matters.
    pub(super) fn difference_of_rounded(&mut self, x: Extent, y: Extent) -> Extent {
        let difference = self.difference(x, y);
        let (Extent::Fixed(x), Extent::Fixed(y), Extent::Fixed(node)) = (x, y, difference) else {
            return difference;
        };
        if [x, y, node].into_iter().all(|it| self.is_single(it)) {
            return difference;
        }
        let (x, y) = (self.graph.abs(x), self.graph.abs(y));
        let size = self.graph.add(x, y);
        let margin = self.scaled(size, ROUNDING);
        self.grown(Span::new(node, node), margin).into()
    }

    /// Whether a node is a constant that f32 has.
    fn is_single(&self, node: NodeId) -> bool {
        let lanes = |value: crate::Const| {
            let width = value.ty().width();
            value.lanes()[..width].iter().all(|&lane| f64::from(lane as f32) == lane)
        };
        self.graph.as_const(node).is_some_and(lanes)
    }

    /// Of two equal types, lane by lane.
    pub(super) fn product(&mut self, x: Extent, y: Extent) -> Extent {
        match (x, y) {
            (Extent::Fixed(x), Extent::Fixed(y)) => Extent::Fixed(self.graph.mul(x, y)),
            (Extent::Line(line), Extent::Fixed(by)) | (Extent::Fixed(by), Extent::Line(line)) => {
                let ends = line.ends.map(|end| self.graph.mul(end, by));
                let factor = self.graph.abs(by);
                Extent::Line(Line { ends, size: self.graph.mul(line.size, factor) })
            }
            (Extent::Span(span), Extent::Fixed(by)) | (Extent::Fixed(by), Extent::Span(span)) => {
                self.multiple(span, by).into()
            }
            (Extent::Line(x), Extent::Line(y)) if x.is_level() || y.is_level() => {
                self.along(x, y, crate::Graph::mul)
            }
            (Extent::Line(_) | Extent::Span(_), Extent::Line(_) | Extent::Span(_)) => {
                let (x, y) = (self.span(x), self.span(y));
                self.span_product(x, y).into()
            }
        }
    }

    /// A product of two lines of which one is level.
    fn along(
        &mut self,
        x: Line,
        y: Line,
        product: impl Fn(&mut crate::Graph, NodeId, NodeId) -> NodeId,
    ) -> Extent {
        let mut product = |x, y| product(self.graph, x, y);
        let ends = [product(x.ends[0], y.ends[0]), product(x.ends[1], y.ends[1])];
        Extent::Line(Line { ends, size: product(x.size, y.size) })
    }

    /// By one number, of either sign.
    fn multiple(&mut self, x: Span, by: NodeId) -> Span {
        let ends = [x.lo, x.hi].map(|end| self.graph.mul(end, by));
        let range = self.graph.range(by);
        let result = if range.lo >= 0.0 {
            Span { lo: ends[0], hi: ends[1], ..x }
        } else if range.hi <= 0.0 {
            Span { lo: ends[1], hi: ends[0], ..x }
        } else {
            Span { wild: x.wild, ..self.around(&ends) }
        };
        let result = self.widened(result, ROUNDING);
        if !x.wild {
            return result;
        }
        let result = self.endless_product(result, x, Span::new(by, by));
        self.cut(result)
    }

    fn span_product(&mut self, x: Span, y: Span) -> Span {
        let [x_is_positive, y_is_positive] = [x, y].map(|span| self.graph.range(span.lo).lo >= 0.0);
        let (x, y) = if x_is_positive { (y, x) } else { (x, y) };
        let mut corner = |a, b| self.graph.mul(a, b);
        let result = if x_is_positive && y_is_positive {
            Span::new(corner(x.lo, y.lo), corner(x.hi, y.hi))
        } else if x_is_positive || y_is_positive {
            let [low, high] = [x.lo, x.hi].map(|end| [corner(end, y.lo), corner(end, y.hi)]);
            let lo = self.graph.min(low[0], low[1]);
            Span::new(lo, self.graph.max(high[0], high[1]))
        } else {
            let corners =
                [corner(x.lo, y.lo), corner(x.lo, y.hi), corner(x.hi, y.lo), corner(x.hi, y.hi)];
            self.around(&corners)
        };
        let result = self.widened(result, ROUNDING);
        if !x.wild && !y.wild {
            return result;
        }
        let result = self.endless_product(result, x, y);
        self.cut(result)
    }

    pub(super) fn square(&mut self, x: Extent) -> Extent {
        if let Extent::Fixed(value) = x {
            return Extent::Fixed(self.graph.mul(value, value));
        }
        let x = self.magnitudes(x);
        let x = self.span(x);
        self.span_product(x, x).into()
    }

    pub(super) fn quotient(&mut self, x: Extent, y: Extent) -> Extent {
        match (x, y) {
            (Extent::Fixed(x), Extent::Fixed(y)) => Extent::Fixed(self.graph.div(x, y)),
            (Extent::Line(line), Extent::Fixed(by)) => {
                let ends = line.ends.map(|end| self.graph.div(end, by));
                let divisor = self.graph.abs(by);
                Extent::Line(Line { ends, size: self.graph.div(line.size, divisor) })
            }
            (Extent::Span(span), Extent::Fixed(by)) => {
                let one = self.number_like(by, 1.0);
                let factor = self.graph.div(one, by);
                let result = self.multiple(span, factor);
                self.widened(result, COARSE).into()
            }
            (_, Extent::Line(_) | Extent::Span(_)) => {
                let (x, y) = (self.span(x), self.span(y));
                if self.graph.range(y.lo).lo >= 0.0 {
                    self.quotient_by_positive(x, y).into()
                } else {
                    self.by_lane([x.into(), y.into()], |s, [x, y]| s.quotient_of_numbers(x, y))
                }
            }
        }
    }

    /// A divisor that may reach 0 leaves the quotient [`LARGE`].
    fn quotient_by_positive(&mut self, x: Span, y: Span) -> Span {
        let divisors = [y.lo, y.hi].map(|end| self.at_least(end, TINY));
        let ends = [x.lo, x.hi].map(|end| divisors.map(|by| self.graph.div(end, by)));
        let lo = self.graph.min(ends[0][0], ends[0][1]);
        let result = Span::new(lo, self.graph.max(ends[1][0], ends[1][1]));
        let result = self.widened(result, COARSE);
        let result = self.endless_as(result, &[x]);
        let result = self.endless_below(result, y);
        self.cut(result)
    }

    fn quotient_of_numbers(&mut self, x: Extent, y: Extent) -> Span {
        let (x, y) = (self.span(x), self.span(y));
        let nought = self.graph.number(0.0);
        let (below, above) = (self.graph.le(y.lo, nought), self.graph.le(nought, y.hi));
        let meets_zero = self.graph.binary(Binary::And, below, above);
        // A positive divisor in place of one about 0.
        let negative = self.graph.le(y.hi, nought);
        let (low, high) = (self.graph.neg(y.hi), self.graph.neg(y.lo));
        let y_lo = self.graph.select(negative, low, y.lo);
        let y_hi = self.graph.select(negative, high, y.hi);
        let (low, high) = (self.graph.neg(x.hi), self.graph.neg(x.lo));
        let x_lo = self.graph.select(negative, low, x.lo);
        let x_hi = self.graph.select(negative, high, x.hi);
        let (x, y) = (Span { lo: x_lo, hi: x_hi, ..x }, Span { lo: y_lo, hi: y_hi, ..y });
        let result = self.quotient_by_positive(x, y);
        let entire = self.entire(Type::Scalar);
        self.chosen(Span::new(meets_zero, meets_zero), entire, result)
    }

    /// `x - y * floor(x / y)`: a shifted copy of x while the quotient's floor is one number, else between 0 and y.
    pub(super) fn remainder(&mut self, x: Extent, y: Extent) -> Extent {
        self.by_lane([x, y], |s, [x, y]| {
            let fixed = if let Extent::Fixed(y) = y { Some(y) } else { None };
            let (x, y) = (s.span(x), s.span(y));
            let (low, high) = (s.at_most(y.lo, 0.0), s.at_least(y.hi, 0.0));
            let between = Span { lo: low, hi: high, wild: y.wild };
            let size = s.magnitude(x);
            let margin = s.scaled(size, ROUNDING);
            let between = s.grown(between, margin);
            let Some(y) = fixed else { return between };
            let [first, last] = s.wholes(x.into(), Extent::Fixed(y));
            let step = s.graph.mul(y, first);
            let moved = Span { lo: s.graph.sub(x.lo, step), hi: s.graph.sub(x.hi, step), ..x };
            let moved = s.grown(moved, margin);
            let same = s.graph.binary(Binary::Eq, first, last);
            s.chosen(Span::new(same, same), moved, between)
        })
    }

    /// The floors of the least and the greatest quotient: devices need not agree on which side of a whole number a
    /// quotient beside it lies.
    fn wholes(&mut self, x: Extent, y: Extent) -> [NodeId; 2] {
        let quotient = self.quotient(x, y);
        let Span { lo, hi, .. } = self.span(quotient);
        [lo, hi].map(|end| self.graph.unary(Unary::Floor, end))
    }

    /// The scalar product of two vectors.
    pub(super) fn dot(&mut self, x: Extent, y: Extent) -> Extent {
        match (x, y) {
            (Extent::Fixed(x), Extent::Fixed(y)) => Extent::Fixed(self.graph.dot(x, y)),
            (Extent::Line(line), Extent::Fixed(by)) | (Extent::Fixed(by), Extent::Line(line)) => {
                let ends = line.ends.map(|end| self.graph.dot(end, by));
                let factor = self.graph.abs(by);
                Extent::Line(Line { ends, size: self.graph.dot(line.size, factor) })
            }
            (Extent::Line(x), Extent::Line(y)) if x.is_level() || y.is_level() => {
                self.along(x, y, crate::Graph::dot)
            }
            (Extent::Span(_), _) | (_, Extent::Span(_)) | (Extent::Line(_), Extent::Line(_)) => {
                let products = self.product(x, y);
                self.sum_of_lanes(products)
            }
        }
    }

    fn sum_of_lanes(&mut self, x: Extent) -> Extent {
        let x = self.span(x);
        let (lo, hi) = (x.lo, x.hi);
        let ones = self.number_like(lo, 1.0);
        let sums = [lo, hi].map(|end| self.graph.dot(end, ones));
        // The terms may cancel.
        let sizes = [lo, hi].map(|end| self.graph.abs(end));
        let size = self.graph.max(sizes[0], sizes[1]);
        let size = self.graph.dot(size, ones);
        let margin = self.scaled(size, 2.0 * ROUNDING);
        let sum = self.grown(Span { lo: sums[0], hi: sums[1], wild: x.wild }, margin);
        self.endless_sum(sum, x).into()
    }

    pub(super) fn square_of_length(&mut self, x: Extent) -> Extent {
        if let Extent::Fixed(value) = x {
            return Extent::Fixed(self.graph.dot(value, value));
        }
        let length = self.length(x);
        self.square(length)
    }

    pub(super) fn length(&mut self, x: Extent) -> Extent {
        if self.ty(x).width() == 1 {
            return self.magnitudes(x);
        }
        match x {
            Extent::Fixed(value) => Extent::Fixed(self.graph.length(value)),
            Extent::Line(Line { ends: [value, end], size }) if value == end => {
                let length = self.graph.length(value);
                let size = self.graph.length(size);
                let margin = self.scaled(size, 4.0 * ROUNDING);
                self.grown(Span::new(length, length), margin).into()
            }
            Extent::Line(line) => self.length_along(line).into(),
            Extent::Span(_) => {
                let sizes = self.magnitudes(x);
                let sizes = self.span(sizes);
                let length = self.monotone(Unary::Length, sizes);
                self.widened(length, COARSE).into()
            }
        }
    }

    /// The distance from the origin is greatest at an end, and least at the nearest place of the stretch.
    fn length_along(&mut self, Line { ends: [a, b], size }: Line) -> Span {
        let along = self.graph.sub(b, a);
        let toward = self.graph.dot(a, along);
        let square = self.graph.dot(along, along);
        let square = self.at_least(square, TINY);
        let part = self.graph.div(toward, square);
        let part = self.graph.neg(part);
        let part = self.graph.unary(Unary::Saturate, part);
        let way = self.graph.mul(along, part);
        let nearest = self.graph.add(a, way);
        let lo = self.graph.length(nearest);
        let ends = [a, b].map(|end| self.graph.length(end));
        let hi = self.graph.max(ends[0], ends[1]);
        let size = self.graph.length(size);
        let margin = self.scaled(size, 4.0 * ROUNDING);
        let result = self.grown(Span::new(lo, hi), margin);
        Span { lo: self.above_zero(result.lo), ..result }
    }

    /// A vector by its length; 0 by 0 is anything of length 1.
    pub(super) fn direction(&mut self, x: Extent) -> Extent {
        if let Extent::Fixed(value) = x {
            return Extent::Fixed(self.graph.unary(Unary::Normalize, value));
        }
        let ty = self.ty(x);
        let length = self.length(x);
        let length = self.splat(ty, length);
        let (x, length) = (self.span(x), self.span(length));
        let ratio = self.quotient_by_positive(x, length);
        self.clipped(ratio, -1.0 - COARSE, 1.0 + COARSE).into()
    }

    pub(super) fn cross(&mut self, x: Extent, y: Extent) -> Extent {
        if let (Extent::Fixed(x), Extent::Fixed(y)) = (x, y) {
            return Extent::Fixed(self.graph.binary(Binary::Cross, x, y));
        }
        let mut turned =
            |x, lanes: [u8; 3]| self.moved(x, |graph, node| graph.swizzle(node, &lanes));
        let [a, b] = [turned(x, [1, 2, 0]), turned(x, [2, 0, 1])];
        let [c, d] = [turned(y, [2, 0, 1]), turned(y, [1, 2, 0])];
        let (first, second) = (self.product(a, c), self.product(b, d));
        self.difference(first, second)
    }

    /// Columns and a vector.
    pub(super) fn transform(&mut self, columns: [Extent; 3], v: Extent) -> Extent {
        if let ([Extent::Fixed(a), Extent::Fixed(b), Extent::Fixed(c)], Extent::Line(line)) =
            (columns, v)
        {
            let ends = line.ends.map(|end| self.graph.transform([a, b, c], end));
            let sizes = [a, b, c].map(|column| self.graph.abs(column));
            return Extent::Line(Line { ends, size: self.graph.transform(sizes, line.size) });
        }
        let mut sum = None;
        for (lane, column) in (0..).zip(columns) {
            let part = self.component(v, lane);
            let part = self.splat(Type::Vec3, part);
            let term = self.product(column, part);
            sum = Some(sum.map_or(term, |sum| self.sum(sum, term)));
        }
        sum.unwrap_or(v)
    }

    /// `x * (1 - t) + y * t`: for t from 0 to 1 between the mixtures at the ends.
    pub(super) fn mixture(&mut self, x: Extent, y: Extent, t: Extent) -> Extent {
        let span = self.span(t);
        let unit = self.graph.range(span.lo).lo >= 0.0 && self.graph.range(span.hi).hi <= 1.0;
        if !unit {
            let rest = self.one_minus(t);
            let (first, second) = (self.product(x, rest), self.product(y, t));
            let sum = self.sum(first, second);
            return self.mixed_by_difference(sum, [x, y], span);
        }
        let (x, y) = (self.span(x), self.span(y));
        let mut mixed = |x, y, t| self.graph.ternary(Ternary::Mix, x, y, t);
        let low = [mixed(x.lo, y.lo, span.lo), mixed(x.lo, y.lo, span.hi)];
        let high = [mixed(x.hi, y.hi, span.lo), mixed(x.hi, y.hi, span.hi)];
        let (lo, hi) = (self.graph.min(low[0], low[1]), self.graph.max(high[0], high[1]));
        let sizes = [self.magnitude(x), self.magnitude(y)];
        let size = self.graph.max(sizes[0], sizes[1]);
        let margin = self.scaled(size, 2.0 * ROUNDING);
        let result = self.grown(Span { lo, hi, wild: x.wild || y.wild }, margin);
        let result = self.endless_as(result, &[x, y]);
        if result.wild { self.cut(result).into() } else { result.into() }
    }

    /// A mixture where devices may compute `x + t (y - x)`, whose terms may be larger than those of
    /// `x (1 - t) + y t`.
    fn mixed_by_difference(&mut self, mixture: Extent, ends: [Extent; 2], t: Span) -> Extent {
        let [x, y] = ends.map(|end| {
            let end = self.span(end);
            self.magnitude(end)
        });
        let size = self.graph.max(x, y);
        let share = self.magnitude(t);
        let share = self.at_least(share, 1.0);
        let size = self.graph.mul(size, share);
        let margin = self.scaled(size, 2.0 * ROUNDING);
        let mixture = self.span(mixture);
        let result = self.grown(mixture, margin);
        if result.wild { self.cut(result).into() } else { result.into() }
    }

    /// 0 where a whole number is the same at both ends, else anything: the slope of what jumps from one to the next.
    pub(super) fn jump(&mut self, x: Span) -> Extent {
        let gap = self.graph.sub(x.hi, x.lo);
        let jumps = self.graph.unary(Unary::Saturate, gap);
        let hi = self.scaled(jumps, LARGE);
        Span::wild(self.graph.neg(hi), hi).into()
    }
}
