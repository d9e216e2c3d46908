//! The derivative of one lane of a node by the lanes that it is computed from.
//!
//! A sum of multiples has one derivative. A fold, such as `abs` or `min`, has one on each side of
//! its crease. A function whose slope lies between two values, such as `sin`, counts as a fold with
//! these two slopes: the norm of a matrix is a convex function of its entries, so it is largest
//! where each slope is at an end.

use sdfc_graph::{Binary, Graph, Node, NodeId, SoftExtreme, Ternary, Unary};

use crate::certify::affine::is_fixed;

/// One lane of a node.
pub(super) type Lane = (NodeId, usize);

/// Multiples of lanes, whose sum changes as the lane they stand for does.
pub(super) type Terms = Vec<(Lane, f64)>;

/// The derivatives that a lane may have; `None` if its operation has others, or a coefficient is
/// not a constant. Terms that do not depend on the point of `level` may be among them.
pub(super) fn branches(graph: &mut Graph, lane: Lane, level: u16) -> Option<Vec<Terms>> {
    let (node, at) = lane;
    if let Some(SoftExtreme { operands, .. }) = graph.as_soft_extreme(node) {
        // Its derivative is a mixture of those of its operands.
        return Some(operands.map(|operand| vec![term(graph, operand, at, 1.0)]).to_vec());
    }
    let one = |id: NodeId, factor: f64| vec![term(graph, id, at, factor)];
    let number = |id: NodeId, lane: usize| {
        let value = graph.as_const(id)?;
        Some(value.lanes()[lane.min(value.ty().width() - 1)])
    };
    Some(match graph.node(node) {
        Node::Unary(op, a) => slopes(op)?.iter().map(|&slope| one(a, slope)).collect(),
        Node::Binary(Binary::Add, a, b) => vec![[one(a, 1.0), one(b, 1.0)].concat()],
        Node::Binary(Binary::Sub, a, b) => vec![[one(a, 1.0), one(b, -1.0)].concat()],
        Node::Binary(Binary::Mul, a, b) => vec![match (number(a, at), number(b, at)) {
            (Some(factor), _) => one(b, factor),
            (None, factor) => one(a, factor?),
        }],
        Node::Binary(Binary::Div, a, b) => vec![one(a, 1.0 / number(b, at)?)],
        Node::Binary(Binary::Min | Binary::Max, a, b) => vec![one(a, 1.0), one(b, 1.0)],
        Node::Binary(Binary::Dot, a, b) => {
            let (weights, vector) = if graph.as_const(a).is_some() { (a, b) } else { (b, a) };
            let weight = |lane| Some(term(graph, vector, lane, number(weights, lane)?));
            vec![(0..graph.ty(vector).width()).map(weight).collect::<Option<_>>()?]
        }
        Node::Ternary(Ternary::Clamp, all) => all.map(|id| one(id, 1.0)).to_vec(),
        Node::Ternary(Ternary::Mix, [a, b, t]) => {
            let t = number(t, at)?;
            vec![[one(a, 1.0 - t), one(b, t)].concat()]
        }
        Node::Ternary(Ternary::Select, [condition, a, b]) if is_fixed(graph, condition, level) => {
            vec![one(a, 1.0), one(b, 1.0)]
        }
        Node::Splat(_, a) => vec![vec![term(graph, a, 0, 1.0)]],
        Node::Compose(_, lanes) => vec![vec![term(graph, lanes[at], 0, 1.0)]],
        Node::Swizzle(_, a, lanes) => vec![vec![term(graph, a, usize::from(lanes[at]), 1.0)]],
        Node::Transform(columns, v) => {
            let column = |i: usize| Some(term(graph, v, i, number(columns[i], at)?));
            vec![(0..columns.len()).map(column).collect::<Option<_>>()?]
        }
        Node::Const(_)
        | Node::Point(..)
        | Node::Frame(..)
        | Node::Binary(..)
        | Node::Ternary(..)
        | Node::Variable(..)
        | Node::Loop(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => return None,
    })
}

/// The node that is the minimum where this one is the maximum of the same two values, or the
/// reverse, among `others`.
pub(super) fn counterpart(graph: &Graph, lane: Lane, others: &[Lane]) -> Option<usize> {
    let Node::Binary(op @ (Binary::Min | Binary::Max), a, b) = graph.node(lane.0) else {
        return None;
    };
    let is_counterpart = |&(node, at): &Lane| {
        let Node::Binary(other @ (Binary::Min | Binary::Max), x, y) = graph.node(node) else {
            return false;
        };
        other != op && at == lane.1 && ([x, y] == [a, b] || [x, y] == [b, a])
    };
    others.iter().position(is_counterpart)
}

/// A multiple of a lane.
fn term(graph: &Graph, id: NodeId, lane: usize, factor: f64) -> (Lane, f64) {
    (lane_of(graph, id, lane), factor)
}

/// A lane of a value; a number is the same in all lanes.
pub(super) fn lane_of(graph: &Graph, id: NodeId, lane: usize) -> Lane {
    (id, if graph.ty(id).width() == 1 { 0 } else { lane })
}

/// The ends of the range of a function's slope, or its slopes on the two sides of its crease.
fn slopes(op: Unary) -> Option<&'static [f64]> {
    match op {
        Unary::Neg => Some(&[-1.0]),
        Unary::Abs | Unary::Sin | Unary::Cos => Some(&[1.0, -1.0]),
        Unary::Saturate | Unary::Atan | Unary::Tanh => Some(&[1.0, 0.0]),
        Unary::Sign
        | Unary::Floor
        | Unary::Ceil
        | Unary::Round
        | Unary::Trunc
        | Unary::Fract
        | Unary::Sqrt
        | Unary::InverseSqrt
        | Unary::Exp
        | Unary::Exp2
        | Unary::Log
        | Unary::Log2
        | Unary::Tan
        | Unary::Asin
        | Unary::Acos
        | Unary::Sinh
        | Unary::Cosh
        | Unary::Length
        | Unary::Normalize
        | Unary::Not => None,
    }
}
