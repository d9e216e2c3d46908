//! Evaluation without a tape, for nodes that a tape cannot hold, such as samples.

use rustc_hash::FxHashMap;

use super::Number;
use super::op::Op;
use super::scalarise::{Lanes, ScalarBackend, scalarise};
use crate::graph::Graph;
use crate::graph::result_type;
use crate::node::{Node, NodeId, Type};

/// A backend that computes numbers; a function gives the inputs.
struct Direct<N, F> {
    input: F,
    /// The node being computed.
    current: NodeId,
    number: std::marker::PhantomData<N>,
}

impl<N: Number, F: FnMut(NodeId) -> [N; 4]> ScalarBackend for Direct<N, F> {
    type Value = N;

    fn constant(&mut self, value: f64) -> N {
        N::constant(value)
    }

    fn apply(&mut self, op: Op, arguments: [N; 3]) -> N {
        op.apply(|i| arguments[i])
    }

    fn input(&mut self, node: &Node) -> Option<Lanes<N>> {
        let lanes = (self.input)(self.current);
        // The type of an input does not depend on its argument.
        let width = result_type(node, |_| Type::Scalar).width();
        Some(Lanes::new(width, |i| lanes[i]))
    }
}

/// Evaluates the last node of `order` and returns its first lane. `order` lists the nodes that it
/// is computed from, arguments first. `input` gives the lanes of points, per-frame inputs and
/// samples. `known` has the values of nodes that were computed before, and gets those of the
/// others.
pub(crate) fn evaluate<N: Number>(
    graph: &Graph,
    order: &[NodeId],
    known: &mut FxHashMap<NodeId, Lanes<N>>,
    input: impl FnMut(NodeId) -> [N; 4],
) -> N {
    let zero = Lanes::scalar(N::constant(0.0));
    let Some(&last) = order.last() else { return zero.get(0) };
    let mut backend = Direct { input, current: last, number: std::marker::PhantomData };
    for &id in order {
        if known.contains_key(&id) {
            continue;
        }
        backend.current = id;
        let value = scalarise(&mut backend, &graph.node(id), |argument| {
            known.get(&argument).copied().unwrap_or(zero)
        });
        known.insert(id, value.unwrap_or(zero));
    }
    known.get(&last).unwrap_or(&zero).get(0)
}
