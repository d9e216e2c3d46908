//! How fast a formula can change: a Lipschitz constant per node, in the Euclidean norm.
//!
//! The constant of a node is itself a node, known before the point is, so that a constant that
//! depends on a param follows the param. Rules after language reference, section "Promises".

use rustc_hash::{FxBuildHasher, FxHashMap};
use sdfc_graph::{
    Binary, Graph, LoopId, LoopVar, Node, NodeId, Polynomial, ShapeId, Stage, Ternary, Unary,
    reachable,
};

use crate::certify::affine;
use crate::certify::components::Components;
use crate::certify::maps::Maps;
use crate::certify::mixed_lanes;

/// Why no constant could be derived.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The value jumps: `floor`, `round`, `%`, `sign`, `step`, or a choice made at the point.
    Jump(&'static str),
    /// An operation whose slope depends on where it is taken.
    Unbounded(&'static str),
    /// An operation whose slope is, within the bounds, many times in places what it mostly is.
    SteepInPlaces(&'static str),
    /// A shape that is built anew at each point.
    Varying(String),
    /// A child without a constant.
    Child(String),
    /// A stated constant that is infinite, as one over bounds that are.
    Infinite,
    /// A stated constant that follows from bounds, of a shape that states none itself.
    NoBounds,
    /// A constant that holds only within the child's bounds, used where the point may lie outside.
    Within(String),
}

impl std::fmt::Display for Reason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Jump(what) => write!(f, "`{what}` of a value that depends on the point jumps"),
            Self::Unbounded(what) => {
                write!(
                    f,
                    "the slope of `{what}` depends on the point, and no bounds limit it; state \
                     `lipschitz`, or finite `bounds`"
                )
            }
            Self::SteepInPlaces(what) => {
                write!(
                    f,
                    "the slope of `{what}` is in places many times what it mostly is, so that dividing by the \
                     greatest would cost more than it is worth; state `lipschitz`, or closer `bounds`"
                )
            }
            Self::Varying(name) => write!(f, "`{name}` is another shape at each point"),
            Self::Child(name) => write!(f, "`{name}` has no constant"),
            Self::Infinite => f.write_str("its constant is infinite, since its bounds are"),
            Self::NoBounds => {
                f.write_str("its constant follows from bounds, so it has to state `bounds` itself")
            }
            Self::Within(name) => {
                write!(
                    f,
                    "the constant of `{name}` holds within its bounds, and this looks past them"
                )
            }
        }
    }
}

/// A constant, or why there is none.
pub type Constant = Result<NodeId, Reason>;

/// Rounds of a loop that are followed to find how far a constant grows.
const MOST_ROUNDS: u32 = 16;

/// Constants of the nodes of one formula.
pub(crate) struct Slopes {
    /// The nodes of the formula, and those that claims there speak of; arguments before their uses.
    pub(crate) nodes: Vec<NodeId>,
    constants: FxHashMap<NodeId, Constant>,
    /// Where the formula samples its children.
    pub(crate) maps: Maps,
    components: Components,
}

impl Slopes {
    /// The constants of everything that `roots` reach, in the point of `level`; `shapes` gives those
    /// of the shapes that are sampled.
    pub(crate) fn of(
        graph: &mut Graph,
        roots: &[NodeId],
        level: u16,
        shapes: &dyn Fn(ShapeId) -> Constant,
    ) -> Self {
        let nodes = with_claimed_arguments(graph, roots);
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
        let stretch = linear.and_then(|linear| affine::stretch(graph, linear));
        let constant = match (stretch, graph.node(node)) {
            (Some(constant), _) => Ok(constant),
            (None, Node::Variable(..)) => return, // known since its loop was entered
            (None, Node::Loop(id, position, _)) => {
                self.after_loop(graph, id, level, shapes).map(|all| all[usize::from(position)])
            }
            (None, _) => self.by_rule(graph, node, level, shapes),
        };
        let constant = self.with_claim(graph, node, constant);
        self.constants.insert(node, constant);
    }

