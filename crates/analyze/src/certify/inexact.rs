//! Operators that need an exact distance and are applied to a field that is only a bound.
//!
//! `a - r` is the surface at distance r from the surface of `a`, and `abs(a) - w` is the pair of
//! surfaces at distance w, only where `a` is the exact distance. If `a` is only a bound, the
//! distance between the surfaces varies.

use sdfc_graph::{Binary, Graph, Node, NodeId, ShapeId, Stage, Unary};

use crate::certify::promise::{Promise, Sides};
use crate::certify::quality::Qualities;
use crate::shapes::shapes_below;

/// An operator that needs an exact distance and is applied to an inexact field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InexactOperator {
    /// The instance of the operator.
    pub shape: ShapeId,
    /// The shape below it at which the field stops being exact.
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

/// A child of which an operator uses a level set other than the surface.
struct LevelSet {
    child: ShapeId,
    /// True if a level set outside the child is used.
    outside: bool,
    /// True if a level set inside the child is used.
    inside: bool,
}

/// The level sets of `a` that a formula `a ± r` or `abs(a) ± r` uses.
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
    let shell = absolute(graph, value);
    let (child, _) = graph.as_sample(shell.unwrap_or(value))?;
    let is_shell = shell.is_some();
    Some(LevelSet { child, outside: out > 0.0, inside: within > 0.0 || (is_shell && out > 0.0) })
}

fn absolute(graph: &Graph, node: NodeId) -> Option<NodeId> {
    if let Node::Unary(Unary::Abs, inner) = graph.node(node) { Some(inner) } else { None }
}

/// The lowest inexact shape whose children are all exact, on a path down from the child. Children
/// that are inexact on a side that is used come first.
fn cause(graph: &Graph, qualities: &Qualities, level_set: LevelSet) -> Option<ShapeId> {
    let sides = |shape: ShapeId| qualities.get(shape).map(|quality| quality.sides);
    let lacks = |shape: ShapeId| {
        let is_lacking = |used: bool, promise: Promise| used && promise != Promise::Exact;
        sides(shape).is_some_and(|sides| {
            is_lacking(level_set.outside, sides.outside)
                || is_lacking(level_set.inside, sides.inside)
        })
    };
    let is_exact = |shape: ShapeId| sides(shape).is_some_and(Sides::is_exact);
    let mut cause = Some(level_set.child).filter(|&child| lacks(child))?;
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
