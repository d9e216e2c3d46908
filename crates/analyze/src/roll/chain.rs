//! Chains of hard minima, and left-deep chains of blends that end.

use rustc_hash::FxHashMap;
use sdfc_graph::{Binary, Graph, Node, NodeId, Stage, Type, Unary};

/// A chain by its operands.
#[derive(Debug)]
pub(super) enum Chain {
    /// The least of these. The minima between them are `inner`.
    Least { operands: Vec<NodeId>, inner: Vec<NodeId> },
    /// Each step joins an operand to what was before.
    Blend { first: NodeId, steps: Vec<Step> },
}

/// A step of a chain of blends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// What it makes of `before` and `operand`.
    pub(super) value: NodeId,
    pub(super) before: NodeId,
    pub(super) operand: NodeId,
    /// It is the lesser of the two where they differ by no less than this.
    pub(super) width: NodeId,
}

impl Chain {
    /// How many operands there are.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Least { operands, .. } => operands.len(),
            Self::Blend { steps, .. } => steps.len() + 1,
        }
    }

    /// The nodes that are chains of the first operands.
    pub(super) fn inner(&self) -> Box<dyn Iterator<Item = NodeId> + '_> {
        match self {
            Self::Least { inner, .. } => Box::new(inner.iter().copied()),
            Self::Blend { steps, .. } => Box::new(steps.iter().map(|step| step.value)),
        }
    }
}

/// The blends that were looked at.
pub(super) type Blends = FxHashMap<NodeId, Option<Blend>>;

/// The lesser of two values, and less than that where they differ by less than a width.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blend {
    pub(super) values: [NodeId; 2],
    pub(super) width: NodeId,
}

/// The chain that ends in a node; `None` if that is no end of one.
pub(super) fn chain(graph: &Graph, blends: &mut Blends, end: NodeId) -> Option<Chain> {
    if graph.ty(end) != Type::Scalar {
        return None;
    }
    if let Node::Binary(Binary::Min, ..) = graph.node(end) {
        return Some(least(graph, end));
    }
    let mut steps = Vec::new();
    let mut value = end;
    while let Some(Blend { values: [a, b], width }) = blend_at(graph, blends, value) {
        let is_chain = |blends: &mut Blends, id| blend_at(graph, blends, id).is_some();
        let (before, operand) =
            if !is_chain(blends, a) && is_chain(blends, b) { (b, a) } else { (a, b) };
        steps.push(Step { value, before, operand, width });
        value = before;
    }
    steps.reverse();
    let first = steps.first()?.before;
    Some(Chain::Blend { first, steps })
}

/// The operands of which a node is the least; the node itself if it is no minimum.
pub(super) fn least(graph: &Graph, end: NodeId) -> Chain {
    let (mut operands, mut inner) = (Vec::new(), Vec::new());
    let mut seen = sdfc_graph::IdSet::default();
    let mut pending = vec![end];
    while let Some(id) = pending.pop() {
        if !seen.insert(id) {
            continue;
        }
        if let Node::Binary(Binary::Min, a, b) = graph.node(id) {
            inner.push(id);
            pending.extend([b, a]);
        } else {
            operands.push(id);
        }
    }
    Chain::Least { operands, inner }
}

/// The blend that a node is, if it is one.
pub(super) fn blend_at(graph: &Graph, blends: &mut Blends, id: NodeId) -> Option<Blend> {
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
        let width = width(graph, rest, [a, b])?;
        Some(Blend { values: [a, b], width })
    })
}

/// The width of which a product has the factor.
fn width(graph: &Graph, product: NodeId, values: [NodeId; 2]) -> Option<NodeId> {
    let mut pending = vec![product];
    while let Some(id) = pending.pop() {
        let node = graph.node(id);
        if let Node::Binary(Binary::Mul, a, b) = node {
            pending.extend([a, b]);
        } else if let Node::Binary(Binary::Div, a, _) | Node::Unary(Unary::Neg, a) = node {
            pending.push(a);
        } else if let Node::Binary(Binary::Max, a, b) = node {
            let is_zero = |id| graph.as_number(id) == Some(0.0);
            let fades = if is_zero(b) { Some(a) } else { is_zero(a).then_some(b) };
            if let Some(width) = fades.and_then(|fades| fading(graph, fades, values)) {
                return Some(width);
            }
        }
    }
    None
}

/// `width - |a - b|`
fn fading(graph: &Graph, node: NodeId, [a, b]: [NodeId; 2]) -> Option<NodeId> {
    let Node::Binary(Binary::Sub, width, away) = graph.node(node) else { return None };
    let Node::Unary(Unary::Abs, difference) = graph.node(away) else { return None };
    let Node::Binary(Binary::Sub, x, y) = graph.node(difference) else { return None };
    let same = [x, y] == [a, b] || [x, y] == [b, a];
    (same && graph.stage(width) < Stage::Point).then_some(width)
}

/// A step over other values: few nodes lie between it and those.
pub(super) fn rebuilt(graph: &mut Graph, step: NodeId, new: &[(NodeId, NodeId)]) -> NodeId {
    let mut done: FxHashMap<NodeId, NodeId> = new.iter().copied().collect();
    let mut pending = vec![step];
    while let Some(&id) = pending.last() {
        if done.contains_key(&id) || graph.stage(id) < Stage::Point {
            pending.pop();
            continue;
        }
        let before = pending.len();
        let missing = |arg: &NodeId| graph.stage(*arg) == Stage::Point && !done.contains_key(arg);
        let missing: Vec<NodeId> = graph.arguments(id).filter(missing).collect();
        pending.extend(missing);
        if pending.len() == before {
            let built = graph.rebuild(id, |old| done.get(&old).copied().unwrap_or(old));
            done.insert(id, built);
        }
    }
    done.get(&step).copied().unwrap_or(step)
}
