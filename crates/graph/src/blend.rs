//! Blends that end: the lesser of two values where these differ by some width or more.

use rustc_hash::FxHashMap;

use crate::{Binary, Graph, Node, NodeId, Stage, Unary};

/// The blends that were looked at.
pub type Blends = FxHashMap<NodeId, Option<Blend>>;

/// The lesser of two values, and less than that where they differ by less than a width.
#[derive(Clone, Copy, Debug)]
pub struct Blend {
    /// The two.
    pub values: [NodeId; 2],
    /// Per frame or constant.
    pub width: NodeId,
    /// Whether nothing but how much they differ tells how far it is from the lesser.
    is_even: bool,
}

impl Blend {
    /// Its values, that of a blend, or of a loop that a chain of blends may have become, before that of another thing.
    pub fn in_order(self, graph: &Graph, blends: &mut Blends) -> [NodeId; 2] {
        let [a, b] = self.values;
        let mut goes_on =
            |id| matches!(graph.node(id), Node::Loop(..)) || blend_at(graph, blends, id).is_some();
        if !goes_on(a) && goes_on(b) { [b, a] } else { [a, b] }
    }

    /// How far it may lie below the lesser of its values, per frame; `id` is the node that it ends in. `None` where that is
    /// not known.
    pub fn depth(self, graph: &mut Graph, id: NodeId) -> Option<NodeId> {
        // A product of powers of one factor is farthest from 0 where the factor is: at equal values.
        let [a, b] = self.values;
        let zero = graph.number(0.0);
        let at_equal = rebuilt(graph, id, &[(a, zero), (b, zero)]);
        let below = graph.neg(at_equal);
        let depth = graph.max(below, zero);
        (self.is_even && graph.stage(depth) < Stage::Point).then_some(depth)
    }
}

/// The blend that ends in a node; `None` if that is none, or has no end that is known per frame.
pub fn blend_at(graph: &Graph, blends: &mut Blends, id: NodeId) -> Option<Blend> {
    *blends.entry(id).or_insert_with(|| blend(graph, id))
}

/// `min(a, b) + r` or `min(a, b) - r`, where r has a factor `max(width - |a - b|, 0)`.
fn blend(graph: &Graph, id: NodeId) -> Option<Blend> {
    let Node::Binary(op, x, y) = graph.node(id) else { return None };
    let tries = [
        matches!(op, Binary::Add | Binary::Sub).then_some((x, y)),
        matches!(op, Binary::Add).then_some((y, x)),
    ];
    tries.into_iter().flatten().find_map(|(lesser, rest)| {
        let Node::Binary(Binary::Min, a, b) = graph.node(lesser) else { return None };
        let (width, is_even) = width(graph, rest, [a, b])?;
        Some(Blend { values: [a, b], width, is_even })
    })
}

/// The width of which a product has the factor, and whether its other factors are that one again or per-frame.
fn width(graph: &Graph, product: NodeId, values: [NodeId; 2]) -> Option<(NodeId, bool)> {
    let (mut found, mut is_even) = (None, true);
    let mut pending = vec![product];
    while let Some(id) = pending.pop() {
        let node = graph.node(id);
        if let Node::Binary(Binary::Mul, a, b) = node {
            pending.extend([a, b]);
        } else if let Node::Unary(Unary::Neg, a) = node {
            pending.push(a);
        } else if let Node::Binary(Binary::Div, a, b) = node {
            pending.push(a);
            is_even &= graph.stage(b) < Stage::Point;
        } else if let Some(width) = faded(graph, node, values) {
            is_even &= found.is_none_or(|other| other == width);
            found = found.or(Some(width));
        } else {
            is_even &= graph.stage(id) < Stage::Point;
        }
    }
    found.map(|width| (width, is_even))
}

/// The width of `max(width - |a - b|, 0)`
fn faded(graph: &Graph, node: Node, values: [NodeId; 2]) -> Option<NodeId> {
    let Node::Binary(Binary::Max, a, b) = node else { return None };
    let is_zero = |id| graph.as_number(id) == Some(0.0);
    let fades = if is_zero(b) { Some(a) } else { is_zero(a).then_some(b) };
    fading(graph, fades?, values)
}

/// `width - |a - b|`
fn fading(graph: &Graph, node: NodeId, [a, b]: [NodeId; 2]) -> Option<NodeId> {
    let Node::Binary(Binary::Sub, width, away) = graph.node(node) else { return None };
    let Node::Unary(Unary::Abs, difference) = graph.node(away) else { return None };
    let Node::Binary(Binary::Sub, x, y) = graph.node(difference) else { return None };
    let same = [x, y] == [a, b] || [x, y] == [b, a];
    (same && graph.stage(width) < Stage::Point).then_some(width)
}

/// A node over other values in place of some that it depends on: few nodes should lie between.
pub fn rebuilt(graph: &mut Graph, id: NodeId, new: &[(NodeId, NodeId)]) -> NodeId {
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
