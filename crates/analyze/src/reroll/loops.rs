//! Loops over similar operands.

use sdfc_graph::{Graph, Loop, NodeId, SkipCondition};

/// Smallest number of similar operands that become a loop.
pub(super) const MIN_OPERANDS: usize = 16;

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
