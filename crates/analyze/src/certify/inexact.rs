//! Operators that use the value of a distance, not only its sign.
//!
//! `a - r` is the surface at the distance r from that of `a`, `abs(a) - w` the two surfaces at the distance w, only
//! where `a` is the distance. Of a mere bound they are surfaces too, but at a distance that varies.

use sdfc_graph::{Binary, Graph, Node, NodeId, ShapeId, Stage, Unary};

use crate::certify::quality::{Promise, Qualities, Sides, shapes_below};

/// An operator whose result is uneven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InexactOperator {
    /// The operator's instance.
    pub shape: ShapeId,
    /// Where below it the field stops being the distance.
    pub cause: ShapeId,
}

/// All such operators at and below `root`.
pub(crate) fn inexact_operators(
    graph: &Graph,
    qualities: &Qualities,
    root: ShapeId,
) -> Vec<InexactOperator> {
    let shapes = shapes_below(graph, root).into_iter();
    let found = shapes.filter_map(|shape| {
        let cause = cause(graph, qualities, level_set(graph, qualities, shape)?)?;
        Some(InexactOperator { shape, cause })
    });
    found.collect()
}

/// Where at or below `root` the field stops being the distance outside; `None` where it is that.
pub(crate) fn inexact_outside(
    graph: &Graph,
    qualities: &Qualities,
    root: ShapeId,
) -> Option<ShapeId> {
    cause(graph, qualities, LevelSet { child: root, outside: true, inside: false })
}

/// A child whose surface at some distance is wanted.
struct LevelSet {
    child: ShapeId,
    outside: bool,
    inside: bool,
}

/// What a formula `a ± r` or `abs(a) ± r` wants of `a`.
fn level_set(graph: &Graph, qualities: &Qualities, shape: ShapeId) -> Option<LevelSet> {
    let (value, offset, sign) = match graph.node(graph.shape(shape).formula) {
        Node::Binary(Binary::Sub, a, r) if graph.stage(r) < Stage::Point => (a, r, 1.0),
        Node::Binary(Binary::Add, a, r) if graph.stage(r) < Stage::Point => (a, r, -1.0),
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
        | Node::MaterialAt(..) => return None,
    };
    let range = qualities.range(graph, offset);
    let (lo, hi) = (range.lo(), range.hi());
    let (out, within) = if sign > 0.0 { (hi, -lo) } else { (-lo, hi) };
    let skin = folded(graph, value);
    let (child, _) = graph.as_sample(skin.unwrap_or(value))?;
    let both = skin.is_some();
    Some(LevelSet { child, outside: out > 0.0, inside: within > 0.0 || (both && out > 0.0) })
}

fn folded(graph: &Graph, node: NodeId) -> Option<NodeId> {
    if let Node::Unary(Unary::Abs, inner) = graph.node(node) { Some(inner) } else { None }
}

/// The lowest shape on the way down that is not exact although all below it is; by way of those that lack what is wanted,
/// where there are such.
fn cause(graph: &Graph, qualities: &Qualities, wanted: LevelSet) -> Option<ShapeId> {
    let sides = |shape: ShapeId| qualities.get(shape).map(|quality| quality.sides);
    let lacks = |shape: ShapeId| {
        let lacking = |wanted: bool, promise: Promise| wanted && promise != Promise::Exact;
        sides(shape).is_some_and(|sides| {
            lacking(wanted.outside, sides.outside) || lacking(wanted.inside, sides.inside)
        })
    };
    let is_exact = |shape: ShapeId| sides(shape).is_some_and(Sides::is_exact);
    let mut cause = Some(wanted.child).filter(|&child| lacks(child))?;
    let below = |shape: ShapeId| {
        let children = graph.shape(shape).children.iter().copied();
        children
            .clone()
            .find(|&child| lacks(child))
            .or(children.into_iter().find(|&c| !is_exact(c)))
    };
    while let Some(child) = below(cause) {
        cause = child;
    }
    Some(cause)
}
