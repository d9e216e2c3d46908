//! The affine maps in one formula, computed on demand and cached.

use rustc_hash::FxHashMap;
use sdfc_graph::{Graph, NodeId, reachable_where};

use crate::certify::affine::{self, Linear};

/// The linear parts of the nodes that were queried, and of the nodes they are computed from.
pub(crate) struct Maps {
    /// Level of the formula's point.
    level: u16,
    /// `None` for a node that is not affine, as most are. Nodes that do not depend on the point are
    /// absent.
    known: FxHashMap<NodeId, Option<Box<Linear>>>,
}

impl Maps {
    /// An empty cache for a formula in the point of `level`.
    pub(crate) fn new(level: u16) -> Self {
        Self { level, known: FxHashMap::default() }
    }

    /// Level of the formula's point.
    pub(crate) fn level(&self) -> u16 {
        self.level
    }

    /// The linear part of a node that depends on the point; `None` if it is not affine.
    pub(crate) fn linear(&mut self, graph: &mut Graph, node: NodeId) -> Option<&Linear> {
        if !self.known.contains_key(&node) {
            let enter = |id| !self.known.contains_key(&id);
            for id in reachable_where(graph, &[node], enter) {
                self.visit(graph, id);
            }
        }
        self.known.get(&node)?.as_deref()
    }

    /// As [`Maps::linear`], for a node whose arguments have been queried or visited.
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

    /// True if the node is an isometric map of the point: it keeps all distances.
    pub(crate) fn is_isometry(&mut self, graph: &mut Graph, q: NodeId) -> bool {
        let one = graph.number(1.0);
        self.is_similarity(graph, q, one)
    }

    /// Applies the linear part of a node to a direction. Returns the direction unchanged if the
    /// node is not affine.
    pub(crate) fn direction(&mut self, graph: &mut Graph, q: NodeId, direction: NodeId) -> NodeId {
        match self.linear(graph, q) {
            Some(linear) => affine::applied(graph, linear, direction),
            None => direction,
        }
    }

    /// True if the node divides all distances by `factor`, so that `factor` times a distance
    /// sampled there is a distance again.
    pub(crate) fn is_similarity(&mut self, graph: &mut Graph, q: NodeId, factor: NodeId) -> bool {
        let Some(linear) = self.linear(graph, q) else { return false };
        let Some(scale) = affine::similarity(graph, linear) else { return false };
        let product = graph.mul(scale, factor);
        if let Some(value) = graph.as_number(product) {
            return (value.abs() - 1.0).abs() < 1e-12;
        }
        // A factor that depends on a param: equal values are one node.
        let one = graph.number(1.0);
        let inverse = graph.div(one, factor);
        scale == inverse || scale == graph.abs(inverse)
    }
}
