//! Kinds of values: those of a kind are equal up to constants and share a formula.

use std::hash::Hash;

use rustc_hash::FxHashMap;
use sdfc_graph::{Binary, Const, Graph, IdMap, LoopVar, NodeId, Table, Type};

use crate::reroll::loops::is_worth_a_loop;
use crate::reroll::shape_keys::ShapeKeys;
use crate::reroll::template::template;

/// Groups of positions of values that are equal up to constants.
pub(super) fn grouped(
    graph: &mut Graph,
    keys: &mut ShapeKeys,
    values: &[NodeId],
) -> Vec<Vec<usize>> {
    keys.compute(graph, values);
    positions_by_key(values.iter().map(|&value| keys.of(value)))
}

/// The positions of equal keys, in the order of their first positions.
pub(super) fn positions_by_key<K: Eq + Hash>(keys: impl Iterator<Item = K>) -> Vec<Vec<usize>> {
    let mut group_of: FxHashMap<K, usize> = FxHashMap::default();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (position, key) in keys.enumerate() {
        let group = *group_of.entry(key).or_insert(groups.len());
        if group == groups.len() {
            groups.push(Vec::new());
        }
        groups[group].push(position);
    }
    groups
}

/// Similar operands of a minimum.
#[derive(Debug)]
pub(super) struct Kind {
    /// Their positions.
    pub(super) members: Vec<usize>,
    /// Their formula; `None` if no loop is worth it.
    pub(super) operand: Option<Operand>,
}

/// The formula of similar operands and its bounds, by the index of a loop at depth 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Operand {
    pub(super) value: NodeId,
    /// A lower and an upper bound: the value itself, or what [`OperandBounds`] has.
    pub(super) bounds: [NodeId; 2],
}

/// A lower and an upper bound of operands that cost much.
pub(crate) type OperandBounds = IdMap<[NodeId; 2]>;

/// The kinds of the operands of a minimum. Operands without a common formula, because their
/// per-frame values differ too much, are divided into kinds in which these differ less.
pub(super) fn kinds(
    graph: &mut Graph,
    keys: &mut ShapeKeys,
    operands: &[NodeId],
    bounds: &OperandBounds,
) -> Vec<Kind> {
    let mut found = Vec::new();
    for members in grouped(graph, keys, operands) {
        let values: Vec<NodeId> = members.iter().map(|&at| operands[at]).collect();
        let operand = common_operand(graph, keys, &values, bounds);
        let is_divided = operand.is_none() && is_worth_a_loop(graph, &values);
        match keys.stricter().filter(|_| is_divided) {
            Some(mut stricter) => {
                let inner = kinds(graph, &mut stricter, &values, bounds).into_iter();
                found.extend(inner.map(|kind| Kind {
                    members: kind.members.into_iter().map(|at| members[at]).collect(),
                    ..kind
                }));
            }
            None => found.push(Kind { members, operand }),
        }
    }
    found
}

/// The formula of similar operands of a minimum, by the index of a loop; `None` if they are too few
/// or differ in more than constants.
fn common_operand(
    graph: &mut Graph,
    keys: &mut ShapeKeys,
    operands: &[NodeId],
    bounds: &OperandBounds,
) -> Option<Operand> {
    if !is_worth_a_loop(graph, operands) {
        return None;
    }
    let index = graph.variable(0, LoopVar::Index, Type::Scalar);
    let ends: Option<Vec<[NodeId; 2]>> = operands.iter().map(|&it| bounds.get(it)).collect();
    let Some(ends) = ends else {
        let value = *template(graph, keys, &[operands], &[], index)?.first()?;
        return Some(Operand { value, bounds: [value; 2] });
    };
    let [lower, upper] = [0, 1].map(|end| ends.iter().map(|ends| ends[end]).collect::<Vec<_>>());
    let both = template(graph, keys, &[operands, &lower, &upper], &[], index)?;
    let &[value, lower, upper] = both.as_slice() else { return None };
    Some(Operand { value, bounds: [lower, upper] })
}

/// One formula for each list of nodes, whose value is the list's node i where `number` is i.
/// Positions whose nodes are equal up to constants share a formula; all formulas are evaluated, and
/// a list says which one counts. Returns `None` if there are more than `max_kinds` of them.
pub(super) fn formulas_by_kind(
    graph: &mut Graph,
    keys: &mut ShapeKeys,
    lists: &[&[NodeId]],
    number: NodeId,
    max_kinds: usize,
) -> Option<Vec<NodeId>> {
    let found = formulas(graph, keys, lists, number, max_kinds);
    // Per-frame values may differ too much.
    found.or_else(|| formulas_by_kind(graph, &mut keys.stricter()?, lists, number, max_kinds))
}

fn formulas(
    graph: &mut Graph,
    keys: &mut ShapeKeys,
    lists: &[&[NodeId]],
    number: NodeId,
    max_kinds: usize,
) -> Option<Vec<NodeId>> {
    lists.iter().for_each(|list| keys.compute(graph, list));
    let key = |position: usize| -> Vec<u32> {
        lists.iter().map(|list| keys.of(list[position])).collect()
    };
    let kinds = positions_by_key((0..lists.first()?.len()).map(key));
    if kinds.len() > max_kinds {
        return None;
    }
    let (kind, index) = places(graph, &kinds, number);
    let mut values: Option<Vec<NodeId>> = None;
    for (number, members) in kinds.iter().enumerate() {
        let of_members = |list: &&[NodeId]| members.iter().map(|&at| list[at]).collect();
        let columns: Vec<Vec<NodeId>> = lists.iter().map(of_members).collect();
        let columns: Vec<&[NodeId]> = columns.iter().map(Vec::as_slice).collect();
        let of_kind = template(graph, keys, &columns, &[], index)?;
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
    values
}

/// The kind of a member and its index in that kind, by the number of the member.
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
