//! Many alike parts of a field as loops over lists of what they differ in.
//!
//! Where a field is the least of many operands, or a chain of blends, operands that are equal up to constants become one
//! formula whose constants are read from a list, and a loop over that list. What a shader holds then does not grow with the
//! number of operands. A hard minimum may be taken in any order; of a blend only operands that follow each other are
//! taken together, since a blend is not associative.
//!
//! What is recognised are forms of math, not shapes: `chain` tells what a chain is, `template` what is equal up to constants.

use rustc_hash::FxHashMap;
use sdfc_graph::{
    Blends, FAR, Graph, IdMap, IdSet, Loop, LoopVar, NodeId, SkipCondition, Type, substitute,
};

use crate::reroll::chain::{self, Chain};
use crate::reroll::template::{Skeletons, template};

/// Fewer operands of a kind stay written out.
pub(super) const FEWEST: usize = 16;

/// What became a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RerolledLoop {
    /// How many operands it stands for.
    pub operands: usize,
    /// Whether they are blended, or else the least is taken.
    pub blended: bool,
}

/// The roots with all that is alike in loops, and what these are.
pub(crate) fn reroll(graph: &mut Graph, roots: &[NodeId]) -> (Vec<NodeId>, Vec<RerolledLoop>) {
    let mut pass =
        Pass { graph, skeletons: Skeletons::default(), plans: IdMap::default(), found: Vec::new() };
    let visited = pass.discover(roots);
    let mut new: IdMap<NodeId> = IdMap::default();
    for id in visited.to_vec() {
        let built = match pass.plans.get(id) {
            Some(plan) => pass.build(plan, &new),
            None => pass.rebuilt(id, &new),
        };
        new.insert(id, built);
    }
    // Roots may share loops.
    let mut seen = IdSet::default();
    let parts = pass.found.iter().flat_map(|plan| &plan.parts);
    let found = parts.filter_map(|part| part.rolled(&mut seen)).collect();
    (roots.iter().map(|&root| new.get(root).unwrap_or(root)).collect(), found)
}

/// Groups of values that are equal up to constants, by position; those of few members are left out.
pub(crate) fn alike(graph: &mut Graph, values: &[NodeId]) -> Vec<Vec<usize>> {
    let mut skeletons = Skeletons::default();
    let mut groups = grouped(graph, &mut skeletons, values);
    groups.retain(|group| group.len() >= FEWEST);
    groups
}

fn grouped(graph: &mut Graph, skeletons: &mut Skeletons, values: &[NodeId]) -> Vec<Vec<usize>> {
    skeletons.learn(graph, values);
    let mut places: FxHashMap<u32, usize> = FxHashMap::default();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (position, &value) in values.iter().enumerate() {
        let place = *places.entry(skeletons.of(value)).or_insert(groups.len());
        if place == groups.len() {
            groups.push(Vec::new());
        }
        groups[place].push(position);
    }
    groups
}

/// What a chain becomes, first to last. The parts of a minimum are joined, each of a blend is the start of the next.
#[derive(Debug)]
struct Plan {
    parts: Vec<Part>,
}

#[derive(Debug)]
enum Part {
    /// An operand of a minimum, or the first of a blend, written out.
    Value(NodeId),
    /// A step of a blend, written out: what it makes of the value before.
    Step { step: NodeId, before: NodeId, operand: NodeId },
    /// A loop, as [`template`] made it: what a round computes, and when it is inert.
    Loop { next: NodeId, inert: Option<SkipCondition>, operands: usize, blended: bool },
}

impl Part {
    /// What it became, unless that was seen.
    fn rolled(&self, seen: &mut IdSet) -> Option<RerolledLoop> {
        match *self {
            Self::Loop { next, operands, blended, .. } => {
                seen.insert(next).then_some(RerolledLoop { operands, blended })
            }
            Self::Value(_) | Self::Step { .. } => None,
        }
    }
}

struct Pass<'g> {
    graph: &'g mut Graph,
    skeletons: Skeletons,
    /// By the node at the end of a chain, the position of what it becomes.
    plans: IdMap<usize>,
    found: Vec<Plan>,
}

