//! Materials as weighted sums.
//!
//! Let s₁…sₙ be the samples in a shape's rule, mᵢ their materials and wᵢ = ∂rule/∂sᵢ their weights.
//! The material is Σ max(wᵢ, 0) mᵢ / Σ max(wᵢ, 0), where a negative wᵢ counts as |wᵢ| times the
//! coverage of mᵢ. If all weights are 0, or there is one sample, it is the first sample's material.
//! The result is written in the shape's own point, with the children's materials as nodes, and is
//! expanded like any other formula.
//!
//! A rule of selections and of blends v = b(u, s) that depend on u - s alone needs no sums: as
//! ∂v/∂u = 1 - ∂v/∂s, the material of v is that of u mixed with that of s by ∂v/∂s.

use rustc_hash::FxHashMap;

use super::chains::{MaterialChain, Step, chains};
use crate::blend::{Blends, blend_at};
use crate::derive::TINY;
use crate::derive::adjoints;
use crate::graph::Graph;
use crate::ids::IdSet;
use crate::node::{Binary, MaterialField, Node, NodeId, ShapeId, Ternary, Unary};
use crate::shape::MaterialRule;
use crate::walk::reachable_where;

/// One node for each of [`MaterialField::ALL`].
type Fields = [NodeId; 6];

const COVERAGE: usize = 1;

/// A shape's material over its own point.
#[derive(Clone, Debug)]
pub(super) struct Material {
    pub(super) fields: Fields,
    /// The chains of blends in it.
    pub(super) chains: Vec<MaterialChain>,
}

/// Returns the material of a shape over its own point.
pub(super) fn formulas(graph: &mut Graph, shape: ShapeId) -> Material {
    let without_chains = |fields| Material { fields, chains: Vec::new() };
    let rule = match graph.shape(shape).material {
        MaterialRule::Explicit(fields) => return without_chains(fields),
        MaterialRule::Weighted(rule) => rule,
    };
    let order = reachable_where(graph, &[rule], |id| graph.as_sample(id).is_none());
    let samples = samples_in_order(graph, shape, &order);
    match samples[..] {
        [] => without_chains(default_material(graph)),
        [only] => without_chains(material_of(graph, only)),
        [first, ..] => {
            let first = material_of(graph, first);
            Selection::new(graph, &order, first)
                .run(rule)
                .unwrap_or_else(|| without_chains(weighted(graph, rule, &samples)))
        }
    }
}

/// The default material.
fn default_material(graph: &mut Graph) -> Fields {
    MaterialField::ALL.map(|field| graph.constant(field.ty(), &field.default_value()))
}

/// The rule's samples, ordered by the first use of the shapes in the formula, then by id.
fn samples_in_order(graph: &Graph, shape: ShapeId, order: &[NodeId]) -> Vec<NodeId> {
    let children = &graph.shape(shape).children;
    let order_of: FxHashMap<ShapeId, usize> =
        children.iter().enumerate().rev().map(|(index, &child)| (child, index)).collect();
    let mut samples: Vec<(usize, NodeId)> = Vec::new();
    for &id in order {
        if let Some((child, _)) = graph.as_sample(id) {
            samples.push((order_of.get(&child).copied().unwrap_or(children.len()), id));
        }
    }
    samples.sort_unstable();
    samples.into_iter().map(|(_, id)| id).collect()
}

fn material_of(graph: &mut Graph, sample: NodeId) -> Fields {
    let Some((shape, point)) = graph.as_sample(sample) else { return default_material(graph) };
    MaterialField::ALL.map(|field| graph.material_at(shape, point, field))
}

/// The general rule, as a chain of mixes, so that a mix of equal materials folds for any weights.
fn weighted(graph: &mut Graph, rule: NodeId, samples: &[NodeId]) -> Fields {
    let derivatives = adjoints(graph, rule, samples);
    let tiny = graph.number(TINY);
    let mut mixed: Option<(Fields, NodeId)> = None;
    for (&sample, derivative) in samples.iter().zip(derivatives) {
        let material = material_of(graph, sample);
        let weight = weight(graph, derivative, material[COVERAGE]);
        mixed = Some(match mixed {
            None => (material, weight),
            Some((before, sum)) => {
                let sum = graph.add(sum, weight);
                let divisor = graph.max(sum, tiny);
                let fraction = graph.div(weight, divisor);
                (mix(graph, before, material, fraction), sum)
            }
        });
    }
    mixed.map_or_else(|| default_material(graph), |(fields, _)| fields)
}

fn mix(graph: &mut Graph, mut a: Fields, b: Fields, t: NodeId) -> Fields {
    for (a, b) in a.iter_mut().zip(b) {
        *a = graph.ternary(Ternary::Mix, *a, b, t);
    }
    a
}

/// The weight of a derivative: a negative one counts as far as its material is set.
fn weight(graph: &mut Graph, derivative: NodeId, coverage: NodeId) -> NodeId {
    let zero = graph.number(0.0);
    let size = graph.neg(derivative);
    let covered = graph.mul(size, coverage);
    let negative = graph.lt(derivative, zero);
    graph.select(negative, covered, derivative)
}

/// Materials of a rule that only selects and blends: the same comparisons select the material, and
/// the slopes of the blends mix it.
struct Selection<'a> {
    graph: &'a mut Graph,
    blends: Blends,
    /// Nodes that depend on a sample.
    live: IdSet,
    /// The first sample's material.
    first: Fields,
    /// Results by node and by whether its weight is negative.
    done: FxHashMap<(NodeId, bool), Fields>,
    /// The blends whose materials were mixed.
    mixed: Vec<(NodeId, Step)>,
}

