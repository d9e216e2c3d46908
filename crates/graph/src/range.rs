//! Conservative ranges of values in real arithmetic. They decide comparisons and selections whose
//! outcome does not depend on the point.

use crate::eval::HASH_COUNT;
use crate::node::{Binary, Const, LoopVar, Node, NodeId, Ternary, Unary};

/// An interval `lo..=hi` that contains every component; infinite ends are open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower bound.
    pub lo: f64,
    /// Upper bound.
    pub hi: f64,
}

impl Range {
    /// All numbers.
    pub const ALL: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    const NON_NEGATIVE: Self = Self { lo: 0.0, hi: f64::INFINITY };

    /// The interval between two ends; all numbers if they are out of order or NaN.
    pub fn new(lo: f64, hi: f64) -> Self {
        if lo <= hi { Self { lo, hi } } else { Self::ALL }
    }

    /// The largest absolute value.
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// The smallest absolute value; 0 if the range contains 0.
    pub fn nearest_to_zero(self) -> f64 {
        self.lo.max(-self.hi).max(0.0)
    }

    /// True if all values are from 0 to 1.
    pub fn is_fraction(self) -> bool {
        self.lo >= 0.0 && self.hi <= 1.0
    }

    fn of_const(value: &Const) -> Self {
        let lanes = value.lanes();
        hull(lanes[..value.ty().width()].iter().map(|&lane| Self::new(lane, lane)))
    }

    fn neg(self) -> Self {
        Self::new(-self.hi, -self.lo)
    }

    fn add(self, other: Self) -> Self {
        Self::new(self.lo + other.lo, self.hi + other.hi)
    }

    fn mul(self, other: Self) -> Self {
        // An infinite end is never reached, so infinity times 0 is 0 here.
        let product = |x: f64, y: f64| if x == 0.0 || y == 0.0 { 0.0 } else { x * y };
        let ends = [
            product(self.lo, other.lo),
            product(self.lo, other.hi),
            product(self.hi, other.lo),
            product(self.hi, other.hi),
        ];
        Self::new(
            ends.into_iter().fold(f64::INFINITY, f64::min),
            ends.into_iter().fold(f64::NEG_INFINITY, f64::max),
        )
    }

    fn reciprocal(self) -> Self {
        if self.lo > 0.0 || self.hi < 0.0 {
            Self::new(1.0 / self.hi, 1.0 / self.lo)
        } else if self.lo == 0.0 {
            Self::NON_NEGATIVE
        } else {
            Self::ALL
        }
    }

    fn abs(self) -> Self {
        if self.lo >= 0.0 {
            self
        } else if self.hi <= 0.0 {
            self.neg()
        } else {
            Self::new(0.0, self.hi.max(-self.lo))
        }
    }

    fn min(self, other: Self) -> Self {
        Self::new(self.lo.min(other.lo), self.hi.min(other.hi))
    }

    fn max(self, other: Self) -> Self {
        Self::new(self.lo.max(other.lo), self.hi.max(other.hi))
    }

    fn map(self, monotone: impl Fn(f64) -> f64) -> Self {
        Self::new(monotone(self.lo), monotone(self.hi))
    }
}

fn hull(ranges: impl IntoIterator<Item = Range>) -> Range {
    let joined = ranges.into_iter().reduce(|a, b| Range::new(a.lo.min(b.lo), a.hi.max(b.hi)));
    joined.unwrap_or(Range::ALL)
}

/// The range of a node, given the ranges of its arguments.
pub(crate) fn range_of(node: &Node, of: impl Fn(NodeId) -> Range, width: usize) -> Range {
    match *node {
        Node::Const(value) => Range::of_const(&value),
        Node::Variable(_, LoopVar::Index, _) => Range::NON_NEGATIVE,
        Node::Point(..)
        | Node::Frame(..)
        | Node::Variable(..)
        | Node::Loop(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => Range::ALL,
        Node::Unary(op, a) => unary(op, of(a)),
        Node::Binary(op, a, b) => {
            if a == b && matches!(op, Binary::Mul | Binary::Dot) {
                let square = of(a).abs().map(|x| x * x);
                return if op == Binary::Dot { Range::NON_NEGATIVE } else { square };
            }
            binary(op, of(a), of(b))
        }
        Node::Ternary(op, arguments) => ternary(op, arguments.map(of)),
        Node::Splat(_, a) | Node::Swizzle(_, a, _) => of(a),
        Node::Compose(_, parts) => hull(parts[..width].iter().map(|&part| of(part))),
        Node::Transform(..) => Range::ALL,
    }
}

fn unary(op: Unary, a: Range) -> Range {
    let unit = Range::new(-1.0, 1.0);
    let quarter = std::f64::consts::FRAC_PI_2;
    match op {
        Unary::Neg => a.neg(),
        Unary::Abs => a.abs(),
        Unary::Sign => a.map(sign),
        Unary::Floor => a.map(f64::floor),
        Unary::Ceil => a.map(f64::ceil),
        Unary::Round => a.map(f64::round_ties_even),
        Unary::Trunc => a.map(f64::trunc),
        Unary::Fract | Unary::Not => Range::new(0.0, 1.0),
        Unary::Sqrt => a.max(Range::new(0.0, 0.0)).map(f64::sqrt),
        Unary::InverseSqrt | Unary::Length => Range::NON_NEGATIVE,
        Unary::Exp | Unary::Exp2 => Range::NON_NEGATIVE,
        Unary::Sin | Unary::Cos | Unary::Tanh | Unary::Normalize => unit,
        Unary::Asin | Unary::Atan => Range::new(-quarter, quarter),
        Unary::Acos => Range::new(0.0, 2.0 * quarter),
        Unary::Log | Unary::Log2 | Unary::Tan | Unary::Sinh => Range::ALL,
        Unary::Cosh => Range::new(1.0, f64::INFINITY),
        Unary::Saturate => a.max(Range::new(0.0, 0.0)).min(Range::new(1.0, 1.0)),
    }
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

fn binary(op: Binary, a: Range, b: Range) -> Range {
    let truth = Range::new(0.0, 1.0);
    match op {
        Binary::Add => a.add(b),
        Binary::Sub => a.add(b.neg()),
        Binary::Mul => a.mul(b),
        Binary::Div => a.mul(b.reciprocal()),
        Binary::Min => a.min(b),
        Binary::Max => a.max(b),
        Binary::Alternative => b,
        Binary::Rem if b.lo >= 0.0 => Range::new(0.0, b.hi),
        Binary::Pow if a.lo >= 0.0 => Range::NON_NEGATIVE,
        Binary::Atan2 => Range::new(-std::f64::consts::PI, std::f64::consts::PI),
        Binary::Rem | Binary::Pow | Binary::Dot | Binary::Cross => Range::ALL,
        Binary::Hash => Range::new(0.0, HASH_COUNT - 1.0),
        Binary::Step
        | Binary::Lt
        | Binary::Le
        | Binary::Eq
        | Binary::Ne
        | Binary::And
        | Binary::Or => truth,
    }
}

fn ternary(op: Ternary, [a, b, c]: [Range; 3]) -> Range {
    match op {
        Ternary::Mix if c.is_fraction() => hull([a, b]),
        Ternary::Mix => Range::ALL,
        Ternary::Clamp => a.max(b).min(c),
        Ternary::Smoothstep => Range::new(0.0, 1.0),
        Ternary::Select => hull([b, c]),
    }
}
