//! Materials of unions of many operands: a loop finds the nearest operand, and lists hold its
//! material.
//!
//! Written out, the material of a union of n operands is n comparisons and n selections for each of
//! its properties. After this pass, a loop over similar operands finds the smallest distance and
//! the number of its operand, and the material is one formula that reads its constants from lists
//! at that number. It is evaluated once, for the operand that is seen. The loop has the skip
//! condition of the loop of the distance, so a ray runs only the iterations in its active list.
//!
//! Materials of blends are weighted sums over all operands, and stay unrolled.

use rustc_hash::FxHashMap;
use sdfc_graph::{
    Binary, Const, FAR, Graph, IdMap, LoopVar, NodeId, SkipCondition, Table, Type, reachable,
};

use crate::reroll::rewrite::{
    MIN_OPERANDS, common_operand, grouped, loop_over, positions_by_key, rebuilt,
};
use crate::reroll::selection::{Selection, minimum, selections};
use crate::reroll::template::{ShapeKeys, template};

/// Largest number of different formulas of materials in one union. All of them are evaluated, so
/// with more of them the selections stay as they are.
const MAX_KINDS: usize = 64;

/// Rewrites the properties of a material in which many operands are selected from. `replaced` maps
/// distances of unions to those that [`super::rewrite::reroll`] has made of them.
pub(crate) fn reroll_materials(
    graph: &mut Graph,
    fields: &[NodeId],
    replaced: &IdMap<NodeId>,
) -> Vec<NodeId> {
    let mut lookups = Lookups::default();
    let mut keys = ShapeKeys::default();
    for selection in selections(graph, &reachable(graph, fields)) {
        if selection.operands.len() < MIN_OPERANDS {
            continue;
        }
        if let Some((nearest, values)) = lookup(graph, &mut keys, &selection, replaced) {
            lookups.values.extend(selection.heads.iter().copied().zip(values));
            lookups.minima.insert(selection.distances, nearest.distance);
        }
    }
    if lookups.values.is_empty() {
        return fields.to_vec();
    }
    let mut new: IdMap<NodeId> = IdMap::default();
    for id in reachable(graph, fields) {
        let known = lookups.of(graph, id).or_else(|| replaced.get(id));
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
    replaced: &IdMap<NodeId>,
) -> Option<(Numbered, Vec<NodeId>)> {
    let kinds = kinds(graph, keys, selection)?;
    let nearest = nearest(graph, keys, &selection.operands, replaced)?;
    let (kind, index) = places(graph, &kinds, nearest.number);
    let mut values: Option<Vec<NodeId>> = None;
    for (number, members) in kinds.iter().enumerate() {
        let of_members = |values: &Vec<NodeId>| members.iter().map(|&at| values[at]).collect();
        let lists: Vec<Vec<NodeId>> = selection.values.iter().map(of_members).collect();
        let lists: Vec<&[NodeId]> = lists.iter().map(Vec::as_slice).collect();
        let of_kind = template(graph, keys, &lists, None, index)?;
        values = Some(match values {
            None => of_kind,
            Some(others) => {
                let number = graph.number(number as f64);
                let is_kind = graph.binary(Binary::Eq, kind, number);
                let both = of_kind.into_iter().zip(others);
                both.map(|(value, other)| graph.select(is_kind, value, other)).collect()
            }
        });
    }
    Some((nearest, values?))
}

/// Groups of operands whose materials are equal up to constants; `None` if there are too many.
fn kinds(
    graph: &mut Graph,
    keys: &mut ShapeKeys,
    selection: &Selection,
) -> Option<Vec<Vec<usize>>> {
    for values in &selection.values {
        keys.compute(graph, values);
    }
    let key = |operand: usize| -> Vec<u32> {
        selection.values.iter().map(|values| keys.of(values[operand])).collect()
    };
    let kinds = positions_by_key((0..selection.operands.len()).map(key));
    (kinds.len() <= MAX_KINDS).then_some(kinds)
}

/// The kind of an operand's material and its index in that kind, by the number of the operand.
fn places(graph: &mut Graph, kinds: &[Vec<usize>], number: NodeId) -> (NodeId, NodeId) {
    if kinds.len() == 1 {
        return (graph.number(0.0), number);
    }
    let mut elements = vec![Const::new(Type::Vec2, &[0.0; 2]); kinds.iter().map(Vec::len).sum()];
    for (kind, members) in kinds.iter().enumerate() {
        for (index, &member) in members.iter().enumerate() {
            elements[member] = Const::new(Type::Vec2, &[kind as f64, index as f64]);
        }
    }
    let place = graph.element(Table { ty: Type::Vec2, elements }, number);
    (graph.swizzle(place, &[0]), graph.swizzle(place, &[1]))
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
    replaced: &IdMap<NodeId>,
) -> Option<Numbered> {
    let mut nearest: Option<Numbered> = None;
    let mut has_loop = false;
    for group in grouped(graph, keys, operands) {
        let looped = nearest_of_kind(graph, keys, operands, &group);
        has_loop |= looped.is_some();
        let found = looped.map_or_else(
            || group.iter().map(|&member| alone(graph, operands, member, replaced)).collect(),
            |looped| vec![looped],
        );
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

/// The nearest of similar operands, by a loop; `None` if they are too few or have no common
/// formula.
fn nearest_of_kind(
    graph: &mut Graph,
    keys: &ShapeKeys,
    operands: &[NodeId],
    group: &[usize],
) -> Option<Numbered> {
    let members: Vec<NodeId> = group.iter().map(|&member| operands[member]).collect();
    let operand = common_operand(graph, keys, &members)?;
    let index = graph.variable(0, LoopVar::Index, Type::Scalar);
    let elements = group.iter().map(|&member| Const::new(Type::Scalar, &[member as f64]));
    let elements: Vec<Const> = elements.collect();
    let number = graph.element(Table { ty: Type::Scalar, elements }, index);
    let best = [0, 1].map(|part| graph.variable(0, LoopVar::State(part), Type::Scalar));
    let is_nearer = graph.lt(operand, best[0]);
    let init = vec![graph.number(FAR), graph.number(0.0)];
    let step = vec![graph.min(best[0], operand), graph.select(is_nearer, number, best[1])];
    let margin = graph.number(0.0);
    let skip = Some(SkipCondition { operand, margin });
    let result = loop_over(graph, group.len(), init, step, skip);
    Some(Numbered { distance: result[0], number: result[1] })
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
