//! Evaluation without a tape, for a few values of inputs that a tape does not know.

use rustc_hash::FxHashMap;

use super::Number;
use super::op::Op;
use super::scalarise::{Lanes, Machine, scalarise};
use crate::graph::result_type;
use crate::{Graph, Node, NodeId, Type};

/// Computes in a domain at once, its inputs given by a function.
struct Direct<N, F> {
    input: F,
    /// The node being computed.
    current: NodeId,
    number: std::marker::PhantomData<N>,
}

impl<N: Number, F: FnMut(NodeId) -> [N; 4]> Machine for Direct<N, F> {
    type Value = N;

    fn constant(&mut self, value: f64) -> N {
        N::constant(value)
    }

    fn apply(&mut self, op: Op, arguments: [N; 3]) -> N {
        op.apply(|i| arguments[i])
    }

    fn input(&mut self, node: &Node) -> Option<Lanes<N>> {
        let lanes = (self.input)(self.current);
        let width = result_type(node, |_| Type::Scalar).width(); // an input's own, whatever its argument
        Some(Lanes::new(width, |i| lanes[i]))
    }
}

/// The first lane of a node. `order` lists what it is computed from, arguments first, with it at the end;
/// points, per-frame inputs and samples have the lanes that `input` gives.
pub(crate) fn evaluate<N: Number>(
    graph: &Graph,
    order: &[NodeId],
    input: impl FnMut(NodeId) -> [N; 4],
) -> N {
    let zero = Lanes::scalar(N::constant(0.0));
    let Some(&last) = order.last() else { return zero.get(0) };
    let mut machine = Direct { input, current: last, number: std::marker::PhantomData };
    let mut values: FxHashMap<NodeId, Lanes<N>> = FxHashMap::default();
    for &id in order {
        machine.current = id;
        let value = scalarise(&mut machine, &graph.node(id), |argument| {
            values.get(&argument).copied().unwrap_or(zero)
        });
        values.insert(id, value.unwrap_or(zero));
    }
    values.get(&last).unwrap_or(&zero).get(0)
}
