//! The descent from a formula's root through hard minima and maxima, sign changes and samples.
//!
//! A scene's field consists of these operations near its root. The descent ends at every other
//! node, which callers treat as a whole.

use rustc_hash::FxHashSet;
use sdfc_graph::{Binary, Graph, Node, NodeId, ShapeId, Ternary, Type, Unary};

use crate::certify::affine::is_fixed;
use crate::certify::maps::Maps;
use crate::certify::quality::{is_fixed_shape, scaled_sample};

/// The kind of a node in the descent, with its operands.
pub(crate) enum Form {
    /// The minimum of two operands.
    Min(NodeId, NodeId),
    /// The maximum of two operands.
    Max(NodeId, NodeId),
    /// The negated operand.
    Neg(NodeId),
    /// A condition that does not depend on the point, and the operands it selects from.
    Select(NodeId, NodeId, NodeId),
    /// A shape, sampled at an isometric map of the point.
    Sample(ShapeId, NodeId),
    /// A factor times a shape that is sampled at a point scaled by its inverse.
    ScaledSample(NodeId, ShapeId, NodeId),
    /// Any other node.
    Other,
}

/// The nodes that the descent from a formula visits, arguments before uses.
pub(crate) fn chain_below(graph: &mut Graph, formula: NodeId, maps: &mut Maps) -> Vec<NodeId> {
    let mut seen = FxHashSet::default();
    let mut pending = vec![formula];
    while let Some(node) = pending.pop() {
        if !seen.insert(node) {
            continue;
        }
        match form(graph, node, maps) {
            Form::Min(a, b) | Form::Max(a, b) | Form::Select(_, a, b) => {
                pending.extend([a, b]);
            }
            Form::Neg(a) => pending.push(a),
            Form::Other | Form::Sample(..) | Form::ScaledSample(..) => {}
        }
    }
    let mut order: Vec<NodeId> = seen.into_iter().collect();
    order.sort_unstable();
    order
}

/// Classifies a node of a formula for the descent.
pub(crate) fn form(graph: &mut Graph, node: NodeId, maps: &mut Maps) -> Form {
    let scalar = graph.ty(node) == Type::Scalar;
    match graph.node(node) {
        Node::Binary(Binary::Min, a, b) if scalar => Form::Min(a, b),
        Node::Binary(Binary::Max, a, b) if scalar => Form::Max(a, b),
        Node::Unary(Unary::Neg, a) if scalar => Form::Neg(a),
        Node::Ternary(Ternary::Select, [condition, a, b])
            if scalar && is_fixed(graph, condition, maps.level()) =>
        {
            Form::Select(condition, a, b)
        }
        Node::Sample(child, q)
            if is_fixed_shape(graph, child, maps.level()) && maps.is_isometry(graph, q) =>
        {
            Form::Sample(child, q)
        }
        Node::Binary(Binary::Mul, a, b) => match scaled_sample(graph, a, b) {
            Some((factor, child, q))
                if is_fixed_shape(graph, child, maps.level())
                    && maps.is_similarity(graph, q, factor) =>
            {
                Form::ScaledSample(factor, child, q)
            }
            Some(_) | None => Form::Other,
        },
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
        | Node::Variable(..)
        | Node::Loop(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => Form::Other,
    }
}
