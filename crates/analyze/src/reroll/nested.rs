//! Loops and lists of similar nodes, as parts of their template.
//!
//! Texts and polygons are loops over the lists of their pieces. Those of similar operands become
//! one loop that is nested in the loop over the operands. Its lists are theirs, one after another.

use rustc_hash::FxHashMap;
use sdfc_graph::{Binary, Graph, Loop, LoopVar, Node, NodeId, Table, TableId, Type};

use crate::reroll::shape_keys::LoopForm;

/// Some lists as one, in which equal ones are stored once.
#[derive(Clone, Debug)]
pub(super) struct JoinedList {
    pub(super) list: TableId,
    /// The index of the first element of each list.
    pub(super) firsts: Vec<usize>,
    /// The number of elements of each list, minus 1.
    pub(super) lasts: Vec<usize>,
}

impl JoinedList {
    pub(super) fn new(graph: &mut Graph, lists: &[TableId]) -> Self {
        let mut first_of: FxHashMap<TableId, usize> = FxHashMap::default();
        let ty = graph.table(lists[0]).ty;
        let (mut elements, mut firsts, mut lasts) = (Vec::new(), Vec::new(), Vec::new());
        for &list in lists {
            let own = &graph.table(list).elements;
            let first = *first_of.entry(list).or_insert_with(|| {
                let first = elements.len();
                elements.extend_from_slice(own);
                first
            });
            firsts.push(first);
            lasts.push(own.len().saturating_sub(1));
        }
        Self { list: graph.add_table(Table { ty, elements }), firsts, lasts }
    }
}

/// A loop in the loop over the operands.
pub(super) struct NestedLoop {
    pub(super) form: LoopForm,
    /// The part of the state whose value is wanted.
    pub(super) part: u16,
    pub(super) max_iterations: u32,
    /// The subexpression that is the largest number of iterations, if the loops differ in it.
    pub(super) limit: Option<usize>,
    /// The subexpressions that are the initial values, the steps and the condition.
    pub(super) arguments: Vec<usize>,
}

impl NestedLoop {
    /// Builds the loop. `values` are the nodes of the subexpressions before it.
    pub(super) fn build(&self, graph: &mut Graph, values: &[NodeId]) -> NodeId {
        let LoopForm { depth, parts, count, .. } = self.form;
        let depth = depth + 1;
        let nodes: Vec<NodeId> = self.arguments.iter().map(|&at| values[at]).collect();
        let mut condition = nodes.get(2 * parts).copied();
        if let Some(limit) = self.limit {
            let index = graph.variable(depth, LoopVar::Index, Type::Scalar);
            let is_own = graph.lt(index, values[limit]);
            condition = Some(match condition {
                Some(condition) => graph.binary(Binary::And, is_own, condition),
                None => is_own,
            });
        }
        let (init, step) = (nodes[..parts].to_vec(), nodes[parts..2 * parts].to_vec());
        let max_iterations = self.max_iterations;
        let looped = Loop { depth, max_iterations, count, condition, init, step, skip: None };
        graph.add_loop(looped)[usize::from(self.part)]
    }
}

/// A variable of a loop, in a loop that is nested in one more.
pub(super) fn nested_variable(graph: &mut Graph, id: NodeId) -> NodeId {
    let Node::Variable(depth, variable, ty) = graph.node(id) else { return id };
    graph.variable(depth + 1, variable, ty)
}
