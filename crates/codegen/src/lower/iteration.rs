//! The variables of one iteration of a loop.

use super::body::Value;

/// The values that a loop's body reads: the number of the iteration, and the state.
pub(super) struct Iteration {
    /// The number of the iteration.
    pub(super) number: Value,
    /// The number as a word, and its upper bound (exclusive), if it was read from a list.
    pub(super) listed: Option<(Value, u32)>,
    /// The state at the start of the iteration.
    pub(super) state: Vec<Value>,
}

impl Iteration {
    /// An iteration without a state.
    pub(super) fn of_number(number: Value) -> Self {
        Self { number, listed: None, state: Vec::new() }
    }
}
