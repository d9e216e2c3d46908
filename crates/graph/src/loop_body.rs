//! The nodes that a loop computes in each iteration, and the nodes outside it that it reads.

use crate::graph::Graph;
use crate::ids::IdSet;
use crate::loops::Loop;
use crate::node::{LoopId, Node, NodeId};

/// The nodes of a loop's body in ascending order, without those of loops nested in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoopBody {
    /// The nodes that the loop's condition is computed from.
    pub condition: Vec<NodeId>,
    /// The other nodes that an iteration computes.
    pub step: Vec<NodeId>,
}

impl Graph {
    /// The nodes that a node's value is computed from. For a loop these are the nodes outside it
    /// that it reads.
    pub(crate) fn inputs(&self, id: NodeId) -> Vec<NodeId> {
        if let Node::Loop(id, ..) = self.node(id) {
            self.loop_inputs(id)
        } else {
            self.evaluated_arguments(id).collect()
        }
    }

    /// The nodes outside a loop that it reads, in ascending order.
    pub fn loop_inputs(&self, id: LoopId) -> Vec<NodeId> {
        let loop_ = self.loop_at(id);
        let bit = loop_.bit();
        let mut inputs: Vec<NodeId> = loop_.count.into_iter().collect();
        inputs.extend(&loop_.init);
        let mut seen = IdSet::default();
        let mut pending: Vec<NodeId> =
            loop_.condition.into_iter().chain(loop_.step.iter().copied()).collect();
        while let Some(id) = pending.pop() {
            if !seen.insert(id) {
                continue;
            }
            if self.loops_around(id) & bit == 0 {
                inputs.push(id);
            } else {
                pending.extend(self.inputs(id));
            }
        }
        inputs.sort_unstable();
        inputs.dedup();
        inputs
    }

    /// The nodes that each iteration of a loop computes.
    pub fn loop_body(&self, id: LoopId) -> LoopBody {
        let loop_ = self.loop_at(id);
        let mut seen = IdSet::default();
        let condition = self.nodes_inside(loop_, loop_.condition.as_slice(), &mut seen);
        let step = self.nodes_inside(loop_, &loop_.step, &mut seen);
        LoopBody { condition, step }
    }

    fn nodes_inside(&self, loop_: &Loop, roots: &[NodeId], seen: &mut IdSet) -> Vec<NodeId> {
        let bit = loop_.bit();
        let mut found = Vec::new();
        let mut pending = roots.to_vec();
        while let Some(id) = pending.pop() {
            if !seen.insert(id) {
                continue;
            }
            if self.loops_around(id) & bit != 0 && self.loops_around(id) < bit << 1 {
                found.push(id);
            }
            // A nested loop may read nodes that no other node of this body reads.
            let arguments = self.evaluated_arguments(id);
            pending.extend(arguments.filter(|&id| self.loops_around(id) >= bit));
        }
        found.sort_unstable();
        found
    }
}
