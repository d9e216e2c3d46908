//! Lipschitz constants of the nodes of a formula, in the Euclidean norm.
//!
//! The constant of a node is itself a node of a lower evaluation rate than the point, so that a
//! constant that depends on a param follows the param. The rules are those of the language
//! reference, section "Promises".

use rustc_hash::{FxBuildHasher, FxHashMap};
use sdfc_graph::{
    Binary, Graph, LoopId, LoopVar, Node, NodeId, Range, ShapeId, SoftExtreme, Stage, Ternary,
    Unary,
};

use crate::certify::affine;
use crate::certify::components::Components;
use crate::certify::corner::corner_distance;
use crate::certify::maps::Maps;
use crate::certify::norms::{
    hypotenuse, is_zero, largest_lane, max_repeats, with_annotated_arguments,
};
use crate::certify::piecewise;
use crate::certify::reason::{Constant, Reason};

/// Largest number of loop iterations that are followed to see how far a constant grows.
const MAX_ITERATIONS: u32 = 16;

/// The Lipschitz constants of the nodes of one formula.
pub(crate) struct Slopes {
    /// The nodes of the formula and the arguments of its annotated functions, arguments before
    /// uses.
    pub(crate) nodes: Vec<NodeId>,
    constants: FxHashMap<NodeId, Constant>,
    /// The affine maps of the formula, for instance the points where it samples its children.
    pub(crate) maps: Maps,
    components: Components,
}

impl Slopes {
    /// Derives the constants of all nodes that `roots` depend on, in the point of `level`. `shapes`
    /// returns the constant of a sampled shape.
    pub(crate) fn of(
        graph: &mut Graph,
        roots: &[NodeId],
        level: u16,
        shapes: &dyn Fn(ShapeId) -> Constant,
    ) -> Self {
        let nodes = with_annotated_arguments(graph, roots);
        let mut slopes = Self {
            nodes: Vec::new(),
            constants: FxHashMap::with_capacity_and_hasher(nodes.len(), FxBuildHasher),
            maps: Maps::new(level),
            components: Components::default(),
        };
        for &node in &nodes {
            if graph.loops_around(node) == 0 {
                slopes.visit(graph, node, level, shapes);
            }
        }
        Self { nodes, ..slopes }
    }

    fn visit(
        &mut self,
        graph: &mut Graph,
        node: NodeId,
        level: u16,
        shapes: &dyn Fn(ShapeId) -> Constant,
    ) {
        self.components.visit(graph, node, level);
        let linear = self.maps.visit(graph, node);
        let norm = linear.and_then(|linear| affine::operator_norm(graph, linear));
        let constant = match (norm, graph.node(node)) {
            (Some(constant), _) => Ok(constant),
            (None, Node::Variable(..)) => return, // set when its loop was entered
            (None, Node::Loop(id, position, _)) => {
                self.after_loop(graph, id, level, shapes).map(|all| all[usize::from(position)])
            }
            (None, _) => {
                let rule = self.by_rule(graph, node, level, shapes);
                rule.map(|rule| self.folded(graph, node, rule))
            }
        };
        let constant = self.with_claim(graph, node, constant);
        self.constants.insert(node, constant);
    }

    /// The constants of a loop's state after any number of iterations: constants that an iteration
    /// does not raise, or those after the last iteration if there are few.
    fn after_loop(
        &mut self,
        graph: &mut Graph,
        id: LoopId,
        level: u16,
        shapes: &dyn Fn(ShapeId) -> Constant,
    ) -> Result<Vec<NodeId>, Reason> {
        let looped = graph.loop_at(id).clone();
        if looped.condition.is_some() {
            return Err(Reason::Jump("while"));
        }
        let start = looped.init.iter().map(|&part| self.constant(part));
        let mut known: Vec<NodeId> = start.collect::<Result<_, _>>()?;
        let body = graph.loop_body(id);
        for _ in 0..looped.max_iterations.min(MAX_ITERATIONS) {
            for &node in &body.step {
                if let Node::Variable(_, variable, _) = graph.node(node) {
                    let constant = match variable {
                        // The index is the same at every point.
                        LoopVar::Index => graph.number(0.0),
                        LoopVar::State(position) => known[usize::from(position)],
                    };
                    self.constants.insert(node, Ok(constant));
                } else {
                    self.visit(graph, node, level, shapes);
                }
            }
            let next = looped.step.iter().map(|&part| self.constant(part));
            let next: Vec<NodeId> = next.collect::<Result<_, _>>()?;
            for node in &body.step {
                self.constants.remove(node);
            }
            let pairs = known.iter().zip(next);
            let raised: Vec<NodeId> = pairs.map(|(&x, y)| graph.max(x, y)).collect();
            if raised == known {
                return Ok(known);
            }
            known = raised;
        }
        if looped.max_iterations <= MAX_ITERATIONS {
            Ok(known)
        } else {
            Err(Reason::Unbounded("iterate"))
        }
    }

    /// The constant of a node that the roots depend on.
    pub(crate) fn constant(&self, node: NodeId) -> Constant {
        self.constants.get(&node).cloned().unwrap_or(Err(Reason::Unbounded("this")))
    }

