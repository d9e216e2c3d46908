//! Rules for sums, products, quotients and negation.

use super::lanes;
use crate::graph::Graph;
use crate::node::{Binary, Node, NodeId, Unary};

impl Graph {
    /// The operands of a commutative operation in canonical order: the later stage first, then the
    /// older node.
    pub(super) fn ordered(&self, a: NodeId, b: NodeId) -> (NodeId, NodeId) {
        let key = |id| (std::cmp::Reverse(self.stage(id)), id);
        if key(a) <= key(b) { (a, b) } else { (b, a) }
    }

    pub(super) fn simplified_add(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        let (a, b) = self.ordered(a, b);
        if self.is_uniform(b, 0.0) {
            return Some(a);
        }
        if a == b {
            let two = self.number(2.0);
            return Some(self.mul(a, two));
        }
        if let Some(y) = self.as_neg(b) {
            return Some(self.sub(a, y));
        }
        if let Some(x) = self.as_neg(a) {
            return Some(self.sub(b, x));
        }
        if let Some(rest) = self.cancelled(a, b).or_else(|| self.cancelled(b, a)) {
            return Some(rest);
        }
        if self.is_low(b) && !self.is_low(a) {
            return Some(self.add_low(a, b));
        }
        self.sum_of_selections(a, b).or_else(|| Some(self.intern(Node::Binary(Binary::Add, a, b))))
    }

    /// `x + f`, where f does not depend on the point and x does.
    fn add_low(&mut self, x: NodeId, f: NodeId) -> NodeId {
        if let Some((x, g)) = self.as_offset(x) {
            let sum = self.add(g, f);
            return self.add(x, sum);
        }
        if let Some((g, y)) = self.as_binary(Binary::Sub, x).filter(|&(g, _)| self.is_low(g)) {
            let sum = self.add(g, f);
            return self.sub(sum, y);
        }
        if let Some(value) = self.as_const(f)
            && value.lanes().iter().all(|&lane| lane <= 0.0)
        {
            let negative = self.neg(f);
            return self.intern(Node::Binary(Binary::Sub, x, negative));
        }
        self.intern(Node::Binary(Binary::Add, x, f))
    }

    /// `(x - b) + b`
    fn cancelled(&self, a: NodeId, b: NodeId) -> Option<NodeId> {
        let (x, y) = self.as_binary(Binary::Sub, a)?;
        (y == b).then_some(x)
    }

    /// `select(c, x, 0) + select(c, 0, y)`
    fn sum_of_selections(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        let [condition, a_yes, a_no] = self.as_select(a)?;
        let [same, b_yes, b_no] = self.as_select(b)?;
        let apart = |s: &Self, x, y| s.is_uniform(x, 0.0) || s.is_uniform(y, 0.0);
        if same != condition || !apart(self, a_yes, b_yes) || !apart(self, a_no, b_no) {
            return None;
        }
        let (yes, no) = (self.add(a_yes, b_yes), self.add(a_no, b_no));
        Some(self.select(condition, yes, no))
    }

    pub(super) fn simplified_sub(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        if a == b {
            return Some(self.zero_like(a));
        }
        if self.is_uniform(a, 0.0) {
            return Some(self.neg(b));
        }
        if self.as_const(b).is_some() {
            let negative = self.neg(b);
            return (!self.non_finite(negative)).then(|| self.add(a, negative));
        }
        if let Some(y) = self.as_neg(b) {
            return Some(self.add(a, y));
        }
        if let Some(difference) = self.sub_low(a, b) {
            return Some(difference);
        }
        // A per-frame value stays negated: outside of it, the negation would cost an operation per
        // point.
        if let Some(x) = self.as_neg(a)
            && self.is_low(a) <= self.is_low(b)
        {
            let sum = self.add(x, b);
            return Some(self.neg(sum));
        }
        self.sub_cancelled(a, b).or_else(|| self.sub_scaled(a, b))
    }

    /// A difference of which one side does not depend on the point and the other ends in such a
    /// term.
    fn sub_low(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        if self.is_low(b) && !self.is_low(a) {
            if let Some((x, f)) = self.as_offset(a) {
                let rest = self.sub(f, b);
                return Some(self.add(x, rest));
            }
            let (f, x) = self.as_binary(Binary::Sub, a).filter(|&(f, _)| self.is_low(f))?;
            let rest = self.sub(f, b);
            return Some(self.sub(rest, x));
        }
        if self.is_low(a) && !self.is_low(b) {
            if let Some((x, f)) = self.as_offset(b) {
                let rest = self.sub(a, f);
                return Some(self.sub(rest, x));
            }
            let (f, x) = self.as_binary(Binary::Sub, b).filter(|&(f, _)| self.is_low(f))?;
            let rest = self.sub(a, f);
            return Some(self.add(x, rest));
        }
        None
    }

