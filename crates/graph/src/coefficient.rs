//! Coefficients of affine maps of the point.

use crate::graph::Graph;
use crate::node::NodeId;

/// A coefficient of an affine map, independent of the point. Numbers stay out of the arena, since
/// most are only intermediate results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coefficient {
    /// A number, finite.
    Number(f64),
    /// A scalar that does not depend on the point.
    Node(NodeId),
}

impl Coefficient {
    /// 0.
    pub const ZERO: Self = Self::Number(0.0);
    /// 1.
    pub const ONE: Self = Self::Number(1.0);

    /// The coefficient that equals a scalar node.
    pub fn of(graph: &Graph, node: NodeId) -> Self {
        graph.as_number(node).map_or(Self::Node(node), Self::Number)
    }

    /// The coefficient as a node.
    pub fn node(self, graph: &mut Graph) -> NodeId {
        match self {
            Self::Number(value) => graph.number(value),
            Self::Node(node) => node,
        }
    }

    /// The number, if it is known when the scene compiles.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(value),
            Self::Node(_) => None,
        }
    }

    /// True if the coefficient is this number.
    pub fn is(self, value: f64) -> bool {
        self == Self::Number(value)
    }

    /// The sum.
    pub fn plus(self, graph: &mut Graph, other: Self) -> Self {
        if other.is(0.0) {
            return self;
        }
        if self.is(0.0) {
            return other;
        }
        Self::join(graph, [self, other], |x, y| x + y, Graph::add)
    }

    /// The difference.
    pub fn minus(self, graph: &mut Graph, other: Self) -> Self {
        if other.is(0.0) {
            return self;
        }
        Self::join(graph, [self, other], |x, y| x - y, Graph::sub)
    }

    /// The product.
    pub fn times(self, graph: &mut Graph, other: Self) -> Self {
        if self.is(0.0) || other.is(1.0) {
            return self;
        }
        if other.is(0.0) || self.is(1.0) {
            return other;
        }
        Self::join(graph, [self, other], |x, y| x * y, Graph::mul)
    }

    /// The quotient.
    pub fn over(self, graph: &mut Graph, other: Self) -> Self {
        if other.is(1.0) {
            return self;
        }
        Self::join(graph, [self, other], |x, y| x / y, Graph::div)
    }

    /// Combines two numbers by `of_numbers` where that is finite, else two nodes by `of_nodes`.
    fn join(
        graph: &mut Graph,
        [a, b]: [Self; 2],
        of_numbers: fn(f64, f64) -> f64,
        of_nodes: fn(&mut Graph, NodeId, NodeId) -> NodeId,
    ) -> Self {
        if let (Self::Number(x), Self::Number(y)) = (a, b) {
            let value = of_numbers(x, y);
            if value.is_finite() {
                return Self::Number(value);
            }
        }
        let (a, b) = (a.node(graph), b.node(graph));
        let joined = of_nodes(graph, a, b);
        Self::of(graph, joined)
    }
}
