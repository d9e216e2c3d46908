//! Loops and constant tables: what a shader repeats or looks up instead of writing it out.
//!
//! A loop's body is ordinary math over [`Node::Variable`](crate::Node::Variable)s, which stand for
//! the iteration index and for the parts of the state. A loop that is nested in `depth` others uses
//! variables of that depth. Nodes that depend on no variable of the loop lie outside its body and
//! are computed once. [`Graph::loops_around`](crate::Graph::loops_around) tells which loops a node
//! lies in. Passes that treat nodes one by one need not know about loops; passes that decide where
//! a node is computed (tapes, the lowering) call [`Graph::loop_body`](crate::Graph::loop_body).

use crate::node::{Const, NodeId, Type};

/// Maximum nesting depth of loops.
pub const MAX_LOOP_DEPTH: u8 = 7;

/// A loop. The state starts as `init`, and each iteration replaces it by `step`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Loop {
    /// Number of loops around this one; below [`MAX_LOOP_DEPTH`].
    pub depth: u8,
    /// Upper bound on the number of iterations, known when the scene compiles.
    pub max_iterations: u32,
    /// Number of iterations, a scalar known per frame. Iteration i runs only if `i < count`.
    pub count: Option<NodeId>,
    /// A truth value over the variables. The loop ends at the first iteration where it is false.
    pub condition: Option<NodeId>,
    /// The parts of the state before the first iteration.
    pub init: Vec<NodeId>,
    /// The parts of the state after an iteration, over the variables; of the same types as `init`.
    pub step: Vec<NodeId>,
    /// The condition under which an iteration may be skipped, if one is known.
    pub skip: Option<SkipCondition>,
}

/// A condition under which an iteration is a no-op.
///
/// An iteration combines the state with an operand. It does not change the state wherever
/// `operand >= state[0] + margin`, with the state before the iteration. Where that can be proven
/// for a region, the iteration may be skipped there. Both bounds are the operand itself, unless
/// that costs much.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SkipCondition {
    /// A lower bound of the operand: a scalar over the iteration index and over nodes outside the
    /// loop. It does not depend on the state.
    pub lower: NodeId,
    /// An upper bound of the operand, over the same; [`crate::FAR`] if none is known.
    pub upper: NodeId,
    /// A scalar of at least 0, known per frame.
    pub margin: NodeId,
}

impl SkipCondition {
    /// The nodes of the condition.
    pub fn nodes(self) -> [NodeId; 3] {
        [self.lower, self.upper, self.margin]
    }

    /// The same condition over other nodes.
    pub fn map(self, map: impl FnMut(NodeId) -> NodeId) -> Self {
        let [lower, upper, margin] = self.nodes().map(map);
        Self { lower, upper, margin }
    }
}

impl Loop {
    /// All nodes that the loop refers to: count, condition, init, step, skip condition.
    pub fn arguments(&self) -> impl Iterator<Item = NodeId> {
        (0..).map_while(|position| self.argument(position))
    }

    /// One of [`Self::arguments`] by position.
    pub(crate) fn argument(&self, position: usize) -> Option<NodeId> {
        let head = usize::from(self.count.is_some()) + usize::from(self.condition.is_some());
        if position < head {
            return if position == 0 { self.count.or(self.condition) } else { self.condition };
        }
        let rest = self.init.iter().chain(&self.step).copied();
        let skip = self.skip.into_iter().flat_map(SkipCondition::nodes);
        rest.chain(skip).nth(position - head)
    }

    /// The same loop over other nodes.
    pub(crate) fn map(&self, mut map: impl FnMut(NodeId) -> NodeId) -> Self {
        Self {
            depth: self.depth,
            max_iterations: self.max_iterations,
            count: self.count.map(&mut map),
            condition: self.condition.map(&mut map),
            init: self.init.iter().copied().map(&mut map).collect(),
            step: self.step.iter().copied().map(&mut map).collect(),
            skip: self.skip.map(|skip| skip.map(map)),
        }
    }

    /// True if this loop carries the other loop's state and more.
    pub(crate) fn extends(&self, other: &Self) -> bool {
        let same = (self.depth, self.max_iterations, self.count, self.condition, self.skip)
            == (other.depth, other.max_iterations, other.count, other.condition, other.skip);
        same && self.init.len() > other.init.len()
            && self.init.starts_with(&other.init)
            && self.step.starts_with(&other.step)
    }

    /// The bit that stands for the loop's depth in
    /// [`Graph::loops_around`](crate::Graph::loops_around).
    pub(crate) fn bit(&self) -> u8 {
        1 << self.depth
    }
}

/// A table of constants of one type.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Table {
    /// Type of the elements.
    pub ty: Type,
    /// The elements: at least one.
    pub elements: Vec<Const>,
}

impl Table {
    /// One lane of all elements.
    pub(crate) fn lane(&self, lane: usize) -> Vec<f64> {
        self.elements.iter().map(|element| element.lanes()[lane]).collect()
    }
}
