//! How a scene uses the params that stand for literals.

use std::collections::{BTreeMap, BTreeSet};

use sdfc_graph::FrameInput;

/// How a scene uses the params that stand for literals.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LiteralUses {
    /// Params from this index on stand for literals.
    pub(super) first: usize,
    /// Literals that must stay constant, since they decide what is built: a branch, a length, a
    /// count, an index.
    pub fixed: BTreeSet<usize>,
    /// Literals in formulas that a requirement, a promise or a range constrains. Such a formula
    /// may have another value once the fixed literals are constants again.
    pub constrained: BTreeSet<usize>,
    /// Literals that are the whole value of a parameter with a range, and that range.
    pub ranges: BTreeMap<usize, [f64; 2]>,
}

impl LiteralUses {
    /// Params from index `first` on stand for literals.
    pub(crate) fn new(first: usize) -> Self {
        Self {
            first,
            fixed: BTreeSet::new(),
            constrained: BTreeSet::new(),
            ranges: BTreeMap::new(),
        }
    }

    /// The literal that an input stands for.
    pub(super) fn literal(&self, input: FrameInput) -> Option<usize> {
        match input {
            FrameInput::Param(index) => Some(index as usize).filter(|index| *index >= self.first),
            FrameInput::Time | FrameInput::Frame => None,
        }
    }
}
