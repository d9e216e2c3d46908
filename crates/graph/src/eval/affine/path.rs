//! Choosing results at the jumps of a field over a box that may be rotated.

use super::Affine;
use crate::eval::op::Op;
use crate::eval::tracer::Tracer;
use crate::eval::{BranchPath, Interval};

/// Comparisons are not decided: what is selected by them often meets where they change, so that
/// affine forms of both sides serve. Two different numbers do not meet, as the steps to the next
/// cell of a repetition on the left and on the right; so one of them is chosen.
impl Tracer<Affine> for &mut BranchPath {
    fn jumped(&mut self, op: Op, arguments: [Affine; 3], result: Affine) -> Affine {
        if matches!(op, Op::Lt | Op::Le | Op::Eq | Op::Ne | Op::Step) {
            return result;
        }
        let ranges = arguments.map(Affine::range);
        if op == Op::Select {
            let [_, yes, no] = ranges;
            let jumps = is_number(yes) && is_number(no) && !is_number(result.range());
            let chosen = if jumps { self.one_of([yes, no]) } else { None };
            return chosen.map_or(result, Affine::from_range);
        }
        let chosen = Tracer::<Interval>::jumped(self, op, ranges, result.range());
        if chosen == result.range() { result } else { Affine::from_range(chosen) }
    }
}

fn is_number(range: Interval) -> bool {
    range.lo() == range.hi()
}