impl Pass<'_> {
    /// Finds the chains that the roots are computed from; gives the nodes that stay and what stands in chains' place.
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
                false => {
                    chain::chain(self.graph, &mut blends, id).filter(|chain| chain.len() >= FEWEST)
                }
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
                    self.plans.insert(id, self.found.len());
                    self.found.push(plan);
                }
                None => {
                    // What is within is not looked at again.
                    chain.inner().for_each(|id| _ = plain.insert(id));
                    pending.extend(self.graph.arguments(id));
                }
            }
        }
        visited
    }

    /// What a chain becomes; `None` if too few of its operands are alike.
    fn plan(&mut self, chain: &Chain) -> Option<Plan> {
        let parts = match chain {
            Chain::Least { operands, .. } => self.plan_least(operands),
            Chain::Blend { first, steps } => self.plan_blend(*first, steps),
        };
        let any = parts.iter().any(|part| matches!(part, Part::Loop { .. }));
        any.then_some(Plan { parts })
    }

    fn plan_least(&mut self, operands: &[NodeId]) -> Vec<Part> {
        let (mut values, mut loops) = (Vec::new(), Vec::new());
        for group in grouped(self.graph, &mut self.skeletons, operands) {
            let members: Vec<NodeId> = group.iter().map(|&position| operands[position]).collect();
            let rolled = if members.len() < FEWEST {
                None
            } else {
                template(self.graph, &self.skeletons, &[&members], None)
            };
            match rolled {
                Some(values) => loops.push(self.least_loop(values[0], members.len())),
                None => values.extend(members.into_iter().map(Part::Value)),
            }
        }
        values.extend(loops);
        values
    }

    fn least_loop(&mut self, operand: NodeId, operands: usize) -> Part {
        let state = self.graph.variable(0, LoopVar::State(0), Type::Scalar);
        let next = self.graph.min(state, operand);
        let inert = Some(SkipCondition { operand, margin: self.graph.number(0.0) });
        Part::Loop { next, inert, operands, blended: false }
    }

    fn plan_blend(&mut self, first: NodeId, steps: &[chain::Step]) -> Vec<Part> {
        let operands: Vec<NodeId> = steps.iter().map(|step| step.operand).collect();
        self.skeletons.learn(self.graph, &operands);
        let mut parts = vec![Part::Value(first)];
        let mut rest = steps;
        while let Some(head) = rest.first() {
            let kind = self.skeletons.of(head.operand);
            let same = rest.iter().take_while(|step| self.skeletons.of(step.operand) == kind);
            let (run, after) = rest.split_at(same.count());
            match self.blend_loop(run) {
                Some(part) => parts.push(part),
                None => parts.extend(run.iter().map(|step| Part::Step {
                    step: step.value,
                    before: step.before,
                    operand: step.operand,
                })),
            }
            rest = after;
        }
        parts
    }

    fn blend_loop(&mut self, run: &[chain::Step]) -> Option<Part> {
        if run.len() < FEWEST {
            return None;
        }
        let column = |of: fn(&chain::Step) -> NodeId| run.iter().map(of).collect::<Vec<_>>();
        let (values, operands) = (column(|step| step.value), column(|step| step.operand));
        let before = column(|step| step.before);
        let made = template(self.graph, &self.skeletons, &[&values, &operands], Some(&before))?;
        let [next, operand] = made[..] else { return None };
        let margin = self.widest(run.iter().map(|step| step.width));
        let inert = margin.map(|margin| SkipCondition { operand, margin });
        Some(Part::Loop { next, inert, operands: run.len(), blended: true })
    }

    /// The greatest of some numbers, if they are all constants or all one.
    fn widest(&mut self, widths: impl Iterator<Item = NodeId>) -> Option<NodeId> {
        let mut widest: Option<NodeId> = None;
        for width in widths {
            widest = match widest {
                None => Some(width),
                Some(other) if other == width => continue,
                Some(other) => {
                    let greater = self.graph.as_number(width)?.max(self.graph.as_number(other)?);
                    Some(self.graph.number(greater))
                }
            };
        }
        widest
    }

    fn build(&mut self, plan: usize, new: &IdMap<NodeId>) -> NodeId {
        let mapped = |id: NodeId| new.get(id).unwrap_or(id);
        let parts = std::mem::take(&mut self.found[plan].parts);
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
                Part::Loop { next, inert, operands, blended } => {
                    let far = self.graph.number(FAR);
                    let start = value.filter(|_| blended).unwrap_or(far);
                    let cap = operands as u32;
                    let (start, next) = (vec![start], vec![next]);
                    let repeated = Loop {
                        depth: 0,
                        max_iterations: cap,
                        count: None,
                        condition: None,
                        init: start,
                        step: next,
                        skip: inert,
                    };
                    let result = self.graph.add_loop(repeated)[0];
                    match value.filter(|_| !blended) {
                        Some(value) => self.graph.min(value, result),
                        None => result,
                    }
                }
            });
        }
        self.found[plan].parts = parts;
        value.unwrap_or_else(|| self.graph.number(FAR))
    }

    fn rebuilt(&mut self, id: NodeId, new: &IdMap<NodeId>) -> NodeId {
        let changed = self.graph.arguments(id).any(|id| new.get(id).is_some_and(|new| new != id));
        if changed { self.graph.rebuild(id, |old| new.get(old).unwrap_or(old)) } else { id }
    }
}
