//! Loops and lists of similar nodes, as parts of their template.
//!
//! Texts and polygons are loops over the lists of their pieces. Those of similar operands become
//! one loop that is nested in the loop over the operands. Its lists are theirs, one after another.

use rustc_hash::FxHashMap;
use sdfc_graph::{
    Binary, Graph, Loop, LoopVar, MAX_LOOP_DEPTH, Node, NodeId, Table, TableId, Ternary, Type,
    Unary,
};

use crate::reroll::shape_keys::{LoopForm, Operation};
use crate::reroll::template::{Expression, Merging};

/// Some lists as one, in which equal ones are stored once.
#[derive(Clone, Debug)]
pub(super) struct JoinedList {
    list: TableId,
    /// The index of the first element of each list.
    firsts: Vec<usize>,
    /// The number of elements of each list, minus 1.
    lasts: Vec<usize>,
}

impl JoinedList {
    fn new(graph: &mut Graph, lists: &[TableId]) -> Self {
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
    form: LoopForm,
    /// The part of the state whose value is wanted.
    part: u16,
    max_iterations: u32,
    /// The subexpression that is the largest number of iterations, if the loops differ in it.
    limit: Option<usize>,
    /// The subexpressions that are the initial values, the steps and the condition.
    arguments: Vec<usize>,
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

impl Merging<'_> {
    /// The elements of some lists, at the index that a subexpression gives.
    pub(super) fn element(&mut self, column: &[NodeId], index: usize) -> Option<Expression> {
        let list_of = |&id: &NodeId| {
            let Node::Element(list, ..) = self.graph.node(id) else { return None };
            Some(list)
        };
        let lists: Vec<TableId> = column.iter().map(list_of).collect::<Option<_>>()?;
        if lists.iter().all(|&list| list == lists[0]) {
            return Some(Expression::Element(lists[0], index));
        }
        if !self.joined.contains_key(&lists) {
            let joined = JoinedList::new(self.graph, &lists);
            self.joined.insert(lists.clone(), joined);
        }
        let JoinedList { list, firsts, lasts } = self.joined.get(&lists)?.clone();
        // Each list has its own end, to which indices are clamped.
        let numbers =
            |numbers: Vec<usize>| numbers.into_iter().map(|it| [it as f64, 0.0, 0.0, 0.0]);
        let first = self.constants(Type::Scalar, numbers(firsts))?;
        let last = self.constants(Type::Scalar, numbers(lasts))?;
        let zero = self.constants(Type::Scalar, column.iter().map(|_| [0.0; 4]))?;
        let whole = self.push(Operation::Unary(Unary::Floor), vec![index]);
        let clamped = self.push(Operation::Ternary(Ternary::Clamp), vec![whole, zero, last]);
        let index = self.push(Operation::Binary(Binary::Add), vec![first, clamped]);
        Some(Expression::Element(list, index))
    }

    /// A part of the state after loops of one form. `arguments` are the subexpressions of their
    /// nodes.
    pub(super) fn nested_loop(
        &mut self,
        column: &[NodeId],
        (form, part): (LoopForm, u16),
        arguments: Vec<usize>,
    ) -> Option<Expression> {
        if form.depth + 1 >= MAX_LOOP_DEPTH {
            return None;
        }
        let iterations_of = |&id: &NodeId| {
            let Node::Loop(id, ..) = self.graph.node(id) else { return None };
            Some(self.graph.loop_at(id).max_iterations)
        };
        let all: Vec<u32> = column.iter().map(iterations_of).collect::<Option<_>>()?;
        let max_iterations = all.iter().copied().max()?;
        let limit = if all.iter().all(|&it| it == max_iterations) {
            None
        } else {
            Some(
                self.constants(Type::Scalar, all.iter().map(|&it| [f64::from(it), 0.0, 0.0, 0.0]))?,
            )
        };
        Some(Expression::Loop(NestedLoop { form, part, max_iterations, limit, arguments }))
    }
}
