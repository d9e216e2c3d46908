//! Watching an evaluation pass operations that jump.

use super::op::Op;

/// Is told of each operation that jumps, in the order in which they run.
pub(super) trait Watch<N> {
    /// What to go on with instead of the result.
    fn jumped(&mut self, op: Op, arguments: [N; 3], result: N) -> N;
}

/// Watches nothing.
pub(super) struct Unwatched;

impl<N> Watch<N> for Unwatched {
    #[inline(always)]
    fn jumped(&mut self, _: Op, _: [N; 3], result: N) -> N {
        result
    }
}
