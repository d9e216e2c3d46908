//! Tracing the operations of an evaluation that can jump.

use super::op::Op;

/// Sees each operation that can jump, in the order in which they run.
pub(super) trait Tracer<N> {
    /// True if it sees operations.
    const IS_ACTIVE: bool = true;

    /// The value to use instead of the result.
    fn jumped(&mut self, op: Op, arguments: [N; 3], result: N) -> N;
}

/// A tracer that changes nothing.
pub(super) struct NoTrace;

impl<N> Tracer<N> for NoTrace {
    const IS_ACTIVE: bool = false;

    #[inline(always)]
    fn jumped(&mut self, _: Op, _: [N; 3], result: N) -> N {
        result
    }
}
