//! Which nodes a function needs, and how often each is written.

use rustc_hash::FxHashMap;
use sdfc_graph::{Binary, Graph, Node, NodeId, Type, Unary, reachable_where};

use crate::inputs::Inputs;

/// How often each node that the roots need is written in the text.
#[derive(Debug)]
pub(crate) struct Uses {
    counts: FxHashMap<NodeId, u32>,
    order: Vec<NodeId>,
}

impl Uses {
    /// Counts from the roots down. Nodes computed outside the shader need no arguments.
    pub(crate) fn count(graph: &Graph, roots: &[NodeId], inputs: &Inputs) -> Self {
        let order = reachable_where(graph, roots, |node| !inputs.is_slot(node));
        let mut counts = FxHashMap::default();
        for &root in roots {
            *counts.entry(root).or_insert(0) += 1;
        }
        // Users have greater ids, so a node's count is complete when it is met.
        for &id in order.iter().rev().filter(|&&id| !inputs.is_slot(id)) {
            let node = graph.node(id);
            // A component is written out at each of its uses, and its vector with it.
            let times = if is_component(&node) {
                counts.get(&id).copied().unwrap_or(1)
            } else {
                repeats(&node)
            };
            for argument in node.arguments() {
                *counts.entry(argument).or_insert(0) += times;
            }
        }
        Self { counts, order }
    }

    /// How often the node is written.
    pub(crate) fn of(&self, id: NodeId) -> u32 {
        self.counts.get(&id).copied().unwrap_or(0)
    }

    /// How many nodes there are.
    pub(crate) fn len(&self) -> usize {
        self.order.len()
    }

    /// The node at a position, arguments before their uses.
    pub(crate) fn node(&self, position: usize) -> NodeId {
        self.order[position]
    }
}

/// Whether the node is one component of a vector: `q.x` is as short as a name.
pub(crate) fn is_component(node: &Node) -> bool {
    matches!(node, Node::Swizzle(Type::Scalar, ..))
}

/// How often the lowering of a node writes its arguments.
fn repeats(node: &Node) -> u32 {
    match node {
        Node::Unary(Unary::Normalize, _) | Node::Binary(Binary::Rem, ..) => 2,
        Node::Const(_)
        | Node::Point(..)
        | Node::Frame(..)
        | Node::Unary(..)
        | Node::Binary(..)
        | Node::Ternary(..)
        | Node::Splat(..)
        | Node::Compose(..)
        | Node::Swizzle(..)
        | Node::Transform(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => 1,
    }
}
