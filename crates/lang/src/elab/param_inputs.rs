//! Which params are constants, and with which values.
//!
//! A param is a per-frame input unless it decides what the scene consists of: a count, an index of
//! shapes, a string, the end of a recursion. Elaboration finds these params where it needs a
//! constant. They become constants, and the scene is elaborated again.

use std::collections::{BTreeMap, BTreeSet};

use sdfc_graph::Param;

/// Number of elaborations after which all params become constants.
const MAX_ELABORATIONS: usize = 16;

/// Values for params by name, for the params that are constants. The lanes are those of
/// [`FrameValues`](sdfc_graph::eval::FrameValues).
pub type CompileValues = BTreeMap<String, [f64; 4]>;

/// Which params are constants, and with which values.
#[derive(Clone, Debug)]
pub(crate) struct ParamInputs<'v> {
    /// Params from this index on stand for literals.
    pub first_literal: usize,
    /// Params that are constants.
    pub fixed: BTreeSet<usize>,
    values: &'v CompileValues,
    elaborations: usize,
}

impl<'v> ParamInputs<'v> {
    /// All params are per-frame inputs.
    pub fn new(first_literal: usize, values: &'v CompileValues) -> Self {
        Self { first_literal, fixed: BTreeSet::new(), values, elaborations: 0 }
    }

    /// The value with which a param is a constant; `None` if it is a per-frame input. A value from
    /// outside that does not fit the param is ignored: the scene may have changed since it was set.
    pub fn fixed_value(&self, index: usize, param: &Param) -> Option<[f64; 4]> {
        self.fixed.contains(&index).then(|| {
            let given = self.values.get(&param.name).copied();
            given.filter(|lanes| param.accepts(*lanes)).unwrap_or(param.default)
        })
    }

    /// Makes more params constant. Returns false if they are constants already.
    pub fn fix(&mut self, params: &BTreeSet<usize>) -> bool {
        let before = self.fixed.len();
        self.fixed.extend(params.iter().filter(|&&param| param < self.first_literal));
        let is_new = self.fixed.len() > before;
        self.elaborations += 1;
        if is_new && self.elaborations == MAX_ELABORATIONS {
            self.fix_all();
        }
        is_new
    }

    /// Makes all params constant.
    pub fn fix_all(&mut self) {
        self.fixed.extend(0..self.first_literal);
    }
}