    fn sub_cancelled(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        if let Some((x, y)) = self.as_binary(Binary::Add, a) {
            if x == b {
                return Some(y);
            }
            if y == b {
                return Some(x);
            }
        }
        if let Some((x, y)) = self.as_binary(Binary::Sub, b)
            && x == a
        {
            return Some(y);
        }
        None
    }

    /// `a - x * f` is `a + x * -f`, one operation less where the target fuses multiply and add.
    fn sub_scaled(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        let (x, f) = self.as_scaled(b)?;
        let negative = self.neg(f);
        let product = self.mul(x, negative);
        Some(self.add(a, product))
    }

    pub(super) fn simplified_neg(&mut self, a: NodeId) -> Option<NodeId> {
        match self.node(a) {
            Node::Unary(Unary::Neg, x) => Some(x),
            Node::Binary(Binary::Sub, x, y) => Some(self.sub(y, x)),
            Node::Binary(Binary::Add, x, f) if self.is_low(f) && !self.is_low(x) => {
                let negative = self.neg(f);
                Some(self.sub(negative, x))
            }
            Node::Binary(Binary::Mul, x, f) if self.is_low(f) && !self.is_low(x) => {
                let negative = self.neg(f);
                Some(self.mul(x, negative))
            }
            Node::Binary(Binary::Div, f, x) if self.is_low(f) && !self.is_low(x) => {
                let negative = self.neg(f);
                Some(self.div(negative, x))
            }
            Node::Binary(Binary::Min, x, y) => self.negated_choice(Binary::Max, x, y),
            Node::Binary(Binary::Max, x, y) => self.negated_choice(Binary::Min, x, y),
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => None,
        }
    }

    /// `-min(x, y)` is `max(-x, -y)`, if both negatives are free.
    fn negated_choice(&mut self, opposite: Binary, x: NodeId, y: NodeId) -> Option<NodeId> {
        let (x, y) = (self.free_negative(x)?, self.free_negative(y)?);
        Some(self.binary(opposite, x, y))
    }

    pub(super) fn simplified_mul(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        let (a, b) = self.ordered(a, b);
        if self.is_uniform(b, 0.0) {
            return Some(b);
        }
        if self.is_uniform(b, 1.0) {
            return Some(a);
        }
        if self.is_uniform(b, -1.0) {
            return Some(self.neg(a));
        }
        if let Some(product) = self.mul_signs(a, b) {
            return Some(product);
        }
        if self.is_low(b)
            && !self.is_low(a)
            && let Some(product) = self.mul_low(a, b)
        {
            return Some(product);
        }
        self.mul_splats(a, b)
            .or_else(|| self.mul_splats(b, a))
            .or_else(|| self.mul_selection(a, b))
            .or_else(|| self.mul_selection(b, a))
            .or_else(|| self.mul_reciprocal(a, b))
            .or_else(|| self.mul_reciprocal(b, a))
            .or_else(|| Some(self.intern(Node::Binary(Binary::Mul, a, b))))
    }

    fn mul_signs(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        let (x, y) = (self.as_neg(a), self.as_neg(b));
        match (x, y) {
            (None, None) => None,
            (Some(x), Some(y)) => Some(self.mul(x, y)),
            (Some(x), None) if self.is_low(b) => {
                let negative = self.neg(b);
                // Moving a negation between two per-frame values would gain nothing.
                if self.is_low(a) { None } else { Some(self.mul(x, negative)) }
            }
            (Some(x), None) => {
                let product = self.mul(x, b);
                Some(self.neg(product))
            }
            (None, Some(_)) if self.is_low(b) => None,
            (None, Some(y)) => {
                let product = self.mul(a, y);
                Some(self.neg(product))
            }
        }
    }

