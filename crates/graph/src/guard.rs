//! Operands of a union that are evaluated only where they can be the least.

use crate::graph::Graph;
use crate::node::{Binary, Node, NodeId, Ternary};
use crate::walk::operands;

/// An operand of a minimum that costs much, and a cheap lower bound of it.
///
/// Where the bound is no less than another operand, the minimum does not need this one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Guard {
    /// A scalar that is an operand of minima.
    pub operand: NodeId,
    /// A scalar that never exceeds it: the signed distance to a box around the operand's shape.
    pub bound: NodeId,
}

/// The parts of a value that [`guarded_minimum`] recognises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GuardedMinimum {
    /// True where the operand has to be evaluated.
    pub condition: NodeId,
    /// The minimum with the operand.
    pub with_operand: NodeId,
    /// The minimum without it.
    pub without: NodeId,
}

/// Largest number of operands of a minimum in which guarded ones are sought.
const MAX_OPERANDS: usize = 4096;

/// A field with the same values that evaluates a guarded operand only where its bound is less than
/// all operands before it.
pub(crate) fn guarded_field(graph: &mut Graph, field: NodeId, guards: &[Guard]) -> NodeId {
    if guards.is_empty() {
        return field;
    }
    let is_minimum = |op: Binary, _| op == Binary::Min;
    let Some(mut parts) = operands(graph, field, MAX_OPERANDS, is_minimum) else { return field };
    parts.sort_unstable();
    parts.dedup();
    let (mut plain, mut guarded) = (Vec::new(), Vec::new());
    for part in parts {
        match guards.iter().find(|guard| guard.operand == part) {
            Some(guard) => guarded.push(*guard),
            None => plain.push(part),
        }
    }
    if guarded.is_empty() || plain.len() + guarded.len() == 1 {
        return field;
    }
    let mut guarded = guarded.into_iter();
    let first = plain.into_iter().reduce(|a, b| graph.min(a, b));
    let Some(first) = first.or_else(|| guarded.next().map(|guard| guard.operand)) else {
        return field;
    };
    guarded.fold(first, |least, Guard { operand, bound }| {
        let matters = graph.binary(Binary::Lt, bound, least);
        let with_operand = graph.min(least, operand);
        graph.select(matters, with_operand, least)
    })
}

/// The parts of a node that evaluates the operand of a minimum only where a condition is true;
/// `None` for any other node.
pub fn guarded_minimum(graph: &Graph, node: NodeId) -> Option<GuardedMinimum> {
    let Node::Ternary(Ternary::Select, [condition, with_operand, without]) = graph.node(node)
    else {
        return None;
    };
    let Node::Binary(Binary::Min, a, b) = graph.node(with_operand) else { return None };
    let Node::Binary(Binary::Lt, _, least) = graph.node(condition) else { return None };
    let is_guarded = least == without && (a == without || b == without);
    is_guarded.then_some(GuardedMinimum { condition, with_operand, without })
}
