//! Constant folding.

use super::op::Op;
use super::scalarise::{Lanes, Machine, scalarise};
use crate::graph::result_type;
use crate::{Const, Node, NodeId, Type};

/// Computes in f64 at once; has no inputs.
struct Folding;

impl Machine for Folding {
    type Value = f64;

    fn constant(&mut self, value: f64) -> f64 {
        value
    }

    fn apply(&mut self, op: Op, arguments: [f64; 3]) -> f64 {
        op.apply(|i| arguments[i])
    }

    fn input(&mut self, _: &Node) -> Option<Lanes<f64>> {
        None
    }
}

/// The value of a node whose arguments, in order, are these constants. `None` for a node that is no
/// operation, and where finite arguments give a lane that is not finite, or any give one that is no number: such an
/// operation stays, to be reported or to run, rather than become a literal that no shader can hold.
pub fn fold(node: &Node, arguments: &[Const]) -> Option<Const> {
    fold_where(node, |id| arguments.get(node.own_arguments().position(|argument| argument == id)?))
}

/// As [`fold`], where `constant` gives what an argument is.
pub(crate) fn fold_where<'a>(
    node: &Node,
    constant: impl Fn(NodeId) -> Option<&'a Const>,
) -> Option<Const> {
    if node.own_arguments().any(|id| constant(id).is_none()) {
        return None;
    }
    let lanes = scalarise(&mut Folding, node, |id| match constant(id) {
        Some(value) => {
            let lanes = value.lanes();
            Lanes::new(value.ty().width(), |i| lanes[i])
        }
        None => Lanes::scalar(0.0),
    })?;
    if !lanes.as_slice().iter().all(|lane| lane.is_finite()) {
        let infinite = |value: &Const| value.lanes().iter().any(|lane| lane.is_infinite());
        let from_infinity = node.own_arguments().filter_map(&constant).any(infinite);
        if !from_infinity || lanes.as_slice().iter().any(|lane| lane.is_nan()) {
            return None;
        }
    }
    let ty = result_type(node, |id| constant(id).map_or(Type::Scalar, Const::ty));
    Some(Const::new(ty, lanes.as_slice()))
}
