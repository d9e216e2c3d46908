//! One choice of results at the jumps of a field over a box.

use super::Interval;
use crate::eval::op::Op;
use crate::eval::tracer::Tracer;

/// A choice of results for an evaluation over intervals, at operations that jump within the box.
///
/// Over a box that contains parts of two cells of a repetition, the interval of the cell's number
/// is of little use, and the interval of its hash of none. So the first operation with more than
/// one whole result is decided: for each of these results the field is evaluated again, with that
/// result in place of the interval. An angle across its branch cut counts as two results, one per
/// side. At each point of the box some path gives the field, so what holds on all paths holds in
/// the box. On a path that leaves nothing open, the formula has no jumps, and its range shrinks
/// with the box.
///
/// ```
/// use sdfc_graph::eval::{FrameValues, Interval, BranchPath, Tape};
/// use sdfc_graph::{Dim, Graph, Unary};
///
/// // x - round(x) + 1 lies between 0.5 and 1.5, which one interval cannot show at a jump.
/// let mut graph = Graph::new();
/// let p = graph.point(0, Dim::Three);
/// let (x, one) = (graph.component(p, 0), graph.number(1.0));
/// let cell = graph.unary(Unary::Round, x);
/// let offset = graph.sub(x, cell);
/// let root = graph.add(offset, one);
/// let tape = Tape::new(&graph, &[root])?;
/// let mut field = tape.prepare::<Interval>(&FrameValues::default());
///
/// let region = [Interval::new(0.45, 0.55), Interval::ENTIRE, Interval::ENTIRE];
/// let mut path = BranchPath::default();
/// assert!(field.scalar_along(region, &mut path).contains(1.0));
/// assert!(path.fork(1));
/// assert!(field.scalar_along(region, &mut path).lo() > 1.4); // the lower cell
/// assert!(path.advance());
/// assert!(field.scalar_along(region, &mut path).hi() < 0.6); // the upper cell
/// assert!(!path.advance());
/// # Ok::<(), sdfc_graph::eval::TapeError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct BranchPath {
    decisions: Vec<Decision>,
    /// Number of decisions that the current evaluation has passed.
    passed: usize,
    open: Open,
    /// Number of operations with several results that were not decided.
    undecided: usize,
}

/// The chosen result, and the last possible one.
#[derive(Clone, Copy, Debug)]
struct Decision {
    taken: f64,
    last: f64,
}

/// The jumps that an evaluation left open.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Open {
    #[default]
    Nothing,
    /// The possible results of the first operation that has several.
    Whole(Interval),
    /// An operation jumps, and its results cannot be separated.
    Cut,
}

impl BranchPath {
    /// Operations with more results than this are not decided.
    pub const MOST_RESULTS: f64 = 4.0;

    /// Removes all decisions.
    pub fn clear(&mut self) {
        self.decisions.clear();
    }

    /// True if nothing is decided.
    pub fn is_empty(&self) -> bool {
        self.decisions.is_empty()
    }

    /// True if the last evaluation passed a jump that was not decided.
    pub fn is_open(&self) -> bool {
        self.open != Open::Nothing
    }

    /// Decides the first jump that the last evaluation left open, with the least result. Returns
    /// false if it cannot be decided, or if the path has more than `most` jumps.
    pub fn fork(&mut self, most: usize) -> bool {
        let Open::Whole(results) = self.open else { return false };
        let few = results.hi - results.lo < Self::MOST_RESULTS;
        if few && self.decisions.len() + self.undecided <= most {
            self.decisions.push(Decision { taken: results.lo, last: results.hi });
            return true;
        }
        false
    }

    /// Advances the last decision that has a further result. Returns false if all paths have been
    /// taken.
    pub fn advance(&mut self) -> bool {
        while let Some(decision) = self.decisions.last_mut() {
            if decision.taken < decision.last {
                decision.taken += 1.0;
                return true;
            }
            self.decisions.pop();
        }
        false
    }

    /// Prepares for an evaluation.
    pub(in crate::eval) fn begin(&mut self) {
        self.passed = 0;
        self.undecided = 0;
        self.open = Open::Nothing;
    }
}

impl Tracer<Interval> for &mut BranchPath {
    fn jumped(&mut self, op: Op, [a, b, _]: [Interval; 3], result: Interval) -> Interval {
        if op == Op::Atan2 && a.contains(0.0) && b.hi < 0.0 {
            return self.on_one_side(a, b, result);
        }
        // The comparison of a selection is decided, or counts as a jump itself.
        if op == Op::Select {
            return result;
        }
        if !op.is_whole() {
            // At the zero vector, which has no direction.
            let cut = b.lo <= 0.0 && (op != Op::Atan2 || a.contains(0.0));
            if cut && self.open == Open::Nothing {
                self.open = Open::Cut;
            }
            return result;
        }
        if result.lo == result.hi {
            return result;
        }
        match self.decision(result) {
            Some(taken) => Interval { lo: taken, hi: taken },
            None => result,
        }
    }
}

impl BranchPath {
    /// The angle of a vector on one side of the branch cut.
    fn on_one_side(&mut self, y: Interval, x: Interval, result: Interval) -> Interval {
        self.one_of(Interval::angles_at_cut(y, x)).unwrap_or(result)
    }

    /// The chosen one of two results; `None` if it is not decided.
    pub(in crate::eval) fn one_of(&mut self, [first, second]: [Interval; 2]) -> Option<Interval> {
        let taken = self.decision(Interval { lo: 0.0, hi: 1.0 })?;
        Some(if taken == 0.0 { first } else { second })
    }

    /// The chosen one of several results; `None` if it is not decided.
    fn decision(&mut self, results: Interval) -> Option<f64> {
        if let Some(decision) = self.decisions.get(self.passed) {
            self.passed += 1;
            return Some(decision.taken);
        }
        self.undecided += 1;
        if !matches!(self.open, Open::Whole(_)) {
            self.open = Open::Whole(results);
        }
        None
    }
}
