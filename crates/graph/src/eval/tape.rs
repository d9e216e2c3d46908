//! A tape: a flat program of scalar instructions over a small register file.

use super::op::Op;
use super::scalarise::Lanes;
use crate::node::{FrameInput, NodeId};

/// The reason why nodes cannot be evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TapeError {
    /// The node samples a shape or its material. It must be expanded first.
    Unexpanded(NodeId),
    /// The node is the point of an inner formula, which has no value.
    InnerPoint(NodeId),
}

impl std::fmt::Display for TapeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unexpanded(id) => write!(f, "node {} is not expanded", id.index()),
            Self::InnerPoint(id) => {
                write!(f, "node {} is the point of an inner formula", id.index())
            }
        }
    }
}

impl std::error::Error for TapeError {}

/// Nodes as scalar instructions, which run in any [`Number`](super::Number) type.
///
/// Values that do not depend on the point come first and run once per frame ([`Tape::prepare`]).
/// The rest runs at each point ([`Evaluator::eval`](super::Evaluator::eval)) in registers, which
/// are reused after their last use. Lanes and scalar operations that no root needs are dropped.
#[derive(Clone, Debug)]
pub struct Tape {
    /// Definitions of per-frame values; arguments are indices of earlier ones.
    pub(super) prelude: Vec<Definition>,
    /// True if the prelude consists of constants.
    pub(super) is_constant: bool,
    /// The per-frame values that points need: register i starts as prelude value `kept[i]`.
    pub(super) kept: Vec<u32>,
    pub(super) body: Vec<Code>,
    /// Number of operations, if all loops run for as many iterations as they may.
    pub(super) operations: usize,
    pub(super) lists: Vec<Vec<f64>>,
    pub(super) registers: usize,
    pub(super) outputs: Vec<Lanes<u32>>,
}

/// Code that runs at a point.
#[derive(Clone, Debug)]
pub(super) enum Code {
    /// Instructions in sequence.
    Straight(Vec<Instruction>),
    /// A lookup of an element of a list.
    Lookup {
        list: usize,
        at: u32,
        result: u32,
    },
    /// Ends the enclosing loop where the register is false.
    Test(u32),
    Loop(LoopCode),
}

/// A loop over registers.
#[derive(Clone, Debug)]
pub(super) struct LoopCode {
    pub(super) max_iterations: u32,
    pub(super) count: Option<u32>,
    pub(super) index: u32,
    pub(super) state: Vec<StateCode>,
    pub(super) body: Vec<Code>,
}

/// The registers of one scalar of a loop's state.
#[derive(Clone, Copy, Debug)]
pub(super) struct StateCode {
    pub(super) init: u32,
    /// The value before an iteration, which the body reads.
    pub(super) variable: u32,
    /// The value after an iteration, which the body computes.
    pub(super) step: u32,
    /// A copy of `step`, kept until all of the body has read its variables.
    pub(super) copy: u32,
    /// The value when the loop ended.
    pub(super) result: u32,
}

/// An instruction over registers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instruction {
    pub(super) op: Op,
    pub(super) result: u32,
    pub(super) arguments: [u32; 3],
}

/// The definition of a scalar; arguments are indices of earlier definitions.
#[derive(Clone, Copy, Debug)]
pub(super) enum Definition {
    Constant(f64),
    Input(FrameInput, usize),
    Point(usize),
    Apply(Op, [u32; 3]),
    /// An element of a list, given the list's index in the recorder.
    Lookup(usize, u32),
    /// The begin of a loop, its condition and its end, given the loop's index in the recorder.
    Enter(usize),
    Test(usize),
    Leave(usize),
    /// A register that a loop writes.
    Register,
}

/// Number of registers that hold a point; they follow the registers of per-frame values.
pub(super) const POINT_LANES: usize = 3;

impl Tape {
    /// Number of scalar operations per point, if all loops run for as many iterations as they may.
    pub fn operations(&self) -> usize {
        self.operations
    }

    /// True if there are loops, which may run fewer iterations at a point than over a region.
    pub fn has_loops(&self) -> bool {
        self.body.iter().any(|code| matches!(code, Code::Loop(_)))
    }

    /// Number of registers of an evaluator.
    pub fn registers(&self) -> usize {
        self.registers
    }
}
