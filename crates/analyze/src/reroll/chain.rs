//! Chains of hard minima, and left-deep chains of blends that end.

use sdfc_graph::{Binary, Blends, Graph, Node, NodeId, Type, blend_at};

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
    while let Some(blend) = blend_at(graph, blends, value) {
        let [before, operand] = blend.ordered_values(graph, blends);
        steps.push(Step { value, before, operand, width: blend.width });
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
