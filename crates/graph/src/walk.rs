//! Traversing and rebuilding nodes: the base of every pass.

use crate::graph::Graph;
use crate::ids::IdSet;
use crate::node::{Binary, Const, Node, NodeId, Ternary};

/// The nodes that the roots are computed from, the roots included, in ascending order: arguments
/// come before their uses.
pub fn reachable(graph: &Graph, roots: &[NodeId]) -> Vec<NodeId> {
    reachable_where(graph, roots, |_| true)
}

/// Like [`reachable`], but does not follow the arguments of nodes for which `enter` is false.
pub fn reachable_where(
    graph: &Graph,
    roots: &[NodeId],
    enter: impl Fn(NodeId) -> bool,
) -> Vec<NodeId> {
    visited(roots, |id, pending| {
        if enter(id) {
            pending.extend(graph.arguments(id));
        }
    })
}

/// Like [`reachable_where`], without the bodies of loops: the arguments of a loop are the nodes
/// outside it that it reads.
pub(crate) fn computed_where(
    graph: &Graph,
    roots: &[NodeId],
    enter: impl Fn(NodeId) -> bool,
) -> Vec<NodeId> {
    visited(roots, |id, pending| {
        if enter(id) {
            pending.extend(graph.inputs(id));
        }
    })
}

/// Returns the operands of nested binary operations, such as the terms of a sum, in no particular
/// order. `is_nested` is given an operation and its second operand, and returns true if the
/// operation is one of them. `None` if there are more than `limit` operands.
pub fn operands(
    graph: &Graph,
    root: NodeId,
    limit: usize,
    is_nested: impl Fn(Binary, NodeId) -> bool,
) -> Option<Vec<NodeId>> {
    let (mut operands, mut at) = (vec![root], 0);
    while let Some(&operand) = operands.get(at) {
        if let Node::Binary(op, a, b) = graph.node(operand)
            && is_nested(op, b)
        {
            operands[at] = a;
            operands.push(b);
        } else {
            at += 1;
        }
        if operands.len() > limit {
            return None;
        }
    }
    Some(operands)
}

/// Up to this many nodes, a linear search is faster than a set.
const FEW: usize = 48;

/// All nodes that `step` leads to from the roots, each once, in ascending order.
pub(crate) fn visited(roots: &[NodeId], step: impl Fn(NodeId, &mut Vec<NodeId>)) -> Vec<NodeId> {
    let mut pending = roots.to_vec();
    let mut few: Vec<NodeId> = Vec::new();
    while few.len() < FEW {
        let Some(id) = pending.pop() else {
            few.sort_unstable();
            return few;
        };
        if !few.contains(&id) {
            few.push(id);
            step(id, &mut pending);
        }
    }
    let mut seen: IdSet = few.into_iter().collect();
    while let Some(id) = pending.pop() {
        if seen.insert(id) {
            step(id, &mut pending);
        }
    }
    seen.to_vec()
}

impl Graph {
    /// True if no constant that the node is computed from is infinite or NaN.
    pub fn is_finite(&self, id: NodeId) -> bool {
        reachable(self, &[id]).into_iter().all(|node| {
            let finite = |value: Const| value.lanes().iter().all(|lane| lane.is_finite());
            !self.non_finite(node) && self.as_const(node).is_none_or(finite)
        })
    }

    /// Applies the node's operation to other arguments, through the typed builders. The result may
    /// be folded or simplified to another operation.
    pub fn rebuild(&mut self, id: NodeId, mut map: impl FnMut(NodeId) -> NodeId) -> NodeId {
        match self.node(id) {
            Node::Const(_) | Node::Point(..) | Node::Frame(..) | Node::Variable(..) => id,
            Node::Loop(loop_, position, _) => self.rebuild_loop(loop_, position, 0, map),
            Node::Element(table, at, _) => {
                let at = map(at);
                self.element_of(table, at)
            }
            Node::Unary(op, a) => self.unary(op, map(a)),
            Node::Binary(op, a, b) => {
                let (a, b) = (map(a), map(b));
                self.binary(op, a, b)
            }
            Node::Ternary(op, arguments) => {
                let [a, b, c] = arguments.map(map);
                match op {
                    Ternary::Select => self.select(a, b, c),
                    Ternary::Mix | Ternary::Clamp | Ternary::Smoothstep => {
                        self.ternary(op, a, b, c)
                    }
                }
            }
            Node::Splat(ty, a) => self.splat(ty, map(a)),
            Node::Compose(ty, parts) => self.compose(&parts.map(map)[..ty.width()]),
            Node::Swizzle(ty, a, lanes) => self.swizzle(map(a), &lanes[..ty.width()]),
            Node::Transform(columns, v) => {
                let columns = columns.map(&mut map);
                self.transform(columns, map(v))
            }
            Node::Sample(shape, point) => self.sample(shape, map(point)),
            Node::MaterialAt(shape, point, field) => self.material_at(shape, map(point), field),
        }
    }
}
