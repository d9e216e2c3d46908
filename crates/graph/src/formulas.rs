//! Alternative formulas of one value, and the choice between them.
//!
//! A value may have a formula that is short at a point and another one with close bounds over a
//! box. An outline is an example: at a point, a table tells which pieces may be nearest; over a
//! box, each piece has its bounds. [`Binary::Alternative`] holds both.

use std::collections::BTreeSet;

use crate::graph::Graph;
use crate::ids::IdMap;
use crate::node::{Binary, Node, NodeId, TableId};
use crate::walk::{reachable, visited};

/// The most items that the lists of a short formula may have in a shader that people read.
const MOST_PORTABLE_ITEMS: usize = 1024;

/// A choice between the two formulas of each [`Binary::Alternative`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FormulaChoice {
    /// The first, which is shorter at a point.
    Short,
    /// The second, which has closer bounds over a box.
    Bounded,
    /// The first, if its lists have at most 1,024 items together; else the second. Shaders that are
    /// embedded elsewhere hold their lists in their text.
    Portable,
}

/// The nodes that the roots are computed from by the chosen formulas, in ascending order. If no
/// value has two formulas, these are the nodes of [`reachable`](crate::reachable).
pub fn reachable_by(graph: &Graph, roots: &[NodeId], choice: FormulaChoice) -> Vec<NodeId> {
    visited(roots, |id, pending| pending.extend(graph.arguments_by(id, choice)))
}

impl Graph {
    /// Nodes with the values of all nodes that the roots are computed from, without
    /// [`Binary::Alternative`]. A node that is absent stays as it is.
    pub fn choose_formulas(&mut self, roots: &[NodeId], choice: FormulaChoice) -> IdMap<NodeId> {
        let mut new = IdMap::default();
        for id in reachable_by(self, roots, choice) {
            let changed = |id| new.get(id).unwrap_or(id);
            if let Some(chosen) = self.chosen(id, choice) {
                let chosen = changed(chosen);
                new.insert(id, chosen);
            } else if self.arguments(id).any(|id| changed(id) != id) {
                let rebuilt = self.rebuild(id, changed);
                new.insert(id, rebuilt);
            }
        }
        new
    }

    /// The chosen argument of an alternative.
    fn chosen(&self, id: NodeId, choice: FormulaChoice) -> Option<NodeId> {
        let Node::Binary(Binary::Alternative, short, bounded) = self.node(id) else { return None };
        Some(match choice {
            FormulaChoice::Short => short,
            FormulaChoice::Bounded => bounded,
            FormulaChoice::Portable if self.items_of_lists(short) <= MOST_PORTABLE_ITEMS => short,
            FormulaChoice::Portable => bounded,
        })
    }

    /// The number of items of all lists that a formula reads.
    fn items_of_lists(&self, root: NodeId) -> usize {
        let list = |id| {
            if let Node::Element(table, ..) = self.node(id) { Some(table) } else { None }
        };
        let lists: BTreeSet<TableId> =
            reachable(self, &[root]).into_iter().filter_map(list).collect();
        lists.into_iter().map(|id| self.table(id).elements.len()).sum()
    }

    /// The arguments of a node, of an alternative only the chosen one.
    fn arguments_by(&self, id: NodeId, choice: FormulaChoice) -> impl Iterator<Item = NodeId> {
        let chosen = self.chosen(id, choice);
        self.arguments(id).filter(move |&id| chosen.is_none_or(|chosen| chosen == id))
    }

    /// The arguments that an evaluator reads.
    pub(crate) fn evaluated_arguments(&self, id: NodeId) -> impl Iterator<Item = NodeId> {
        self.arguments_by(id, FormulaChoice::Bounded)
    }

    /// One node with its formulas chosen.
    pub(crate) fn with_formulas(&mut self, id: NodeId, choice: FormulaChoice) -> NodeId {
        self.choose_formulas(&[id], choice).get(id).unwrap_or(id)
    }
}
