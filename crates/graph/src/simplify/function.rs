//! Rules for powers and roots.

use crate::graph::Graph;
use crate::node::{Binary, Node, NodeId, Stage, Type, Unary};
use crate::walk::operands;

/// Largest number of terms of a sum of exponentials whose logarithm is rewritten.
const MAX_EXPONENTIALS: usize = 16;
/// Largest number of squares whose root is a length.
const MAX_SQUARES: usize = 4;

/// A soft maximum or minimum of two values, by the logarithm of a sum of exponentials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SoftExtreme {
    /// Which one it is.
    pub kind: SoftKind,
    /// Its logarithm: [`Unary::Log`] or [`Unary::Log2`].
    pub op: Unary,
    /// The two values.
    pub operands: [NodeId; 2],
}

/// The kind of a [`SoftExtreme`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SoftKind {
    /// `log(exp(a) + exp(b))`, which increases with both.
    Max,
    /// `-log(exp(-a) + exp(-b))`, which increases with both.
    Min,
    /// `log(exp(-a) + exp(-b))`, which decreases with both.
    NegatedMin,
}

impl Graph {
    pub(super) fn simplified_sqrt(&mut self, a: NodeId) -> Option<NodeId> {
        if let Some((x, y)) = self.as_binary(Binary::Mul, a)
            && x == y
        {
            return Some(self.abs(x));
        }
        if let Some((x, y)) = self.as_binary(Binary::Dot, a)
            && x == y
        {
            return Some(self.length(x));
        }
        let parts = self.squared_parts(a)?;
        let vector = self.compose(&parts);
        Some(self.length(vector))
    }

    /// The values whose squares add up to a sum that depends on the point.
    fn squared_parts(&mut self, sum: NodeId) -> Option<Vec<NodeId>> {
        if self.ty(sum) != Type::Scalar || self.stage(sum) != Stage::Point {
            return None;
        }
        let mut parts = Vec::new();
        for term in self.terms(sum, MAX_SQUARES)? {
            if let Some((x, y)) = self.as_binary(Binary::Dot, term)
                && x == y
            {
                let width = self.ty(x).width() as u8;
                parts.extend((0..width).map(|lane| self.component(x, lane)));
            } else {
                let part = self.root_of_square(term)?;
                parts.push(part);
            }
        }
        (2..=MAX_SQUARES).contains(&parts.len()).then_some(parts)
    }

    /// The value whose square is `x * x`, `c * x * x` or a constant.
    fn root_of_square(&mut self, square: NodeId) -> Option<NodeId> {
        if let Some(number) = self.as_number(square) {
            return (number >= 0.0).then(|| self.number(number.sqrt()));
        }
        let (a, b) = self.as_binary(Binary::Mul, square)?;
        if a == b {
            return Some(a);
        }
        let scaled_square = |x: NodeId, by: NodeId| {
            let (y, z) = self.as_binary(Binary::Mul, x)?;
            Some((y, self.as_number(by)?)).filter(|_| y == z)
        };
        let scaled_factor = |x: NodeId, y: NodeId| {
            let (z, by) = self.as_binary(Binary::Mul, x)?;
            Some((y, self.as_number(by)?)).filter(|_| z == y)
        };
        let found = scaled_square(a, b).or_else(|| scaled_factor(a, b));
        let (x, factor) = found.or_else(|| scaled_factor(b, a)).filter(|found| found.1 > 0.0)?;
        let root = self.number(factor.sqrt());
        Some(self.mul(x, root))
    }

    /// The terms of a sum; `None` if there are more than `limit`.
    fn terms(&self, sum: NodeId, limit: usize) -> Option<Vec<NodeId>> {
        operands(self, sum, limit, |op, _| op == Binary::Add)
    }

