//! Distances that are evaluated only where they matter: operands of a union, layers of a picture.

use crate::graph::Graph;
use crate::loops::Loop;
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

/// The parts of a value that [`guarded_value`] recognises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GuardedValue {
    /// True where the operand has to be evaluated.
    pub condition: NodeId,
    /// The value with the operand.
    pub with_operand: NodeId,
    /// The value without it.
    pub without: NodeId,
}

/// Largest number of operands of a minimum in which guarded ones are sought.
const MAX_OPERANDS: usize = 4096;

/// A field with the same values that evaluates a guarded operand only where its bound is less than
/// all operands before it. The same holds for the operands of loops whose skip condition has a
/// lower bound that costs less.
pub(crate) fn guarded_field(graph: &mut Graph, field: NodeId, guards: &[Guard]) -> NodeId {
    let is_minimum = |op: Binary, _| op == Binary::Min;
    let Some(mut parts) = operands(graph, field, MAX_OPERANDS, is_minimum) else { return field };
    parts.sort_unstable();
    parts.dedup();
    let (mut plain, mut loops, mut guarded) = (Vec::new(), Vec::new(), Vec::new());
    for part in parts {
        match guards.iter().find(|guard| guard.operand == part) {
            Some(guard) => guarded.push(*guard),
            None => match guarded_loop(graph, part) {
                Some(looped) => loops.push(looped),
                None => plain.push(part),
            },
        }
    }
    if guarded.is_empty() && loops.is_empty() {
        return field;
    }
    let mut least = plain.into_iter().reduce(|a, b| graph.min(a, b));
    for mut looped in loops {
        if let Some(least) = least {
            looped.init = vec![graph.min(least, looped.init[0])];
        }
        least = graph.add_loop(looped).pop();
    }
    for Guard { operand, bound } in guarded {
        least = Some(match least {
            None => operand,
            Some(least) => {
                let matters = graph.binary(Binary::Lt, bound, least);
                let with_operand = graph.min(least, operand);
                graph.select(matters, with_operand, least)
            }
        });
    }
    least.unwrap_or(field)
}

/// The loop that is a node, with its operand in a branch. `None` if the node is another one, or if
/// the skip condition has no bound that costs less than the operand.
fn guarded_loop(graph: &mut Graph, node: NodeId) -> Option<Loop> {
    let Node::Loop(id, ..) = graph.node(node) else { return None };
    let looped = graph.loop_at(id).clone();
    let (skip, &[step]) = (looped.skip?, looped.step.as_slice()) else { return None };
    let Node::Binary(Binary::Min, least, operand) = graph.node(step) else { return None };
    if skip.lower == operand {
        return None;
    }
    let matters = graph.binary(Binary::Lt, skip.lower, least);
    let step = graph.select(matters, step, least);
    Some(Loop { step: vec![step], ..looped })
}

/// The distance where its bound is less than `near`, and the bound elsewhere.
pub fn guarded_distance(graph: &mut Graph, guard: Guard, near: NodeId) -> NodeId {
    let matters = graph.binary(Binary::Lt, guard.bound, near);
    graph.select(matters, guard.operand, guard.bound)
}

/// The parts of a node that evaluates a guarded operand only where a condition is true: of a
/// minimum, or of a distance with one of these guards. `None` for any other node.
pub fn guarded_value(graph: &Graph, node: NodeId, guards: &[Guard]) -> Option<GuardedValue> {
    let Node::Ternary(Ternary::Select, [condition, with_operand, without]) = graph.node(node)
    else {
        return None;
    };
    let Node::Binary(Binary::Lt, bound, least) = graph.node(condition) else { return None };
    let is_minimum = least == without
        && matches!(graph.node(with_operand), Node::Binary(Binary::Min, a, b)
            if a == without || b == without);
    let is_distance = bound == without && guards.contains(&Guard { operand: with_operand, bound });
    (is_minimum || is_distance).then_some(GuardedValue { condition, with_operand, without })
}
