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
    let find = |id: NodeId| {
        let position = node.own_arguments().position(|argument| argument == id);
        position.and_then(|position| arguments.get(position)).copied()
    };
    if node.own_arguments().any(|id| find(id).is_none()) {
        return None;
    }
    let argument = |id| find(id).unwrap_or(Const::new(Type::Scalar, &[]));
    let lanes = scalarise(&mut Folding, node, |id| {
        let (lanes, width) = (argument(id).lanes(), argument(id).ty().width());
        Lanes::new(width, |i| lanes[i])
    })?;
    let lane_of = |value: &Const| value.lanes();
    let from_infinity = arguments.iter().flat_map(lane_of).any(f64::is_infinite);
    let sound = |lane: &f64| lane.is_finite() || (from_infinity && !lane.is_nan());
    lanes
        .as_slice()
        .iter()
        .all(sound)
        .then(|| Const::new(result_type(node, |id| argument(id).ty()), lanes.as_slice()))
}
