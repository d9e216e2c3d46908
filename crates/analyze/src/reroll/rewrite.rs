//! Loop rerolling: many similar operands as a loop over a list of their constants.
//!
//! The pass works on minima of many operands and on chains of blends. Operands that are equal up to
//! constants become one formula that reads the constants from a list, and a loop over that list.
//! The size of the shader then does not grow with the number of operands. The operands of a hard
//! minimum may be reordered, so each kind has a loop. A blend is not associative, so only
//! consecutive operands of a blend are combined. Where kinds alternate, one loop selects among
//! their formulas.
//!
//! The pass recognises formulas, not shapes: `chain` finds the chains, and `template` compares
//! operands up to constants.

use sdfc_graph::{
    Blends, FAR, Graph, IdMap, IdSet, LoopVar, NodeId, SkipCondition, Type, substitute,
};

use crate::reroll::blended::{BlendedStep, blended_step};
use crate::reroll::chain::{self, Chain};
use crate::reroll::kinds::{Kind, Operand, OperandBounds, grouped, kinds};
use crate::reroll::loops::{MIN_OPERANDS, loop_over};
use crate::reroll::shape_keys::ShapeKeys;

/// A loop that stands for many operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RerolledLoop {
    /// The number of operands.
    pub operands: usize,
    /// True if the operands are blended, false if their minimum is taken.
    pub blended: bool,
}

/// The result of the pass.
#[derive(Debug)]
pub(crate) struct Rerolled {
    /// The new roots.
    pub(crate) roots: Vec<NodeId>,
    /// The loops in them.
    pub(crate) loops: Vec<RerolledLoop>,
    /// For each chain that has loops now, by its old value, the new value.
    pub(crate) replaced: IdMap<NodeId>,
}

/// Rewrites the roots with similar operands as loops. `bounds` are those of some operands.
pub(crate) fn reroll(graph: &mut Graph, roots: &[NodeId], bounds: &OperandBounds) -> Rerolled {
    let mut rerolling = Rerolling {
        graph,
        bounds,
        keys: ShapeKeys::default(),
        plan_of: IdMap::default(),
        plans: Vec::new(),
    };
    let visited = rerolling.discover(roots);
    let (mut new, mut replaced): (IdMap<NodeId>, IdMap<NodeId>) = Default::default();
    for id in visited.to_vec() {
        let built = match rerolling.plan_of.get(id) {
            Some(plan) => {
                let built = rerolling.build(plan, &new);
                replaced.insert(id, built);
                built
            }
            None => rebuilt(rerolling.graph, id, &new),
        };
        new.insert(id, built);
    }
    // Roots may share loops, which count once.
    let mut seen = IdSet::default();
    let parts = rerolling.plans.iter().flat_map(|plan| &plan.parts);
    let loops = parts.filter_map(|part| part.rerolled_loop(&mut seen)).collect();
    let roots = roots.iter().map(|&root| new.get(root).unwrap_or(root)).collect();
    Rerolled { roots, loops, replaced }
}

/// Groups of positions of values that are equal up to constants. Groups that are too small for a
/// loop are omitted.
pub(crate) fn similar_groups(graph: &mut Graph, values: &[NodeId]) -> Vec<Vec<usize>> {
    let mut keys = ShapeKeys::default();
    let mut groups = grouped(graph, &mut keys, values);
    groups.retain(|group| group.len() >= MIN_OPERANDS);
    groups
}

/// The parts that a chain becomes, first to last. The result of a minimum is the minimum of its
/// parts; each part of a blend takes the result of the part before it.
#[derive(Debug)]
struct Plan {
    parts: Vec<Part>,
}

/// A part of a plan.
#[derive(Debug)]
enum Part {
    /// An operand of a minimum, or the first operand of a blend, unrolled.
    Value(NodeId),
    /// A step of a blend, unrolled.
    Step { step: NodeId, before: NodeId, operand: NodeId },
    /// A loop: the value after an iteration, built by [`template`], and its skip condition.
    Loop { next: NodeId, skip: Option<SkipCondition>, operands: usize, blended: bool },
}

impl Part {
    /// The loop, unless it is in `seen`.
    fn rerolled_loop(&self, seen: &mut IdSet) -> Option<RerolledLoop> {
        match *self {
            Self::Loop { next, operands, blended, .. } => {
                seen.insert(next).then_some(RerolledLoop { operands, blended })
            }
            Self::Value(_) | Self::Step { .. } => None,
        }
    }
}

/// The pass, with the plans that it has made.
struct Rerolling<'g> {
    graph: &'g mut Graph,
    bounds: &'g OperandBounds,
    keys: ShapeKeys,
    /// The index of a chain's plan, by the node that is the value of the chain.
    plan_of: IdMap<usize>,
    plans: Vec<Plan>,
}

