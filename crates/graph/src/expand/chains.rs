//! Chains of blends, with the materials of their operands.

use rustc_hash::{FxHashMap, FxHashSet};

use super::environment::Env;
use crate::node::{NodeId, ShapeId};

/// One node for each of [`MaterialField::ALL`](crate::MaterialField::ALL).
type Fields = [NodeId; 6];

/// A chain of blends and its material. A blend changes the material as much as the distance of its
/// operand changes the chain's: the material after a step is that before it, mixed with that of the
/// operand by `∂value/∂operand`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MaterialChain {
    /// The material of the chain.
    pub fields: Fields,
    /// The distance and the material of the first operand.
    pub first: (NodeId, Fields),
    /// The other operands, in order.
    pub steps: Vec<MaterialStep>,
}

/// A step of a chain of blends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaterialStep {
    /// The distance of the chain after the step.
    pub value: NodeId,
    /// The distance of the operand that the step adds.
    pub operand: NodeId,
    /// The material of that operand.
    pub fields: Fields,
}

impl MaterialChain {
    /// All nodes of the chain.
    pub fn nodes(&self) -> Vec<NodeId> {
        let (first, material) = self.first;
        let steps = self
            .steps
            .iter()
            .flat_map(|step| [step.value, step.operand].into_iter().chain(step.fields));
        self.fields.into_iter().chain([first]).chain(material).chain(steps).collect()
    }

    /// The chain with other nodes, in the order of [`MaterialChain::nodes`].
    #[must_use]
    pub fn with_nodes(mut self, nodes: &[NodeId]) -> Self {
        let steps = self.steps.iter_mut().flat_map(|step| {
            let MaterialStep { value, operand, fields } = step;
            [value, operand].into_iter().chain(fields)
        });
        let (first, material) = &mut self.first;
        let all = self.fields.iter_mut().chain([first]).chain(material).chain(steps);
        all.zip(nodes).for_each(|(old, new)| *old = *new);
        self
    }
}

/// A blend in a shape's rule: the value before it, and its operand.
pub(super) type Step = [NodeId; 2];

/// The chains of some blends, whose materials `fields_of` returns.
pub(super) fn chains(
    blends: &[(NodeId, Step)],
    fields_of: impl Fn(NodeId) -> Option<Fields>,
) -> Vec<MaterialChain> {
    let steps: FxHashMap<NodeId, Step> = blends.iter().copied().collect();
    let inner: FxHashSet<NodeId> = blends.iter().map(|&(_, [before, _])| before).collect();
    let ends = blends.iter().map(|&(value, _)| value).filter(|value| !inner.contains(value));
    ends.filter_map(|end| {
        let (mut value, mut reversed) = (end, Vec::new());
        while let Some(&[before, operand]) = steps.get(&value) {
            reversed.push(MaterialStep { value, operand, fields: fields_of(operand)? });
            value = before;
        }
        reversed.reverse();
        let first = (value, fields_of(value)?);
        Some(MaterialChain { fields: fields_of(end)?, first, steps: reversed })
    })
    .collect()
}

/// The shapes with chains whose materials were expanded, each with the points that it was expanded
/// at, in the order of the first expansion.
#[derive(Clone, Debug, Default)]
pub(super) struct Expanded {
    seen: FxHashSet<(ShapeId, Env)>,
    pub(super) order: Vec<(ShapeId, Env)>,
}

impl Expanded {
    pub(super) fn insert(&mut self, shape: ShapeId, env: Env) {
        if self.seen.insert((shape, env)) {
            self.order.push((shape, env));
        }
    }
}
