//! Constant folding.

use super::op::Op;
use super::scalarise::{Lanes, ScalarBackend, scalarise};
use crate::graph::result_type;
use crate::node::{Const, Node, NodeId, Type};

/// A backend that computes in f64 and has no inputs.
struct Folding;

impl ScalarBackend for Folding {
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

/// The value of a node whose arguments, in order, are these constants.
///
/// Returns `None` for a node that is no operation, where finite arguments give a lane that is not
/// finite, and where any arguments give NaN. Such an operation stays in the graph, to be reported
/// or to run, instead of becoming a literal that no shader can hold.
pub fn fold(node: &Node, arguments: &[Const]) -> Option<Const> {
    fold_where(node, |id| arguments.get(node.own_arguments().position(|argument| argument == id)?))
}

/// Like [`fold`], with the constants given by node.
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