impl Rerolling<'_> {
    /// Plans the chains that the roots depend on. Returns all nodes to rebuild: the values of those
    /// chains and the nodes outside of them.
    fn discover(&mut self, roots: &[NodeId]) -> IdSet {
        let (mut visited, mut plain) = (IdSet::default(), IdSet::default());
        let mut blends = Blends::default();
        let mut pending = roots.to_vec();
        while let Some(id) = pending.pop() {
            if !visited.insert(id) {
                continue;
            }
            let chain = match plain.contains(id) || self.graph.loops_around(id) != 0 {
                true => None,
                false => chain::chain(self.graph, &mut blends, id)
                    .filter(|chain| chain.len() >= MIN_OPERANDS || roots.contains(&id)),
            };
            let Some(chain) = chain else {
                pending.extend(self.graph.arguments(id));
                continue;
            };
            match self.plan(&chain) {
                Some(plan) => {
                    for part in &plan.parts {
                        match *part {
                            Part::Value(value) => pending.push(value),
                            Part::Step { operand, .. } => pending.push(operand),
                            Part::Loop { .. } => {}
                        }
                    }
                    self.plan_of.insert(id, self.plans.len());
                    self.plans.push(plan);
                }
                None => {
                    // Its inner nodes are not tried as chains of their own.
                    chain.inner().for_each(|id| _ = plain.insert(id));
                    pending.extend(self.graph.arguments(id));
                }
            }
        }
        visited
    }

    /// Plans a chain; `None` if too few of its operands are similar.
    fn plan(&mut self, chain: &Chain) -> Option<Plan> {
        let parts = match chain {
            Chain::Min { operands, .. } => self.plan_min(operands),
            Chain::Blend { first, steps } => self.plan_blend(*first, steps),
        };
        let has_loop = parts.iter().any(|part| matches!(part, Part::Loop { .. }));
        has_loop.then_some(Plan { parts })
    }

    fn plan_min(&mut self, operands: &[NodeId]) -> Vec<Part> {
        let (mut values, mut loops) = (Vec::new(), Vec::new());
        for Kind { members, operand } in kinds(self.graph, &mut self.keys, operands, self.bounds) {
            match operand {
                Some(operand) => loops.push(self.min_loop(operand, members.len())),
                None => values.extend(members.into_iter().map(|at| Part::Value(operands[at]))),
            }
        }
        values.extend(loops);
        values
    }

    fn min_loop(&mut self, operand: Operand, operands: usize) -> Part {
        let state = self.graph.variable(0, LoopVar::State(0), Type::Scalar);
        let next = self.graph.min(state, operand.value);
        let [lower, upper] = operand.bounds;
        let skip = Some(SkipCondition { lower, upper, margin: self.graph.number(0.0) });
        Part::Loop { next, skip, operands, blended: false }
    }

    fn plan_blend(&mut self, first: NodeId, steps: &[chain::Step]) -> Vec<Part> {
        let operands: Vec<NodeId> = steps.iter().map(|step| step.operand).collect();
        self.keys.compute(self.graph, &operands);
        let runs: Vec<&[chain::Step]> =
            steps.chunk_by(|a, b| self.keys.of(a.operand) == self.keys.of(b.operand)).collect();
        let first = Part::Value(first);
        if runs.iter().any(|run| run.len() < MIN_OPERANDS)
            && let Some(part) = self.blend_loop(steps)
        {
            return vec![first, part];
        }
        let mut parts = vec![first];
        for run in runs {
            match self.blend_loop(run) {
                Some(part) => parts.push(part),
                None => parts.extend(run.iter().map(|step| Part::Step {
                    step: step.value,
                    before: step.before,
                    operand: step.operand,
                })),
            }
        }
        parts
    }

    fn blend_loop(&mut self, run: &[chain::Step]) -> Option<Part> {
        let BlendedStep { next, skip, .. } = blended_step(self.graph, &mut self.keys, run)?;
        Some(Part::Loop { next, skip, operands: run.len(), blended: true })
    }

    /// Builds a planned chain. `new` maps nodes to the rebuilt ones.
    fn build(&mut self, plan: usize, new: &IdMap<NodeId>) -> NodeId {
        let mapped = |id: NodeId| new.get(id).unwrap_or(id);
        let parts = std::mem::take(&mut self.plans[plan].parts);
        let mut value: Option<NodeId> = None;
        for part in &parts {
            value = Some(match *part {
                Part::Value(own) => {
                    let own = mapped(own);
                    value.map_or(own, |value| self.graph.min(value, own))
                }
                Part::Step { step, before, operand } => {
                    let before = (before, value.unwrap_or(before));
                    substitute(self.graph, step, &[before, (operand, mapped(operand))])
                }
                Part::Loop { next, skip, operands, blended } => {
                    let far = self.graph.number(FAR);
                    let start = value.filter(|_| blended).unwrap_or(far);
                    let result = loop_over(self.graph, operands, vec![start], vec![next], skip)[0];
                    match value.filter(|_| !blended) {
                        Some(value) => self.graph.min(value, result),
                        None => result,
                    }
                }
            });
        }
        self.plans[plan].parts = parts;
        value.unwrap_or_else(|| self.graph.number(FAR))
    }
}

/// Rebuilds a node if one of its arguments was replaced.
pub(super) fn rebuilt(graph: &mut Graph, id: NodeId, new: &IdMap<NodeId>) -> NodeId {
    let changed = graph.arguments(id).any(|id| new.get(id).is_some_and(|new| new != id));
    if changed { graph.rebuild(id, |old| new.get(old).unwrap_or(old)) } else { id }
}