    /// The smaller one of the derived constant and the constant of a Lipschitz annotation.
    fn with_claim(&self, graph: &mut Graph, node: NodeId, derived: Constant) -> Constant {
        let Some(claim) = graph.lipschitz_claim(node).cloned() else { return derived };
        let mut largest = graph.number(0.0);
        for argument in claim.arguments {
            match self.constants.get(&argument) {
                Some(Ok(constant)) => largest = graph.max(largest, *constant),
                Some(Err(_)) | None => return derived,
            }
        }
        let stated = graph.mul(claim.lipschitz, largest);
        match derived {
            Ok(derived) => Ok(graph.min(derived, stated)),
            Err(_) => Ok(stated),
        }
    }

    fn by_rule(
        &self,
        graph: &mut Graph,
        node: NodeId,
        level: u16,
        shapes: &dyn Fn(ShapeId) -> Constant,
    ) -> Constant {
        if affine::is_fixed(graph, node, level) {
            return Ok(graph.number(0.0));
        }
        if self.has_constant_arguments(graph, node) {
            return Ok(graph.number(0.0));
        }
        if let Some(SoftExtreme { operands: [a, b], .. }) = graph.as_soft_extreme(node) {
            // Its gradient is a mixture of those of its operands.
            let (x, y) = (self.constant(a)?, self.constant(b)?);
            return Ok(graph.max(x, y));
        }
        if let Some(offset) = corner_distance(graph, node) {
            return self.constant(offset);
        }
        match graph.node(node) {
            Node::Const(_) | Node::Frame(..) => Ok(graph.number(0.0)),
            Node::Variable(..) | Node::Loop(..) => Err(Reason::Unbounded("iterate")),
            Node::Element(..) => Err(Reason::Jump("[ ]")),
            Node::Point(..) => Ok(graph.number(1.0)),
            Node::Unary(op, a) => self.unary(graph, op, a),
            Node::Binary(Binary::Add | Binary::Sub, a, b)
                if self.components.are_disjoint(&[a, b]) =>
            {
                let constants = [self.constant(a)?, self.constant(b)?];
                Ok(hypotenuse(graph, &constants))
            }
            Node::Binary(op, a, b) => self.binary(graph, op, a, b),
            Node::Ternary(op, arguments) => self.ternary(graph, op, arguments),
            Node::Splat(ty, a) => {
                let inner = self.constant(a)?;
                let factor = graph.number((ty.width() as f64).sqrt());
                Ok(graph.mul(factor, inner))
            }
            Node::Compose(ty, parts) => self.compose(graph, &parts[..ty.width()]),
            Node::Swizzle(ty, a, lanes) => {
                let inner = self.constant(a)?;
                let factor = graph.number(max_repeats(&lanes[..ty.width()]).sqrt());
                Ok(graph.mul(factor, inner))
            }
            Node::Transform(columns, v) => self.transform(graph, columns, v),
            Node::Sample(shape, q) => {
                if graph.shape(shape).level > level {
                    return Err(Reason::Varying(graph.shape(shape).definition.clone()));
                }
                let (outer, inner) = (shapes(shape)?, self.constant(q)?);
                Ok(graph.mul(outer, inner))
            }
            Node::MaterialAt(..) => Err(Reason::Unbounded("material_at")),
        }
    }

    /// The smaller one of the constant by a rule and the constant of the node as a piecewise linear
    /// map, for operations that combine several values.
    fn folded(&self, graph: &mut Graph, node: NodeId, rule: NodeId) -> NodeId {
        let combines = matches!(
            graph.node(node),
            Node::Compose(..)
                | Node::Transform(..)
                | Node::Binary(Binary::Add | Binary::Sub | Binary::Min | Binary::Max, ..)
                | Node::Ternary(Ternary::Mix | Ternary::Clamp, _)
        );
        if !combines || graph.as_number(rule).is_some_and(|rule| rule <= 1.0) {
            return rule;
        }
        let known = |id| self.constants.get(&id).and_then(|constant| constant.clone().ok());
        match piecewise::constant(graph, node, self.maps.level(), &known) {
            Some(constant) => graph.min(rule, constant),
            None => rule,
        }
    }

    /// True if all arguments of a node have the constant 0, such as the index of an iteration.
    fn has_constant_arguments(&self, graph: &Graph, node: NodeId) -> bool {
        let is_constant =
            |id| self.constants.get(&id).is_some_and(|c| matches!(c, Ok(c) if is_zero(graph, *c)));
        let mut arguments = graph.arguments(node).peekable();
        !matches!(graph.node(node), Node::Sample(..) | Node::MaterialAt(..))
            && arguments.peek().is_some()
            && arguments.all(is_constant)
    }

    fn unary(&self, graph: &mut Graph, op: Unary, a: NodeId) -> Constant {
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

    fn binary(&self, graph: &mut Graph, op: Binary, a: NodeId, b: NodeId) -> Constant {
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

    fn ternary(&self, graph: &mut Graph, op: Ternary, [a, b, c]: [NodeId; 3]) -> Constant {
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
    fn compose(&self, graph: &mut Graph, parts: &[NodeId]) -> Constant {
        let lanes: Vec<NodeId> =
            parts.iter().map(|&part| self.constant(part)).collect::<Result<_, _>>()?;
        if self.components.are_disjoint(parts) {
            return Ok(lanes.into_iter().reduce(|x, y| graph.max(x, y)).unwrap_or(parts[0]));
        }
        Ok(hypotenuse(graph, &lanes))
    }

    fn transform(&self, graph: &mut Graph, columns: [NodeId; 3], v: NodeId) -> Constant {
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
pub(super) fn steepest_slope(op: Unary, range: Range) -> Option<f64> {
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