/// The material that a node of a rule selects. `negated` flips the sign of the weight.
enum Choice {
    Material(Fields),
    Of { argument: NodeId, negated: bool },
    Between { condition: NodeId, yes: NodeId, no: NodeId },
    Mixed { step: Step, fraction: NodeId },
}

impl<'a> Selection<'a> {
    fn new(graph: &'a mut Graph, order: &[NodeId], first: Fields) -> Self {
        let mut live = IdSet::default();
        for &id in order {
            let mut arguments = graph.arguments(id);
            if graph.as_sample(id).is_some() || arguments.any(|argument| live.contains(argument)) {
                live.insert(id);
            }
        }
        let (blends, done, mixed) = Default::default();
        Self { graph, blends, live, first, done, mixed }
    }

    /// The selected material; `None` if the rule does anything but select and blend.
    fn run(mut self, rule: NodeId) -> Option<Material> {
        let root = (rule, false);
        let mut stack = vec![root];
        while let Some(&(id, negative)) = stack.last() {
            let before = stack.len();
            let fields = match self.choice(id, negative)? {
                Choice::Material(fields) => Some(fields),
                Choice::Of { argument, negated } => {
                    self.done_or_wait((argument, negative ^ negated), &mut stack)
                }
                Choice::Between { condition, yes, no } => {
                    let yes = self.done_or_wait((yes, negative), &mut stack);
                    let no = self.done_or_wait((no, negative), &mut stack);
                    yes.zip(no).map(|(yes, no)| self.select(condition, yes, no))
                }
                Choice::Mixed { step: [before, operand], fraction } => {
                    let a = self.done_or_wait((before, negative), &mut stack);
                    let b = self.done_or_wait((operand, negative), &mut stack);
                    a.zip(b).map(|(a, b)| {
                        self.mixed.push((id, [before, operand]));
                        mix(self.graph, a, b, fraction)
                    })
                }
            };
            if let Some(fields) = fields {
                stack.truncate(before - 1);
                self.done.insert((id, negative), fields);
            }
        }
        let fields_of = |id| self.done.get(&(id, false)).copied();
        let chains = chains(&self.mixed, fields_of);
        self.done.get(&root).map(|&fields| Material { fields, chains })
    }

    fn done_or_wait(&self, key: (NodeId, bool), stack: &mut Vec<(NodeId, bool)>) -> Option<Fields> {
        let done = self.done.get(&key).copied();
        if done.is_none() {
            stack.push(key);
        }
        done
    }

    fn choice(&mut self, id: NodeId, negative: bool) -> Option<Choice> {
        if !self.live.contains(id) {
            return Some(Choice::Material(self.first));
        }
        let of = |argument, negated| Some(Choice::Of { argument, negated });
        if let Some(step) = self.step(id).filter(|_| !negative) {
            let slopes = adjoints(self.graph, id, &step[1..]);
            return slopes.first().map(|&fraction| Choice::Mixed { step, fraction });
        }
        match self.graph.node(id) {
            Node::Sample(..) => Some(Choice::Material(self.sampled(id, negative))),
            Node::Unary(Unary::Neg, a) => of(a, true),
            Node::Binary(Binary::Min, a, b) => {
                let condition = self.graph.le(a, b);
                Some(Choice::Between { condition, yes: a, no: b })
            }
            Node::Binary(Binary::Max, a, b) => {
                let condition = self.graph.le(b, a);
                Some(Choice::Between { condition, yes: a, no: b })
            }
            Node::Binary(Binary::Add, a, b) => match (self.is_live(a), self.is_live(b)) {
                (true, false) => of(a, false),
                (false, true) => of(b, false),
                (true, true) | (false, false) => None,
            },
            Node::Binary(Binary::Sub, a, b) => match (self.is_live(a), self.is_live(b)) {
                (true, false) => of(a, false),
                (false, true) => of(b, true),
                (true, true) | (false, false) => None,
            },
            Node::Binary(Binary::Mul, a, b) => match (self.is_live(a), self.is_live(b)) {
                (true, false) => of(a, self.is_negative(b)?),
                (false, true) => of(b, self.is_negative(a)?),
                (true, true) | (false, false) => None,
            },
            Node::Ternary(Ternary::Select, [condition, yes, no]) => {
                Some(Choice::Between { condition, yes, no })
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::MaterialAt(..) => None,
        }
    }

    /// The blend of two live values that a node is, if it depends on their difference alone.
    fn step(&mut self, id: NodeId) -> Option<Step> {
        let blend = blend_at(self.graph, &mut self.blends, id)?;
        let values = blend.ordered_values(self.graph, &mut self.blends);
        let is_live = values.iter().all(|&value| self.is_live(value));
        (is_live && blend.is_symmetric()).then_some(values)
    }

    fn is_live(&self, id: NodeId) -> bool {
        self.live.contains(id)
    }

    /// True for a negative constant factor; `None` if the factor is 0 or not constant.
    fn is_negative(&self, factor: NodeId) -> Option<bool> {
        let factor = self.graph.as_number(factor)?;
        (factor != 0.0).then_some(factor < 0.0)
    }

    /// The material of a sample. With a negative weight, a sample without a material shows the
    /// first one.
    fn sampled(&mut self, sample: NodeId, negative: bool) -> Fields {
        let material = material_of(self.graph, sample);
        if !negative {
            return material;
        }
        let zero = self.graph.number(0.0);
        let has_material = self.graph.lt(zero, material[COVERAGE]);
        self.select(has_material, material, self.first)
    }

    fn select(&mut self, condition: NodeId, mut yes: Fields, no: Fields) -> Fields {
        for (yes, no) in yes.iter_mut().zip(no) {
            *yes = self.graph.select(condition, *yes, no);
        }
        yes
    }
}
