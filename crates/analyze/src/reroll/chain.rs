//! Chains of hard minima, and left-deep chains of blends of finite width.

use sdfc_graph::{Binary, Blends, Graph, Node, NodeId, Type, blend_at};

/// The operands of a chain.
#[derive(Debug)]
pub(super) enum Chain {
    /// The minimum of `operands`. `inner` are the nodes of the single minima.
    Min { operands: Vec<NodeId>, inner: Vec<NodeId> },
    /// A blend of `first` with one more operand in each step.
    Blend { first: NodeId, steps: Vec<Step> },
}

/// A step of a chain of blends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// The blend of `before` and `operand`.
    pub(super) value: NodeId,
    /// The value of the chain up to this step.
    pub(super) before: NodeId,
    /// The operand that this step adds.
    pub(super) operand: NodeId,
    /// The width of the blend: it equals the minimum where its operands differ by at least this.
    pub(super) width: NodeId,
}

impl Chain {
    /// The number of operands.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Min { operands, .. } => operands.len(),
            Self::Blend { steps, .. } => steps.len() + 1,
        }
    }

    /// The nodes of the chain's single minima or blends.
    pub(super) fn inner(&self) -> Box<dyn Iterator<Item = NodeId> + '_> {
        match self {
            Self::Min { inner, .. } => Box::new(inner.iter().copied()),
            Self::Blend { steps, .. } => Box::new(steps.iter().map(|step| step.value)),
        }
    }
}

/// The chain whose value is the node `end`; `None` if it is not a minimum or a blend.
pub(super) fn chain(graph: &Graph, blends: &mut Blends, end: NodeId) -> Option<Chain> {
    if graph.ty(end) != Type::Scalar {
        return None;
    }
    if let Node::Binary(Binary::Min, ..) = graph.node(end) {
        return Some(min_chain(graph, end));
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

/// The operands of a minimum. A node that is no minimum is its own only operand.
pub(super) fn min_chain(graph: &Graph, end: NodeId) -> Chain {
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
    Chain::Min { operands, inner }
}
