//! The rules by which the norm of a node's derivative follows from those of its arguments.

use rustc_hash::FxHashMap;
use sdfc_graph::{Binary, Graph, Node, NodeId, SoftExtreme, Stage, Ternary, Unary};

use crate::certify::components::Components;
use crate::certify::corner::corner_distance;
use crate::certify::norms::max_repeats;

/// Largest number of terms of a sum that are combined.
const MAX_TERMS: usize = 16;

/// How a node's slope follows from those of its arguments, which are indices of earlier nodes.
pub(super) enum Rule {
    /// It does not depend on the point.
    Constant,
    /// It is the point.
    Point,
    /// The slope of the argument, times a number.
    Scaled(f64, usize),
    /// A function of each lane, whose slope depends on the lane's range.
    Lanewise(Unary, usize),
    /// The direction of a vector.
    Normalize(usize),
    /// A sum of numbers with their signs.
    Sum(Vec<(usize, f64)>),
    /// A product, lane by lane. The flag is true for two numbers that depend on different
    /// components of the point.
    Product { a: usize, b: usize, is_disjoint: bool },
    /// A quotient, lane by lane.
    Quotient(usize, usize),
    /// A dot or cross product.
    Dot(usize, usize),
    /// A mixture of two numbers.
    Mix(usize, usize, usize),
    /// One of the arguments, or all of them if they depend on different components of the point.
    Largest(Vec<usize>),
    /// A vector of the arguments, or a selection from them lane by lane.
    Hypotenuse(Vec<usize>),
    /// A function with a Lipschitz annotation.
    Claimed { rule: Box<Rule>, lipschitz: f64, arguments: Vec<usize> },
    /// Only the intervals of the derivatives are known.
    Unknown,
}

/// Makes the rules of a field's nodes, arguments before uses.
pub(super) struct Rules {
    indices: FxHashMap<NodeId, usize>,
    components: Components,
    order: Vec<NodeId>,
}

impl Rules {
    /// For nodes with these indices.
    pub(super) fn new(nodes: &[NodeId], indices: FxHashMap<NodeId, usize>) -> Self {
        Self { indices, components: Components::default(), order: nodes.to_vec() }
    }

    /// The rule of a node, after those of its arguments.
    pub(super) fn rule(&mut self, graph: &mut Graph, node: NodeId) -> Rule {
        self.components.visit(graph, node, 0);
        let rule = self.form(graph, node).unwrap_or(Rule::Unknown);
        self.with_claim(graph, node, rule)
    }

    fn with_claim(&self, graph: &Graph, node: NodeId, rule: Rule) -> Rule {
        let Some(claim) = graph.lipschitz_claim(node) else { return rule };
        let arguments: Option<Vec<usize>> =
            claim.arguments.iter().map(|argument| self.index(*argument)).collect();
        match (graph.as_number(claim.lipschitz), arguments) {
            (Some(lipschitz), Some(arguments)) => {
                Rule::Claimed { rule: Box::new(rule), lipschitz, arguments }
            }
            (None, _) | (_, None) => rule,
        }
    }

    fn index(&self, node: NodeId) -> Option<usize> {
        self.indices.get(&node).copied()
    }

