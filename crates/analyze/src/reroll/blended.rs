//! Steps of chains of blends as the step of a loop, for distances and for materials.

use rustc_hash::FxHashMap;
use sdfc_graph::{
    Blends, Graph, IdMap, LoopVar, MaterialChain, MaterialField, NodeId, SkipCondition,
    SurfaceVector, Ternary, Type, adjoints, blend_at, reachable,
};

use crate::reroll::chain::Step;
use crate::reroll::kinds::formulas_by_kind;
use crate::reroll::loops::{MIN_OPERANDS, loop_over};
use crate::reroll::shape_keys::ShapeKeys;
use crate::reroll::template::template;

/// Largest number of kinds of operand in one loop. All of them are evaluated in each iteration.
pub(super) const MAX_KINDS: usize = 8;

/// Largest number of different formulas of materials in one chain.
const MAX_MATERIAL_KINDS: usize = 8;

/// The step of a loop over blends.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlendedStep {
    /// The value after an iteration.
    pub(super) next: NodeId,
    /// The operand of an iteration.
    operand: NodeId,
    pub(super) skip: Option<SkipCondition>,
}

/// The loop that stands for some steps of a chain; `None` if they are too few, or their operands
/// are of too many kinds.
pub(super) fn blended_step(
    graph: &mut Graph,
    keys: &mut ShapeKeys,
    steps: &[Step],
) -> Option<BlendedStep> {
    if steps.len() < MIN_OPERANDS {
        return None;
    }
    let column = |of: fn(&Step) -> NodeId| steps.iter().map(of).collect::<Vec<_>>();
    let (values, operands) = (column(|step| step.value), column(|step| step.operand));
    let before = column(|step| step.before);
    let index = graph.variable(0, LoopVar::Index, Type::Scalar);
    let state = graph.variable(0, LoopVar::State(0), Type::Scalar);
    let operand = *formulas_by_kind(graph, keys, &[&operands], index, MAX_KINDS)?.first()?;
    let given: [(&[NodeId], NodeId); 2] = [(&before, state), (&operands, operand)];
    let next = *template(graph, keys, &[&values], &given, index)?.first()?;
    let margin = widest(graph, steps.iter().map(|step| step.width));
    let skip = margin.map(|margin| SkipCondition { lower: operand, upper: operand, margin });
    Some(BlendedStep { next, operand, skip })
}

/// The largest of some widths, if all are constants or all are the same node.
fn widest(graph: &mut Graph, widths: impl Iterator<Item = NodeId>) -> Option<NodeId> {
    let mut widest: Option<NodeId> = None;
    for width in widths {
        widest = match widest {
            None => Some(width),
            Some(other) if other == width => continue,
            Some(other) => {
                let greater = graph.as_number(width)?.max(graph.as_number(other)?);
                Some(graph.number(greater))
            }
        };
    }
    widest
}

/// A loop that computes the material of a chain of blends. Its state is the distance, and those
/// properties in which the operands differ.
#[derive(Debug)]
pub(super) struct MaterialLoop {
    iterations: usize,
    /// The properties of the chain in the state, after the distance.
    pub(super) fields: Vec<NodeId>,
    init: Vec<NodeId>,
    step: Vec<NodeId>,
    skip: Option<SkipCondition>,
}

impl MaterialLoop {
    /// Plans the loop; `None` if the operands are too few, or of too many kinds.
    pub(super) fn plan(
        graph: &mut Graph,
        keys: &mut ShapeKeys,
        blends: &mut Blends,
        chain: &MaterialChain,
    ) -> Option<Self> {
        if graph.loops_around(chain.steps.last()?.value) != 0 {
            return None;
        }
        let step = blended_step(graph, keys, &steps(graph, blends, chain)?)?;
        let (start, first) = chain.first;
        let varies = |&at: &usize| chain.steps.iter().any(|step| step.fields[at] != first[at]);
        let varying: Vec<usize> = (0..first.len()).filter(varies).collect();
        let list = |&at: &usize| chain.steps.iter().map(|step| step.fields[at]).collect();
        let lists: Vec<Vec<NodeId>> = varying.iter().map(list).collect();
        let lists: Vec<&[NodeId]> = lists.iter().map(Vec::as_slice).collect();
        let index = graph.variable(0, LoopVar::Index, Type::Scalar);
        let values = formulas_by_kind(graph, keys, &lists, index, MAX_MATERIAL_KINDS)?;
        if depends_on_surface(graph, &values) {
            return None;
        }
        let fraction = *adjoints(graph, step.next, &[step.operand]).first()?;
        let mut planned = Self {
            iterations: chain.steps.len(),
            fields: Vec::new(),
            init: vec![start],
            step: vec![step.next],
            skip: step.skip,
        };
        for (&at, value) in varying.iter().zip(values) {
            let part = planned.init.len() as u16;
            let before = graph.variable(0, LoopVar::State(part), MaterialField::ALL[at].ty());
            planned.fields.push(chain.fields[at]);
            planned.init.push(first[at]);
            planned.step.push(graph.ternary(Ternary::Mix, before, value, fraction));
        }
        Some(planned)
    }

    /// Builds the loop, and returns the new nodes of [`MaterialLoop::fields`]. `new` maps nodes to
    /// rebuilt ones.
    pub(super) fn build(&self, graph: &mut Graph, new: &IdMap<NodeId>) -> Vec<NodeId> {
        let init = self.init.iter().map(|&id| new.get(id).unwrap_or(id)).collect();
        let mut state = loop_over(graph, self.iterations, init, self.step.clone(), self.skip);
        state.remove(0);
        state
    }
}

/// True if some values depend on the normal or on the direction to the eye. These are replaced in
/// the flat program, but not in loops.
fn depends_on_surface(graph: &mut Graph, values: &[NodeId]) -> bool {
    let vectors = SurfaceVector::ALL.map(|vector| graph.surface_vector(vector));
    let used = reachable(graph, values);
    vectors.iter().any(|vector| used.contains(vector))
}

/// The steps of a chain; `None` if one of them is no blend.
fn steps(graph: &Graph, blends: &mut Blends, chain: &MaterialChain) -> Option<Vec<Step>> {
    let mut before = chain.first.0;
    let mut steps = Vec::with_capacity(chain.steps.len());
    for step in &chain.steps {
        let width = blend_at(graph, blends, step.value)?.width;
        steps.push(Step { value: step.value, before, operand: step.operand, width });
        before = step.value;
    }
    Some(steps)
}

/// Chains that start with the value of another one, with that one's steps before their own.
pub(super) fn joined(chains: &[MaterialChain]) -> Vec<MaterialChain> {
    let ends: FxHashMap<NodeId, &MaterialChain> =
        chains.iter().filter_map(|chain| Some((chain.steps.last()?.value, chain))).collect();
    let whole = |chain: &MaterialChain| {
        let (mut parts, mut first) = (vec![&chain.steps], chain.first);
        while let Some(start) = ends.get(&first.0).filter(|start| start.fields == first.1) {
            parts.push(&start.steps);
            first = start.first;
        }
        let steps = parts.into_iter().rev().flatten().copied().collect();
        MaterialChain { fields: chain.fields, first, steps }
    };
    chains.iter().map(whole).collect()
}