    /// The logarithm of a sum of exponentials, term by term as
    /// `max(a, b) + log(1 + exp(-|a - b|))`. The exponentials themselves exceed f32, or vanish, a
    /// few hundred units away.
    pub(super) fn simplified_log(&mut self, op: Unary, sum: NodeId) -> Option<NodeId> {
        if self.ty(sum) != Type::Scalar || self.stage(sum) != Stage::Point {
            return None;
        }
        let power = if op == Unary::Log2 { Unary::Exp2 } else { Unary::Exp };
        let log = if op == Unary::Log2 { f64::log2 } else { f64::ln };
        let mut exponents = Vec::new();
        for term in self.terms(sum, MAX_EXPONENTIALS)? {
            let exponent = self.exponent(power, log, term)?;
            exponents.push(exponent);
        }
        if let [a, b] = exponents[..] {
            // `log(1 + exp(x))` for an x of at most 0 is as good as it gets.
            let is_done = |this: &Self, one: NodeId, x: NodeId| {
                this.as_number(one) == Some(0.0) && this.range(x).hi <= 0.0
            };
            if is_done(self, a, b) || is_done(self, b, a) {
                return None;
            }
        }
        let mut exponents = exponents.into_iter();
        let mut joined = exponents.next()?;
        if exponents.len() == 0 {
            return None;
        }
        for exponent in exponents {
            let greater = self.max(joined, exponent);
            let gap = self.soft_gap(op, joined, exponent);
            joined = self.add(greater, gap);
        }
        Some(joined)
    }

    /// x for `exp(x)`, `c * exp(x)` or the constant `exp(x)`.
    fn exponent(&mut self, power: Unary, log: fn(f64) -> f64, term: NodeId) -> Option<NodeId> {
        if let Some(number) = self.as_number(term) {
            return (number > 0.0).then(|| self.number(log(number)));
        }
        let exponent_of = |node: NodeId| {
            let Node::Unary(op, x) = self.node(node) else { return None };
            (op == power).then_some(x)
        };
        if let Some(x) = exponent_of(term) {
            return Some(x);
        }
        let (a, b) = self.as_binary(Binary::Mul, term)?;
        let factor = self.as_number(b).filter(|factor| *factor > 0.0)?;
        let x = exponent_of(a)?;
        let offset = self.number(log(factor));
        Some(self.add(x, offset))
    }

    /// `log(1 + exp(-|a - b|))`: what the soft maximum of two values has more than the hard one.
    /// `op` is `Log` or `Log2`.
    pub(crate) fn soft_gap(&mut self, op: Unary, a: NodeId, b: NodeId) -> NodeId {
        let power = if op == Unary::Log2 { Unary::Exp2 } else { Unary::Exp };
        let difference = self.sub(a, b);
        let apart = self.abs(difference);
        let apart = self.neg(apart);
        let small = self.unary(power, apart);
        let one = self.number(1.0);
        let sum = self.add(small, one);
        self.unary(op, sum)
    }

    /// The operands of a soft maximum or minimum of two values, and which one it is:
    /// `max(a, b) + gap`, `min(a, b) - gap` or its negative. `gap` is `log(1 + exp(-|a - b|))`.
    pub fn as_soft_extreme(&mut self, id: NodeId) -> Option<SoftExtreme> {
        let sum = self.as_binary(Binary::Add, id);
        let difference = self.as_binary(Binary::Sub, id);
        let forms = [
            (sum, SoftKind::Max),
            (sum.map(|(a, b)| (b, a)), SoftKind::Max),
            (difference, SoftKind::Min),
            (difference.map(|(a, b)| (b, a)), SoftKind::NegatedMin),
        ];
        forms.into_iter().find_map(|(pair, kind)| {
            let (hard, gap) = pair?;
            let Node::Unary(op @ (Unary::Log | Unary::Log2), _) = self.node(gap) else {
                return None;
            };
            let extreme = if kind == SoftKind::Max { Binary::Max } else { Binary::Min };
            let (a, b) = self.as_binary(extreme, hard)?;
            let matches = [[a, b], [b, a]].into_iter().any(|[a, b]| self.soft_gap(op, a, b) == gap);
            matches.then_some(SoftExtreme { kind, op, operands: [a, b] })
        })
    }

    /// Powers that take at most two multiplications, and roots.
    pub(super) fn simplified_pow(&mut self, x: NodeId, y: NodeId) -> Option<NodeId> {
        let exponent = self.as_splat_number(y)?;
        if exponent == 0.0 {
            return Some(self.one_like(x));
        }
        if exponent == 1.0 {
            return Some(x);
        }
        if exponent == 0.5 {
            return Some(self.unary(Unary::Sqrt, x));
        }
        if exponent == -1.0 {
            let one = self.one_like(x);
            return Some(self.div(one, x));
        }
        let square = [2.0, 3.0, 4.0].contains(&exponent).then(|| self.mul(x, x))?;
        if exponent == 2.0 {
            return Some(square);
        }
        let factor = if exponent == 3.0 { x } else { square };
        Some(self.mul(square, factor))
    }
}
