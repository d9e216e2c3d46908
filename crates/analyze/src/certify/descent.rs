//! Hard minima and maxima, sign changes and rigid samples: what a scene's field is made of from its root down, until
//! something else stands there.

use rustc_hash::FxHashSet;
use sdfc_graph::{Binary, Graph, Node, NodeId, ShapeId, Stage, Ternary, Type, Unary};

use crate::certify::maps::Maps;
use crate::certify::quality::{is_one, scaled_sample};

/// How a node of a formula passes its value on.
pub(crate) enum Form {
    Least(NodeId, NodeId),
    Greatest(NodeId, NodeId),
    Negative(NodeId),
    Chosen(NodeId, NodeId, NodeId),
    Sampled(ShapeId, NodeId),
    Scaled(NodeId, ShapeId, NodeId),
    Whole,
}

/// The nodes that a descent from a formula visits, arguments before uses.
pub(crate) fn chain_below(graph: &mut Graph, formula: NodeId, maps: &mut Maps) -> Vec<NodeId> {
    let mut seen = FxHashSet::default();
    let mut pending = vec![formula];
    while let Some(node) = pending.pop() {
        if !seen.insert(node) {
            continue;
        }
        match form(graph, node, maps) {
            Form::Least(a, b) | Form::Greatest(a, b) | Form::Chosen(_, a, b) => {
                pending.extend([a, b]);
            }
            Form::Negative(a) => pending.push(a),
            Form::Whole | Form::Sampled(..) | Form::Scaled(..) => {}
        }
    }
    let mut order: Vec<NodeId> = seen.into_iter().collect();
    order.sort_unstable();
    order
}

/// How a descent goes on at a node of a formula.
pub(crate) fn form(graph: &mut Graph, node: NodeId, maps: &mut Maps) -> Form {
    let scalar = graph.ty(node) == Type::Scalar;
    match graph.node(node) {
        Node::Binary(Binary::Min, a, b) if scalar => Form::Least(a, b),
        Node::Binary(Binary::Max, a, b) if scalar => Form::Greatest(a, b),
        Node::Unary(Unary::Neg, a) if scalar => Form::Negative(a),
        Node::Ternary(Ternary::Select, [condition, a, b])
            if scalar && graph.stage(condition) < Stage::Point =>
        {
            Form::Chosen(condition, a, b)
        }
        Node::Sample(child, q)
            if is_one(graph, child, maps.level()) && maps.is_isometry(graph, q) =>
        {
            Form::Sampled(child, q)
        }
        Node::Binary(Binary::Mul, a, b) => match scaled_sample(graph, a, b) {
            Some((factor, child, q))
                if is_one(graph, child, maps.level()) && maps.is_similarity(graph, q, factor) =>
            {
                Form::Scaled(factor, child, q)
            }
            Some(_) | None => Form::Whole,
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
        | Node::MaterialAt(..) => Form::Whole,
    }
}
