//! Materials of unions of many operands: a loop finds the nearest operand, and lists hold its
//! material.
//!
//! Written out, the material of a union of n operands is n comparisons and n selections for each of
//! its properties. After this pass, a loop over similar operands finds the smallest distance and
//! the number of its operand, and the material is one formula that reads its constants from lists
//! at that number. It is evaluated once, for the operand that is seen. The loop has the skip
//! condition of the loop of the distance, so a ray runs only the iterations in its active list.
//!
//! The material of a chain of blends becomes a loop that carries the distance and the material, and
//! mixes in the material of one operand in each iteration (see `blended`).

use rustc_hash::FxHashMap;
use sdfc_graph::{
    Binary, Blends, Const, FAR, Graph, IdMap, LoopVar, MaterialChain, NodeId, Rewritten,
    SkipCondition, Table, Type, fold_transforms, reachable,
};

use crate::reroll::blended::{MaterialLoop, joined};
use crate::reroll::kinds::{Kind, Operand, OperandBounds, formulas_by_kind, kinds};
use crate::reroll::loops::loop_over;
use crate::reroll::rewrite::rebuilt;
use crate::reroll::selection::{Selection, minimum, selections};
use crate::reroll::shape_keys::ShapeKeys;

/// Largest number of different formulas of materials in one union. All of them are evaluated, so
/// with more of them the selections stay as they are.
const MAX_KINDS: usize = 64;

/// Folds the transforms of some roots, and of chains of blends that belong to them.
pub(crate) fn fold_with_chains(
    graph: &mut Graph,
    roots: &[NodeId],
    chains: Vec<MaterialChain>,
) -> (Rewritten, Vec<MaterialChain>) {
    let all: Vec<NodeId> =
        roots.iter().copied().chain(chains.iter().flat_map(MaterialChain::nodes)).collect();
    let mut folded = fold_transforms(graph, &all);
    let nodes = folded.roots.split_off(roots.len());
    let mut rest = &nodes[..];
    let fold = |chain: MaterialChain| {
        let (own, others) = rest.split_at(chain.nodes().len());
        rest = others;
        chain.with_nodes(own)
    };
    let chains = chains.into_iter().map(fold).collect();
    (folded, chains)
}

/// Rewrites the properties of a material in which many operands are selected from or blended.
/// `replaced` maps distances of unions to those that [`super::rewrite::reroll`] has made of them.
/// `chains` are the chains of blends in the material.
pub(crate) fn reroll_materials(
    graph: &mut Graph,
    fields: &[NodeId],
    (replaced, bounds): (&IdMap<NodeId>, &OperandBounds),
    chains: &[MaterialChain],
) -> Vec<NodeId> {
    let mut lookups = Lookups::default();
    let mut keys = ShapeKeys::default();
    let mut blends = Blends::default();
    let plan = |chain: &MaterialChain| MaterialLoop::plan(graph, &mut keys, &mut blends, chain);
    let loops: Vec<MaterialLoop> = joined(chains).iter().filter_map(plan).collect();
    let loop_of: FxHashMap<NodeId, (usize, usize)> = loops
        .iter()
        .enumerate()
        .flat_map(|(number, planned)| {
            planned.fields.iter().enumerate().map(move |(at, &field)| (field, (number, at)))
        })
        .collect();
    for selection in selections(graph, &reachable(graph, fields)) {
        if let Some((nearest, values)) = lookup(graph, &mut keys, &selection, (replaced, bounds)) {
            lookups.values.extend(selection.heads.iter().copied().zip(values));
            lookups.minima.insert(selection.distances, nearest.distance);
        }
    }
    if lookups.values.is_empty() && loops.is_empty() {
        return fields.to_vec();
    }
    let mut new: IdMap<NodeId> = IdMap::default();
    for id in reachable(graph, fields) {
        let looped = loop_of.get(&id).map(|&(number, at)| loops[number].build(graph, &new)[at]);
        let known = looped.or_else(|| lookups.of(graph, id)).or_else(|| replaced.get(id));
        let built = known.unwrap_or_else(|| rebuilt(graph, id, &new));
        new.insert(id, built);
    }
    fields.iter().map(|&field| new.get(field).unwrap_or(field)).collect()
}

