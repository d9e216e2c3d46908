//! The affine maps of one formula's point, found where they are asked for.

use rustc_hash::FxHashMap;
use sdfc_graph::{Graph, NodeId, reachable_where};

use crate::certify::affine::{self, Linear};

/// Linear parts of nodes that were asked for, and of what these are computed from.
pub(crate) struct Maps {
    /// The level of the formula's point.
    level: u16,
    /// `None` of what is not affine, as most nodes are. Nodes that the point does not move are not listed.
    known: FxHashMap<NodeId, Option<Box<Linear>>>,
}

impl Maps {
    /// Of the point of `level`; nothing was asked for.
    pub(crate) fn new(level: u16) -> Self {
        Self { level, known: FxHashMap::default() }
    }

    /// The level of the formula's point.
    pub(crate) fn level(&self) -> u16 {
        self.level
    }

    /// The linear part of a node that the point moves; `None` if it is not affine.
    pub(crate) fn linear(&mut self, graph: &mut Graph, node: NodeId) -> Option<&Linear> {
        if !self.known.contains_key(&node) {
            let enter = |id| !self.known.contains_key(&id);
            for id in reachable_where(graph, &[node], enter) {
                self.visit(graph, id);
            }
        }
        self.known.get(&node)?.as_deref()
    }

    /// The same of a node whose arguments were asked for, or visited.
    pub(crate) fn visit(&mut self, graph: &mut Graph, node: NodeId) -> Option<&Linear> {
        if affine::is_fixed(graph, node, self.level) {
            return None;
        }
        if !self.known.contains_key(&node) {
            let linear = affine::linear_part(graph, node, self.level, &self.known);
            self.known.insert(node, linear.map(Box::new));
        }
        self.known.get(&node)?.as_deref()
    }

    /// Whether the node maps the point to a point of the same distances.
    pub(crate) fn is_isometry(&mut self, graph: &mut Graph, q: NodeId) -> bool {
        let one = graph.number(1.0);
        self.is_similarity(graph, q, one)
    }

    /// What the affine map of the point that a node is makes of a direction; the direction itself for another node.
    pub(crate) fn direction(&mut self, graph: &mut Graph, q: NodeId, direction: NodeId) -> NodeId {
        match self.linear(graph, q) {
            Some(linear) => affine::applied(graph, linear, direction),
            None => direction,
        }
    }

    /// Whether the node shrinks all distances of the point by `factor`: one that then stretches a
    /// sampled distance by it gives a distance again.
    pub(crate) fn is_similarity(&mut self, graph: &mut Graph, q: NodeId, factor: NodeId) -> bool {
        let Some(linear) = self.linear(graph, q) else { return false };
        let Some(stretch) = affine::similarity(graph, linear) else { return false };
        let product = graph.mul(stretch, factor);
        if let Some(value) = graph.as_number(product) {
            return (value.abs() - 1.0).abs() < 1e-12;
        }
        // A factor that follows a param: equal values are one node.
        let one = graph.number(1.0);
        let inverse = graph.div(one, factor);
        stretch == inverse || stretch == graph.abs(inverse)
    }
}