    /// The constants of a loop's state after any number of rounds: those that a round does not raise, or
    /// those after the most rounds if these are few.
    fn after_loop(
        &mut self,
        graph: &mut Graph,
        id: LoopId,
        level: u16,
        shapes: &dyn Fn(ShapeId) -> Constant,
    ) -> Result<Vec<NodeId>, Reason> {
        let repeated = graph.loop_at(id).clone();
        if repeated.condition.is_some() {
            return Err(Reason::Jump("while"));
        }
        let start = repeated.init.iter().map(|&part| self.constant(part));
        let mut known: Vec<NodeId> = start.collect::<Result<_, _>>()?;
        let body = graph.loop_body(id);
        for _ in 0..repeated.max_iterations.min(MOST_ROUNDS) {
            for &node in &body.step {
                if let Node::Variable(_, place, _) = graph.node(node) {
                    let constant = match place {
                        // The same at every point.
                        LoopVar::Index => graph.number(0.0),
                        LoopVar::State(position) => known[usize::from(position)],
                    };
                    self.constants.insert(node, Ok(constant));
                } else {
                    self.visit(graph, node, level, shapes);
                }
            }
            let next = repeated.step.iter().map(|&part| self.constant(part));
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
        if repeated.max_iterations <= MOST_ROUNDS {
            Ok(known)
        } else {
            Err(Reason::Unbounded("iterate"))
        }
    }

    /// The constant of a node that the roots reach.
    pub(crate) fn constant(&self, node: NodeId) -> Constant {
        self.constants.get(&node).cloned().unwrap_or(Err(Reason::Unbounded("this")))
    }

    /// The derived constant, or the one that the node's function states if that is better.
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
        if self.is_still(graph, node) {
            return Ok(graph.number(0.0));
        }
        match graph.node(node) {
            Node::Const(_) | Node::Frame(..) => Ok(graph.number(0.0)),
            Node::Variable(..) | Node::Loop(..) => Err(Reason::Unbounded("iterate")),
            Node::Element(..) => Err(Reason::Jump("[ ]")),
            Node::Point(..) => Ok(graph.number(1.0)),
            Node::Unary(op, a) => self.unary(op, a),
            Node::Binary(Binary::Add | Binary::Sub, a, b) if self.components.are_apart(&[a, b]) => {
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
                let factor = graph.number(repeats(&lanes[..ty.width()]).sqrt());
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

    /// Whether a node is computed from what does not vary with the point, such as the number of a round.
    fn is_still(&self, graph: &Graph, node: NodeId) -> bool {
        let still =
            |id| self.constants.get(&id).is_some_and(|c| matches!(c, Ok(c) if is_zero(graph, *c)));
        let mut arguments = graph.arguments(node).peekable();
        !matches!(graph.node(node), Node::Sample(..) | Node::MaterialAt(..))
            && arguments.peek().is_some()
            && arguments.all(still)
    }

    fn unary(&self, op: Unary, a: NodeId) -> Constant {
        match op {
            // Maps that never stretch: |u(x) - u(y)| <= |x - y|, lane by lane.
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
            Binary::Div => Err(Reason::Unbounded("/")),
            Binary::Dot => Err(Reason::Unbounded("dot")),
            Binary::Cross => Err(Reason::Unbounded("cross")),
            Binary::Pow => Err(Reason::Unbounded("pow")),
            Binary::Atan2 => Err(Reason::Unbounded("atan2")),
            Binary::Rem => Err(Reason::Jump("%")),
            Binary::Step => Err(Reason::Jump("step")),
            Binary::Hash => Err(Reason::Jump("hash")),
            Binary::Lt | Binary::Le => Err(Reason::Jump("<")),
            Binary::Eq | Binary::Ne => Err(Reason::Jump("==")),
            Binary::And | Binary::Or => Err(Reason::Jump("&&")),
        }
    }

    /// |xy - uv| <= max|x| |y - v| + max|y| |x - u|, of factors that stay within limits, such as sines; the
    /// hypotenuse of the two where the factors look at different components of the point.
    fn product(&self, graph: &mut Graph, a: NodeId, b: NodeId) -> Constant {
        let limit = |id| graph.range(id).lo.abs().max(graph.range(id).hi.abs());
        let (of_a, of_b) = (limit(a), limit(b));
        if !(of_a.is_finite() && of_b.is_finite()) {
            return Err(Reason::Unbounded("*"));
        }
        let (x, y) = (self.constant(a)?, self.constant(b)?);
        let (of_a, of_b) = (graph.number(of_a), graph.number(of_b));
        let parts = [graph.mul(x, of_b), graph.mul(y, of_a)];
        if self.components.are_apart(&[a, b]) && graph.ty(a).width() == 1 {
            return Ok(hypotenuse(graph, &parts));
        }
        Ok(graph.add(parts[0], parts[1]))
    }

    fn ternary(&self, graph: &mut Graph, op: Ternary, [a, b, c]: [NodeId; 3]) -> Constant {
        match op {
            // |(1 - t)| La + |t| Lb for a t that does not vary.
            Ternary::Mix => {
                if graph.stage(c) == Stage::Point {
                    return Err(Reason::Unbounded("mix"));
                }
                let one = graph.number(1.0);
                let rest = graph.sub(one, c);
                let (left, right) = (largest_lane(graph, rest), largest_lane(graph, c));
                let (x, y) = (self.constant(a)?, self.constant(b)?);
                let (x, y) = (graph.mul(left, x), graph.mul(right, y));
                Ok(graph.add(x, y))
            }
            Ternary::Clamp => {
                if graph.stage(b) == Stage::Point || graph.stage(c) == Stage::Point {
                    return Err(Reason::Unbounded("clamp"));
                }
                self.constant(a)
            }
            Ternary::Smoothstep => Err(Reason::Unbounded("smoothstep")),
            Ternary::Select => {
                if graph.stage(a) == Stage::Point {
                    return Err(Reason::Jump("if"));
                }
                let (x, y) = (self.constant(b)?, self.constant(c)?);
                Ok(graph.max(x, y))
            }
        }
    }

    /// The lanes' constants joined: the largest where the lanes look at different components of the point
    /// (the squares of the changes then add up to no more than the point's), else their hypotenuse, or less where the lanes mix
    /// what was folded.
    fn compose(&self, graph: &mut Graph, parts: &[NodeId]) -> Constant {
        let constants: Vec<NodeId> =
            parts.iter().map(|&part| self.constant(part)).collect::<Result<_, _>>()?;
        if self.components.are_apart(parts) {
            return Ok(constants.into_iter().reduce(|x, y| graph.max(x, y)).unwrap_or(parts[0]));
        }
        let joined = hypotenuse(graph, &constants);
        match mixed_lanes::constant(graph, parts, self.maps.level()) {
            Some(together) => {
                let together = graph.number(together);
                Ok(graph.min(joined, together))
            }
            None => Ok(joined),
        }
    }

    fn transform(&self, graph: &mut Graph, columns: [NodeId; 3], v: NodeId) -> Constant {
        if columns.iter().any(|&column| graph.stage(column) == Stage::Point) {
            return Err(Reason::Unbounded("*"));
        }
        // The Frobenius norm bounds the largest singular value.
        let lengths = columns.map(|column| graph.length(column));
        let factor = hypotenuse(graph, &lengths);
        let inner = self.constant(v)?;
        Ok(graph.mul(factor, inner))
    }
}

/// All that the roots reach, and the arguments that claims there speak of: simplification may have taken an
/// argument apart.
fn with_claimed_arguments(graph: &Graph, roots: &[NodeId]) -> Vec<NodeId> {
    let mut roots = roots.to_vec();
    loop {
        let order = reachable(graph, &roots);
        let claims = order.iter().filter_map(|&node| graph.lipschitz_claim(node));
        let missing: Vec<NodeId> = claims
            .flat_map(|claim| claim.arguments.iter().copied())
            .filter(|argument| order.binary_search(argument).is_err())
            .collect();
        if missing.is_empty() {
            return order;
        }
        roots.extend(missing);
    }
}

/// How often the commonest lane is taken: `v.xxy` changes by up to sqrt(2) times as much as v.
fn repeats(lanes: &[u8]) -> f64 {
    let count = |lane: &u8| lanes.iter().filter(|other| *other == lane).count();
    lanes.iter().map(count).max().unwrap_or(1) as f64
}

fn is_zero(graph: &Graph, node: NodeId) -> bool {
    graph.as_number(node) == Some(0.0)
}

/// The length of a vector that is the same for all values of params, as of a sine and cosine.
fn fixed_length(graph: &Graph, parts: &[NodeId]) -> Option<f64> {
    let mut sum = Polynomial::zero();
    for &part in parts {
        // Squares have no sign.
        let signed = if let Node::Unary(Unary::Abs, x) = graph.node(part) { x } else { part };
        let term = Polynomial::of(graph, signed)?;
        sum = sum.plus(&term.times(&term)?);
    }
    sum.constant().map(f64::sqrt)
}

/// The largest of the lanes' magnitudes.
fn largest_lane(graph: &mut Graph, node: NodeId) -> NodeId {
    let width = graph.ty(node).width() as u8;
    let magnitude = graph.abs(node);
    let mut largest = graph.component(magnitude, 0);
    for lane in 1..width {
        let other = graph.component(magnitude, lane);
        largest = graph.max(largest, other);
    }
    largest
}

fn hypotenuse(graph: &mut Graph, parts: &[NodeId]) -> NodeId {
    let varying: Vec<NodeId> = parts.iter().copied().filter(|&x| !is_zero(graph, x)).collect();
    match varying[..] {
        [] => graph.number(0.0),
        [one] => one,
        _ => {
            if let Some(length) = fixed_length(graph, &varying) {
                return graph.number(length);
            }
            let mut sum = graph.number(0.0);
            for x in varying {
                let square = graph.mul(x, x);
                sum = graph.add(sum, square);
            }
            graph.unary(Unary::Sqrt, sum)
        }
    }
}
