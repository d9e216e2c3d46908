//! Lipschitz constants of the nodes of a formula, in the Euclidean norm.
//!
//! The constant of a node is itself a node of a lower evaluation rate than the point, so that a
//! constant that depends on a param follows the param. The rules are those of the language
//! reference, section "Promises".

mod rules;

use rustc_hash::{FxBuildHasher, FxHashMap};
use sdfc_graph::{Binary, Graph, LoopId, LoopVar, Node, NodeId, ShapeId, SoftExtreme, Ternary};

use crate::certify::affine;
use crate::certify::components::Components;
use crate::certify::corner::corner_distance;
use crate::certify::maps::Maps;
use crate::certify::norms::{hypotenuse, is_zero, max_repeats, with_annotated_arguments};
use crate::certify::piecewise;
use crate::certify::reason::{Constant, Reason};

pub(super) use rules::steepest_slope;

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
            // A number can be compared with others. The rule might be less for some values of the
            // params, but not for all.
            Some(norm) if graph.as_number(norm).is_some() && graph.as_number(rule).is_none() => {
                norm
            }
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
}
