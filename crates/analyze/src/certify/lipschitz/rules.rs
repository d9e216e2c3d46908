//! The rules for the constant of an operation, from those of its operands.

use sdfc_graph::{Binary, Graph, Node, NodeId, Range, Stage, Ternary, Unary};

use super::Slopes;
use crate::certify::affine;
use crate::certify::norms::{hypotenuse, is_zero, largest_lane};
use crate::certify::reason::{Constant, Reason};

impl Slopes {
    pub(super) fn unary(&self, graph: &mut Graph, op: Unary, a: NodeId) -> Constant {
        if let Some(steepest) = steepest_slope(op, graph.range(a)) {
            let (factor, inner) = (graph.number(steepest), self.constant(a)?);
            return Ok(graph.mul(factor, inner));
        }
        match op {
            // 1-Lipschitz functions: |u(x) - u(y)| <= |x - y| in every lane.
            Unary::Neg
            | Unary::Abs
            | Unary::Sin
            | Unary::Cos
            | Unary::Atan
            | Unary::Tanh
            | Unary::Saturate
            | Unary::Length => self.constant(a),
            Unary::Sign => Err(Reason::Jump("sign")),
            Unary::Floor => Err(Reason::Jump("floor")),
            Unary::Ceil => Err(Reason::Jump("ceil")),
            Unary::Round => Err(Reason::Jump("round")),
            Unary::Trunc => Err(Reason::Jump("trunc")),
            Unary::Fract => Err(Reason::Jump("fract")),
            Unary::Not => Err(Reason::Jump("!")),
            Unary::Sqrt => Err(Reason::Unbounded("sqrt")),
            Unary::InverseSqrt => Err(Reason::Unbounded("inverseSqrt")),
            Unary::Exp => Err(Reason::Unbounded("exp")),
            Unary::Exp2 => Err(Reason::Unbounded("exp2")),
            Unary::Log => Err(Reason::Unbounded("log")),
            Unary::Log2 => Err(Reason::Unbounded("log2")),
            Unary::Tan => Err(Reason::Unbounded("tan")),
            Unary::Asin => Err(Reason::Unbounded("asin")),
            Unary::Acos => Err(Reason::Unbounded("acos")),
            Unary::Sinh => Err(Reason::Unbounded("sinh")),
            Unary::Cosh => Err(Reason::Unbounded("cosh")),
            Unary::Normalize => Err(Reason::Unbounded("normalize")),
        }
    }

    pub(super) fn binary(&self, graph: &mut Graph, op: Binary, a: NodeId, b: NodeId) -> Constant {
        let fixed = |node| graph.stage(node) < Stage::Point;
        let (a_fixed, b_fixed) = (fixed(a), fixed(b));
        match op {
            Binary::Add | Binary::Sub => {
                let (x, y) = (self.constant(a)?, self.constant(b)?);
                Ok(graph.add(x, y))
            }
            Binary::Mul if a_fixed || b_fixed => {
                let (fixed, varying) = if a_fixed { (a, b) } else { (b, a) };
                let factor = largest_lane(graph, fixed);
                let inner = self.constant(varying)?;
                Ok(graph.mul(factor, inner))
            }
            Binary::Dot | Binary::Cross if a_fixed || b_fixed => {
                let (fixed, varying) = if a_fixed { (a, b) } else { (b, a) };
                let factor = graph.length(fixed);
                let inner = self.constant(varying)?;
                Ok(graph.mul(factor, inner))
            }
            Binary::Div if b_fixed => {
                let one = graph.number(1.0);
                let inverse = graph.div(one, b);
                let factor = largest_lane(graph, inverse);
                let inner = self.constant(a)?;
                Ok(graph.mul(factor, inner))
            }
            Binary::Min | Binary::Max => {
                let (x, y) = (self.constant(a)?, self.constant(b)?);
                if graph.ty(a).width() == 1 || is_zero(graph, x) || is_zero(graph, y) {
                    return Ok(graph.max(x, y));
                }
                Ok(hypotenuse(graph, &[x, y]))
            }
            Binary::Alternative => self.constant(b),
            Binary::Mul => self.product(graph, a, b),
            Binary::Div => self.quotient(graph, a, b),
            Binary::Dot => Err(Reason::Unbounded("dot")),
            Binary::Cross => Err(Reason::Unbounded("cross")),
            Binary::Pow => self.power(graph, a, b),
            Binary::Atan2 => Err(Reason::Unbounded("atan2")),
            Binary::Rem => Err(Reason::Jump("%")),
            Binary::Step => Err(Reason::Jump("step")),
            Binary::Hash => Err(Reason::Jump("hash")),
            Binary::Lt | Binary::Le => Err(Reason::Jump("<")),
            Binary::Eq | Binary::Ne => Err(Reason::Jump("==")),
            Binary::And | Binary::Or => Err(Reason::Jump("&&")),
        }
    }