    /// `x * f`, where f does not depend on the point and x does.
    fn mul_low(&mut self, x: NodeId, f: NodeId) -> Option<NodeId> {
        if let Some((x, g)) = self.as_scaled(x) {
            let factor = self.mul(g, f);
            return (!self.overflows(factor)).then(|| self.mul(x, factor));
        }
        if let Some((g, y)) = self.as_binary(Binary::Div, x).filter(|&(g, _)| self.is_low(g)) {
            let above = self.mul(g, f);
            return Some(self.div(above, y));
        }
        if let Some((v, w)) = self.as_binary(Binary::Dot, x).filter(|&(_, w)| self.is_low(w)) {
            let scaled = self.mul(w, f);
            return Some(self.dot(v, scaled));
        }
        if let Some((y, d)) = self.as_offset(x)
            && let Some((y, c)) = self.as_scaled(y)
        {
            let (factor, offset) = (self.mul(c, f), self.mul(d, f));
            if self.overflows(factor) || self.overflows(offset) {
                return None;
            }
            let product = self.mul(y, factor);
            return Some(self.add(product, offset));
        }
        if let Some([condition, yes, no]) = self.as_select(x)
            && self.is_low(yes)
            && self.is_low(no)
        {
            let (yes, no) = (self.mul(yes, f), self.mul(no, f));
            return Some(self.select(condition, yes, no));
        }
        self.mul_mask(x, f)
    }

    /// A vector times a constant of zeros and ones selects components.
    fn mul_mask(&mut self, v: NodeId, f: NodeId) -> Option<NodeId> {
        if self.ty(v).width() == 1 {
            return None;
        }
        let mask = lanes(&self.as_const(f)?);
        if mask.iter().any(|&lane| lane != 0.0 && lane != 1.0) {
            return None;
        }
        let zero = self.number(0.0);
        let parts: Vec<NodeId> = (0..)
            .zip(&mask)
            .map(|(i, &lane)| if lane == 0.0 { zero } else { self.component(v, i) })
            .collect();
        Some(self.compose(&parts))
    }

    /// `(v * splat(s)) * splat(t)` multiplies the scalars first.
    fn mul_splats(&mut self, product: NodeId, other: NodeId) -> Option<NodeId> {
        if self.ty(other).width() == 1 {
            return None;
        }
        let (x, y) = self.as_binary(Binary::Mul, product)?;
        let (v, s) = match (self.as_splat(x), self.as_splat(y)) {
            (None, Some(s)) => (x, s),
            (Some(s), None) => (y, s),
            (None, None) | (Some(_), Some(_)) => return None,
        };
        let t = self.as_equal_lanes(other)?;
        let factor = self.mul(s, t);
        Some(self.mul(v, factor))
    }

    /// `select(c, 1, 0) * x`
    fn mul_selection(&mut self, selection: NodeId, x: NodeId) -> Option<NodeId> {
        let [condition, yes, no] = match self.as_splat(selection) {
            Some(scalar) => self.as_select(scalar)?,
            None => self.as_select(selection)?,
        };
        let zero = self.zero_like(x);
        if self.is_uniform(yes, 1.0) && self.is_uniform(no, 0.0) {
            return Some(self.select(condition, x, zero));
        }
        if self.is_uniform(yes, 0.0) && self.is_uniform(no, 1.0) {
            return Some(self.select(condition, zero, x));
        }
        None
    }

    /// True if the constant overflows f32. Folding factors into it would turn `0 * a * b = 0` into
    /// `0 * inf = NaN`.
    fn overflows(&self, id: NodeId) -> bool {
        let beyond = |lane: &f64| lane.abs() > f64::from(f32::MAX);
        self.as_const(id)
            .is_some_and(|value| value.lanes()[..value.ty().width()].iter().any(beyond))
    }

    /// `x * (1 / y)`
    fn mul_reciprocal(&mut self, x: NodeId, reciprocal: NodeId) -> Option<NodeId> {
        let (one, y) = self.as_binary(Binary::Div, reciprocal)?;
        let per_point = !self.is_low(reciprocal) && self.is_uniform(one, 1.0);
        per_point.then(|| self.div(x, y))
    }

    pub(super) fn simplified_div(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        if self.is_uniform(b, 1.0) {
            return Some(a);
        }
        if self.is_uniform(a, 0.0) && !self.is_uniform(b, 0.0) {
            return Some(a);
        }
        if let Some(x) = self.as_neg(a)
            && self.is_low(a) <= self.is_low(b)
        {
            let quotient = self.div(x, b);
            return Some(self.neg(quotient));
        }
        if let Some(y) = self.as_neg(b) {
            let quotient = self.div(a, y);
            return Some(self.neg(quotient));
        }
        if self.is_low(b) && !self.is_low(a) {
            let one = self.one_like(b);
            let reciprocal = self.div(one, b);
            let fits = !self.non_finite(reciprocal) && !self.overflows(reciprocal);
            return fits.then(|| self.mul(a, reciprocal));
        }
        None
    }
}
