//! Which nodes have a derivative that is not 0.

use crate::graph::Graph;
use crate::ids::IdSet;
use crate::node::{Binary, Node, NodeId, Type, Unary};

/// The nodes whose value depends on one of the inputs.
pub(super) fn live_nodes(graph: &Graph, order: &[NodeId], inputs: &IdSet) -> IdSet {
    let mut live = IdSet::default();
    for &id in order {
        let is_live = inputs.contains(id)
            || (passes_derivatives(graph, id)
                && graph.inputs(id).into_iter().any(|input| live.contains(input)));
        if is_live {
            live.insert(id);
        }
    }
    live
}

/// True if a node's value changes continuously with its arguments.
fn passes_derivatives(graph: &Graph, id: NodeId) -> bool {
    match graph.node(id) {
        Node::Const(_)
        | Node::Point(..)
        | Node::Frame(..)
        | Node::Variable(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => false,
        Node::Loop(.., ty) => ty != Type::Bool,
        Node::Unary(op, _) => !matches!(
            op,
            Unary::Sign | Unary::Floor | Unary::Ceil | Unary::Round | Unary::Trunc | Unary::Not
        ),
        Node::Binary(op, ..) => !matches!(
            op,
            Binary::Step
                | Binary::Hash
                | Binary::Lt
                | Binary::Le
                | Binary::Eq
                | Binary::Ne
                | Binary::And
                | Binary::Or
        ),
        Node::Ternary(..)
        | Node::Splat(..)
        | Node::Compose(..)
        | Node::Swizzle(..)
        | Node::Transform(..) => graph.ty(id) != Type::Bool,
    }
}