    /// A product of two bounded factors, such as sines: |xy - uv| <= max|x| |y - v| + max|y| |x -
    /// u|. The two terms are combined by their hypotenuse if the factors depend on different
    /// components of the point.
    fn product(&self, graph: &mut Graph, a: NodeId, b: NodeId) -> Constant {
        let (limit_a, limit_b) = (graph.range(a).magnitude(), graph.range(b).magnitude());
        if !(limit_a.is_finite() && limit_b.is_finite()) {
            return Err(Reason::Unbounded("*"));
        }
        let (x, y) = (self.constant(a)?, self.constant(b)?);
        let (limit_a, limit_b) = (graph.number(limit_a), graph.number(limit_b));
        let parts = [graph.mul(x, limit_b), graph.mul(y, limit_a)];
        if self.components.are_disjoint(&[a, b]) && graph.ty(a).width() == 1 {
            return Ok(hypotenuse(graph, &parts));
        }
        Ok(graph.add(parts[0], parts[1]))
    }

    /// A quotient whose divisor stays away from 0: |(x / y)'| <= |x'| / |y| + |x| |y'| / y^2.
    fn quotient(&self, graph: &mut Graph, a: NodeId, b: NodeId) -> Constant {
        let (limit, nearest) = (graph.range(a).magnitude(), graph.range(b).nearest_to_zero());
        if !(limit.is_finite() && nearest > 0.0) {
            return Err(Reason::Unbounded("/"));
        }
        let (x, y) = (self.constant(a)?, self.constant(b)?);
        let (above, below) = (1.0 / nearest, limit / (nearest * nearest));
        let (above, below) = (graph.number(above), graph.number(below));
        let parts = [graph.mul(x, above), graph.mul(y, below)];
        Ok(graph.add(parts[0], parts[1]))
    }

    /// A power with a constant exponent: its slope n x^(n - 1) is steepest at an end of the range.
    fn power(&self, graph: &mut Graph, a: NodeId, b: NodeId) -> Constant {
        let (base, exponent) = (graph.range(a), graph.range(b));
        let n = exponent.lo;
        let end = if n >= 1.0 { base.hi } else { base.lo };
        let steepest = n.abs() * end.powf(n - 1.0);
        if n != exponent.hi || base.lo < 0.0 || !steepest.is_finite() {
            return Err(Reason::Unbounded("pow"));
        }
        let (factor, inner) = (graph.number(steepest), self.constant(a)?);
        Ok(graph.mul(factor, inner))
    }

    /// A mix by a t from 0 to 1 that depends on the point: max(La, Lb) + |b - a| Lt, for numbers.
    fn varying_mix(&self, graph: &mut Graph, [a, b, t]: [NodeId; 3]) -> Constant {
        let (from, to, share) = (graph.range(a), graph.range(b), graph.range(t));
        let apart = (to.hi - from.lo).max(from.hi - to.lo);
        if !share.is_fraction() || !apart.is_finite() || graph.ty(a).width() != 1 {
            return Err(Reason::Unbounded("mix"));
        }
        let (x, y, z) = (self.constant(a)?, self.constant(b)?, self.constant(t)?);
        let (moved, apart) = (graph.max(x, y), graph.number(apart));
        let turned = graph.mul(apart, z);
        Ok(graph.add(moved, turned))
    }

    /// The slope of `smoothstep` between two fixed edges is at most 1.5 / (hi - lo).
    fn smoothstep(&self, graph: &mut Graph, [lo, hi, x]: [NodeId; 3]) -> Constant {
        // The edges themselves, because their distance may be fixed where both move.
        let moves = graph.stage(lo) == Stage::Point || graph.stage(hi) == Stage::Point;
        let width = graph.sub(hi, lo);
        if moves || graph.range(width).nearest_to_zero() <= 0.0 {
            return Err(Reason::Unbounded("smoothstep"));
        }
        let steepest = graph.number(1.5);
        let steepest = graph.div(steepest, width);
        let (factor, inner) = (largest_lane(graph, steepest), self.constant(x)?);
        Ok(graph.mul(factor, inner))
    }

    pub(super) fn ternary(
        &self,
        graph: &mut Graph,
        op: Ternary,
        [a, b, c]: [NodeId; 3],
    ) -> Constant {
        match op {
            Ternary::Mix => self.mixture(graph, [a, b], c),
            Ternary::Clamp => {
                if !(self.is_fixed(graph, b) && self.is_fixed(graph, c)) {
                    return Err(Reason::Unbounded("clamp"));
                }
                self.constant(a)
            }
            Ternary::Smoothstep => self.smoothstep(graph, [a, b, c]),
            Ternary::Select => {
                if !self.is_fixed(graph, a) {
                    return Err(Reason::Jump("if"));
                }
                let (x, y) = (self.constant(b)?, self.constant(c)?);
                Ok(graph.max(x, y))
            }
        }
    }