    fn form(&self, graph: &mut Graph, node: NodeId) -> Option<Rule> {
        if graph.stage(node) < Stage::Point {
            return Some(Rule::Constant);
        }
        if let Some(SoftExtreme { operands, .. }) = graph.as_soft_extreme(node) {
            return self.largest(&operands);
        }
        if let Some(offset) = corner_distance(graph, node) {
            return Some(Rule::Scaled(1.0, self.index(offset)?));
        }
        let width = graph.ty(node).width();
        let is_number = width == 1;
        let disjoint = |nodes: &[NodeId]| self.components.are_disjoint(nodes);
        match graph.node(node) {
            Node::Const(_) | Node::Frame(..) => Some(Rule::Constant),
            Node::Point(..) => Some(Rule::Point),
            Node::Unary(op, a) => unary(op, self.index(a)?),
            Node::Binary(Binary::Add | Binary::Sub, a, b) if disjoint(&[a, b]) => {
                self.hypotenuse(&[a, b])
            }
            Node::Binary(Binary::Add | Binary::Sub, ..) if is_number => self.sum(graph, node),
            Node::Binary(Binary::Min | Binary::Max, a, b) if is_number => self.largest(&[a, b]),
            Node::Binary(Binary::Min | Binary::Max, a, b) => self.hypotenuse(&[a, b]),
            Node::Binary(Binary::Mul, a, b) => {
                let is_disjoint = is_number && disjoint(&[a, b]);
                Some(Rule::Product { a: self.index(a)?, b: self.index(b)?, is_disjoint })
            }
            Node::Binary(Binary::Div, a, b) => Some(Rule::Quotient(self.index(a)?, self.index(b)?)),
            Node::Binary(Binary::Dot | Binary::Cross, a, b) => {
                Some(Rule::Dot(self.index(a)?, self.index(b)?))
            }
            Node::Ternary(Ternary::Clamp, all) if is_number => self.largest(&all),
            Node::Ternary(Ternary::Clamp, all) => self.hypotenuse(&all),
            Node::Ternary(Ternary::Select, [_, a, b]) => self.largest(&[a, b]),
            Node::Ternary(Ternary::Mix, [a, b, t]) if is_number => {
                Some(Rule::Mix(self.index(a)?, self.index(b)?, self.index(t)?))
            }
            Node::Splat(_, a) => Some(Rule::Scaled((width as f64).sqrt(), self.index(a)?)),
            Node::Compose(_, parts) if disjoint(&parts[..width]) => self.largest(&parts[..width]),
            Node::Compose(_, parts) => self.hypotenuse(&parts[..width]),
            Node::Swizzle(_, a, lanes) => {
                Some(Rule::Scaled(max_repeats(&lanes[..width]).sqrt(), self.index(a)?))
            }
            Node::Binary(..)
            | Node::Ternary(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => None,
        }
    }

    fn largest(&self, nodes: &[NodeId]) -> Option<Rule> {
        let indices: Option<Vec<usize>> = nodes.iter().map(|&node| self.index(node)).collect();
        Some(Rule::Largest(indices?))
    }

    fn hypotenuse(&self, nodes: &[NodeId]) -> Option<Rule> {
        let indices: Option<Vec<usize>> = nodes.iter().map(|&node| self.index(node)).collect();
        Some(Rule::Hypotenuse(indices?))
    }

    /// The terms of a sum of numbers, and of the sums among them.
    fn sum(&self, graph: &mut Graph, root: NodeId) -> Option<Rule> {
        let (mut terms, mut pending) = (Vec::new(), vec![(self.index(root)?, 1.0)]);
        while let Some((index, sign)) = pending.pop() {
            let node = self.order[index];
            let is_full = terms.len() + pending.len() + 2 > MAX_TERMS;
            if is_full || node != root && has_own_rule(graph, node) {
                terms.push((index, sign));
                continue;
            }
            let Node::Binary(op @ (Binary::Add | Binary::Sub), a, b) = graph.node(node) else {
                terms.push((index, sign));
                continue;
            };
            let other = if op == Binary::Add { sign } else { -sign };
            pending.extend([(self.index(a)?, sign), (self.index(b)?, other)]);
        }
        Some(Rule::Sum(terms))
    }
}

/// True for a sum whose slope is known better than from its terms.
fn has_own_rule(graph: &mut Graph, sum: NodeId) -> bool {
    graph.as_soft_extreme(sum).is_some()
        || corner_distance(graph, sum).is_some()
        || graph.lipschitz_claim(sum).is_some()
}

fn unary(op: Unary, a: usize) -> Option<Rule> {
    match op {
        Unary::Neg
        | Unary::Abs
        | Unary::Sin
        | Unary::Cos
        | Unary::Atan
        | Unary::Tanh
        | Unary::Saturate
        | Unary::Length => Some(Rule::Scaled(1.0, a)),
        Unary::Sqrt
        | Unary::InverseSqrt
        | Unary::Exp
        | Unary::Exp2
        | Unary::Log
        | Unary::Log2
        | Unary::Asin
        | Unary::Acos
        | Unary::Sinh
        | Unary::Cosh => Some(Rule::Lanewise(op, a)),
        Unary::Normalize => Some(Rule::Normalize(a)),
        Unary::Sign
        | Unary::Floor
        | Unary::Ceil
        | Unary::Round
        | Unary::Trunc
        | Unary::Fract
        | Unary::Tan
        | Unary::Not => None,
    }
}
