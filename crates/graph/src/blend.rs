//! Recognition of blends of finite width: smooth minima that equal the plain minimum where their
//! operands differ by at least a width.

use rustc_hash::FxHashMap;

use crate::graph::Graph;
use crate::node::{Binary, Node, NodeId, Stage, Unary};

/// A cache of the blends found so far, by node; `None` for nodes that are no blends.
pub type Blends = FxHashMap<NodeId, Option<Blend>>;

/// A smooth minimum: below the lesser of two values where they differ by less than a width, equal
/// to it elsewhere.
#[derive(Clone, Copy, Debug)]
pub struct Blend {
    /// The two operands.
    pub values: [NodeId; 2],
    /// Width of the blend, known per frame or constant.
    pub width: NodeId,
    /// True if the depth of the blend depends on the difference of the operands only.
    is_symmetric: bool,
}

impl Blend {
    /// The operands, reordered so that an operand that is itself a blend, or a loop that may stand
    /// for a chain of blends, comes first.
    pub fn ordered_values(self, graph: &Graph, blends: &mut Blends) -> [NodeId; 2] {
        let [a, b] = self.values;
        let mut is_chain =
            |id| matches!(graph.node(id), Node::Loop(..)) || blend_at(graph, blends, id).is_some();
        if !is_chain(a) && is_chain(b) { [b, a] } else { [a, b] }
    }

    /// True if the depth of the blend below the lesser operand depends only on the difference of
    /// the operands. Then the derivatives with respect to the operands add up to 1.
    pub fn is_symmetric(self) -> bool {
        self.is_symmetric
    }

    /// The maximum by which the blend lies below the lesser operand, known per frame. `id` is the
    /// node of the blend. `None` if it is not known.
    pub fn depth(self, graph: &mut Graph, id: NodeId) -> Option<NodeId> {
        // A product of powers of one factor is largest where the factor is: at equal operands.
        let [a, b] = self.values;
        let zero = graph.number(0.0);
        let at_equal = substitute(graph, id, &[(a, zero), (b, zero)]);
        let below = graph.neg(at_equal);
        let depth = graph.max(below, zero);
        (self.is_symmetric && graph.stage(depth) < Stage::Point).then_some(depth)
    }
}

/// The blend that a node computes; `None` if it is no blend of known width.
pub fn blend_at(graph: &Graph, blends: &mut Blends, id: NodeId) -> Option<Blend> {
    *blends.entry(id).or_insert_with(|| blend(graph, id))
}

/// `min(a, b) + r` or `min(a, b) - r`, where r has a factor `max(width - |a - b|, 0)`.
fn blend(graph: &Graph, id: NodeId) -> Option<Blend> {
    let Node::Binary(op, x, y) = graph.node(id) else { return None };
    let orders = [
        matches!(op, Binary::Add | Binary::Sub).then_some((x, y)),
        matches!(op, Binary::Add).then_some((y, x)),
    ];
    orders.into_iter().flatten().find_map(|(lesser, rest)| {
        let Node::Binary(Binary::Min, a, b) = graph.node(lesser) else { return None };
        let (width, is_symmetric) = width(graph, rest, [a, b])?;
        Some(Blend { values: [a, b], width, is_symmetric })
    })
}

/// The width in the factor `max(width - |a - b|, 0)` of a product. The flag is true if the other
/// factors are per-frame or the same factor again.
fn width(graph: &Graph, product: NodeId, values: [NodeId; 2]) -> Option<(NodeId, bool)> {
    let (mut found, mut is_symmetric) = (None, true);
    let mut pending = vec![product];
    while let Some(id) = pending.pop() {
        let node = graph.node(id);
        if let Node::Binary(Binary::Mul, a, b) = node {
            pending.extend([a, b]);
        } else if let Node::Unary(Unary::Neg, a) = node {
            pending.push(a);
        } else if let Node::Binary(Binary::Div, a, b) = node {
            pending.push(a);
            is_symmetric &= graph.stage(b) < Stage::Point;
        } else if let Some(width) = clamped_width(graph, node, values) {
            is_symmetric &= found.is_none_or(|other| other == width);
            found = found.or(Some(width));
        } else {
            is_symmetric &= graph.stage(id) < Stage::Point;
        }
    }
    found.map(|width| (width, is_symmetric))
}

/// The width of `max(width - |a - b|, 0)`
fn clamped_width(graph: &Graph, node: Node, values: [NodeId; 2]) -> Option<NodeId> {
    let Node::Binary(Binary::Max, a, b) = node else { return None };
    let is_zero = |id| graph.as_number(id) == Some(0.0);
    let fades = if is_zero(b) { Some(a) } else { is_zero(a).then_some(b) };
    width_minus_difference(graph, fades?, values)
}

/// `width - |a - b|`
fn width_minus_difference(graph: &Graph, node: NodeId, [a, b]: [NodeId; 2]) -> Option<NodeId> {
    let Node::Binary(Binary::Sub, width, away) = graph.node(node) else { return None };
    let Node::Unary(Unary::Abs, difference) = graph.node(away) else { return None };
    let Node::Binary(Binary::Sub, x, y) = graph.node(difference) else { return None };
    let same = [x, y] == [a, b] || [x, y] == [b, a];
    (same && graph.stage(width) < Stage::Point).then_some(width)
}

/// The node with some of its inputs replaced by other nodes. Meant for few nodes in between.
pub fn substitute(graph: &mut Graph, id: NodeId, new: &[(NodeId, NodeId)]) -> NodeId {
    let mut done: FxHashMap<NodeId, NodeId> = new.iter().copied().collect();
    let mut pending = vec![id];
    while let Some(&id) = pending.last() {
        if done.contains_key(&id) || graph.stage(id) < Stage::Point {
            pending.pop();
            continue;
        }
        let before = pending.len();
        let missing = |arg: &NodeId| graph.stage(*arg) == Stage::Point && !done.contains_key(arg);
        pending.extend(graph.arguments(id).filter(missing));
        if pending.len() == before {
            let built = graph.rebuild(id, |old| done.get(&old).copied().unwrap_or(old));
            done.insert(id, built);
        }
    }
    done.get(&id).copied().unwrap_or(id)
}