    /// True if a node does not depend on the point of the formula. It may depend on the points of
    /// enclosing formulas, such as the index of a cell.
    fn is_fixed(&self, graph: &Graph, node: NodeId) -> bool {
        affine::is_fixed(graph, node, self.maps.level())
    }

    /// `mix(a, b, t)`: |1 - t| La + |t| Lb for a t that does not depend on any point. For a t from
    /// 0 to 1 that depends only on enclosing formulas, it is the larger one of La and Lb, or their
    /// hypotenuse if the lanes of t may differ.
    fn mixture(&self, graph: &mut Graph, [a, b]: [NodeId; 2], t: NodeId) -> Constant {
        let varies = graph.stage(t) == Stage::Point;
        if varies && !(self.is_fixed(graph, t) && graph.range(t).is_fraction()) {
            return self.varying_mix(graph, [a, b, t]);
        }
        let (x, y) = (self.constant(a)?, self.constant(b)?);
        if varies {
            // Lanes that differ in t may take from both.
            let is_one = graph.ty(t).width() == 1 || matches!(graph.node(t), Node::Splat(..));
            return Ok(if is_one { graph.max(x, y) } else { hypotenuse(graph, &[x, y]) });
        }
        let one = graph.number(1.0);
        let rest = graph.sub(one, t);
        let (left, right) = (largest_lane(graph, rest), largest_lane(graph, t));
        let (x, y) = (graph.mul(left, x), graph.mul(right, y));
        Ok(graph.add(x, y))
    }

    /// The constant of a vector of lanes. If the lanes depend on different components of the point,
    /// it is the largest constant of a lane, since the squares of the changes add up to no more
    /// than the square of the point's change. Otherwise it is the hypotenuse of the constants.
    pub(super) fn compose(&self, graph: &mut Graph, parts: &[NodeId]) -> Constant {
        let lanes: Vec<NodeId> =
            parts.iter().map(|&part| self.constant(part)).collect::<Result<_, _>>()?;
        if self.components.are_disjoint(parts) {
            return Ok(lanes.into_iter().reduce(|x, y| graph.max(x, y)).unwrap_or(parts[0]));
        }
        Ok(hypotenuse(graph, &lanes))
    }

    pub(super) fn transform(&self, graph: &mut Graph, columns: [NodeId; 3], v: NodeId) -> Constant {
        if columns.iter().any(|&column| graph.stage(column) == Stage::Point) {
            return Err(Reason::Unbounded("*"));
        }
        let factor = match affine::matrix_norm(graph, columns) {
            Some(norm) => norm,
            None => {
                // The Frobenius norm is an upper bound of the largest singular value.
                let lengths = columns.map(|column| graph.length(column));
                hypotenuse(graph, &lengths)
            }
        };
        let inner = self.constant(v)?;
        Ok(graph.mul(factor, inner))
    }
}

/// The steepest slope of a function within a range. `None` if it has none there, or if another rule
/// holds everywhere.
pub(in crate::certify) fn steepest_slope(op: Unary, range: Range) -> Option<f64> {
    let steepest = match op {
        Unary::Sqrt if range.lo > 0.0 => 0.5 / range.lo.sqrt(),
        Unary::InverseSqrt if range.lo > 0.0 => 0.5 * range.lo.powf(-1.5),
        Unary::Exp => range.hi.exp(),
        Unary::Exp2 => std::f64::consts::LN_2 * range.hi.exp2(),
        Unary::Log if range.lo > 0.0 => 1.0 / range.lo,
        Unary::Log2 if range.lo > 0.0 => std::f64::consts::LOG2_E / range.lo,
        Unary::Asin | Unary::Acos => (1.0 - range.magnitude().powi(2)).sqrt().recip(),
        Unary::Sinh | Unary::Cosh => range.magnitude().cosh(),
        Unary::Sqrt
        | Unary::InverseSqrt
        | Unary::Log
        | Unary::Log2
        | Unary::Tan
        | Unary::Normalize
        | Unary::Neg
        | Unary::Abs
        | Unary::Sign
        | Unary::Floor
        | Unary::Ceil
        | Unary::Round
        | Unary::Trunc
        | Unary::Fract
        | Unary::Sin
        | Unary::Cos
        | Unary::Atan
        | Unary::Tanh
        | Unary::Saturate
        | Unary::Length
        | Unary::Not => return None,
    };
    steepest.is_finite().then_some(steepest)
}