/// The nodes that take the place of selections and of their minima.
#[derive(Default)]
struct Lookups {
    /// The new values of the heads of selections.
    values: FxHashMap<NodeId, NodeId>,
    /// The distances to the nearest operand, by the arguments of the minimum.
    minima: FxHashMap<[NodeId; 2], NodeId>,
}

impl Lookups {
    /// The node that takes the place of another one.
    fn of(&self, graph: &Graph, id: NodeId) -> Option<NodeId> {
        let minimum = || self.minima.get(&minimum(graph, id)?);
        self.values.get(&id).or_else(minimum).copied()
    }
}

/// The nearest operand of a selection, and the value of each head for it; `None` if no loop is
/// worth it.
fn lookup(
    graph: &mut Graph,
    keys: &mut ShapeKeys,
    selection: &Selection,
    known: (&IdMap<NodeId>, &OperandBounds),
) -> Option<(Numbered, Vec<NodeId>)> {
    let lists: Vec<&[NodeId]> = selection.values.iter().map(Vec::as_slice).collect();
    let nearest = nearest(graph, keys, &selection.operands, known)?;
    let values = formulas_by_kind(graph, keys, &lists, nearest.number, MAX_KINDS)?;
    Some((nearest, values))
}

/// A distance and the number of the operand that has it.
#[derive(Clone, Copy)]
struct Numbered {
    distance: NodeId,
    number: NodeId,
}

/// The nearest operand; `None` if there is nothing for a loop.
fn nearest(
    graph: &mut Graph,
    keys: &mut ShapeKeys,
    operands: &[NodeId],
    (replaced, bounds): (&IdMap<NodeId>, &OperandBounds),
) -> Option<Numbered> {
    let mut nearest: Option<Numbered> = None;
    let mut has_loop = false;
    for Kind { members, operand } in kinds(graph, keys, operands, bounds) {
        has_loop |= operand.is_some();
        let found = match operand {
            Some(operand) => vec![nearest_of_kind(graph, operand, &members)],
            None => {
                members.iter().map(|&member| alone(graph, operands, member, replaced)).collect()
            }
        };
        for other in found {
            nearest = Some(match nearest {
                None => other,
                Some(nearest) => nearer(graph, nearest, other),
            });
        }
    }
    nearest.filter(|_| has_loop)
}

fn alone(
    graph: &mut Graph,
    operands: &[NodeId],
    member: usize,
    replaced: &IdMap<NodeId>,
) -> Numbered {
    let distance = replaced.get(operands[member]).unwrap_or(operands[member]);
    Numbered { distance, number: graph.number(member as f64) }
}

/// The nearest of similar operands with this common formula, by a loop.
fn nearest_of_kind(graph: &mut Graph, operand: Operand, members: &[usize]) -> Numbered {
    let index = graph.variable(0, LoopVar::Index, Type::Scalar);
    let elements = members.iter().map(|&member| Const::new(Type::Scalar, &[member as f64]));
    let elements: Vec<Const> = elements.collect();
    let number = graph.element(Table { ty: Type::Scalar, elements }, index);
    let best = [0, 1].map(|part| graph.variable(0, LoopVar::State(part), Type::Scalar));
    let is_nearer = graph.lt(operand.value, best[0]);
    let init = vec![graph.number(FAR), graph.number(0.0)];
    let step = vec![graph.min(best[0], operand.value), graph.select(is_nearer, number, best[1])];
    let [lower, upper] = operand.bounds;
    let skip = Some(SkipCondition { lower, upper, margin: graph.number(0.0) });
    let result = loop_over(graph, members.len(), init, step, skip);
    Numbered { distance: result[0], number: result[1] }
}

/// The nearer one; of equal distances the one with the smaller number.
fn nearer(graph: &mut Graph, a: Numbered, b: Numbered) -> Numbered {
    let is_nearer = graph.lt(b.distance, a.distance);
    let is_equal = graph.binary(Binary::Eq, b.distance, a.distance);
    let is_before = graph.lt(b.number, a.number);
    let is_first = graph.binary(Binary::And, is_equal, is_before);
    let takes_b = graph.binary(Binary::Or, is_nearer, is_first);
    Numbered {
        distance: graph.min(a.distance, b.distance),
        number: graph.select(takes_b, b.number, a.number),
    }
}
