//! Loops over similar operands.

use sdfc_graph::{Graph, Loop, NodeId, SkipCondition};

use crate::cost::cost;

/// Number of similar operands that become a loop however simple they are.
pub(super) const MIN_OPERANDS: usize = 16;

/// Number of similar operands that become a loop if their formulas are long: if the loop has fewer
/// operations by [`MIN_SAVED_OPERATIONS`].
const MIN_LONG_OPERANDS: usize = 4;
const MIN_SAVED_OPERATIONS: usize = 1000;

/// True if a loop over these similar operands compiles and runs faster than their formulas.
pub(super) fn is_worth_a_loop(graph: &Graph, operands: &[NodeId]) -> bool {
    let count = operands.len();
    let saved = |first| cost(graph, &[first]).operations * (count - 1);
    count >= MIN_OPERANDS
        || (count >= MIN_LONG_OPERANDS && saved(operands[0]) >= MIN_SAVED_OPERATIONS)
}

/// The state after a loop with one iteration for each operand.
pub(super) fn loop_over(
    graph: &mut Graph,
    operands: usize,
    init: Vec<NodeId>,
    step: Vec<NodeId>,
    skip: Option<SkipCondition>,
) -> Vec<NodeId> {
    let max_iterations = operands as u32;
    graph.add_loop(Loop {
        depth: 0,
        max_iterations,
        count: None,
        condition: None,
        init,
        step,
        skip,
    })
}
