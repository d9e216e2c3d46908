//! A way through the jumps of a field over a box.

use super::Interval;
use crate::eval::op::Op;
use crate::eval::tracer::Tracer;

/// Which results an evaluation over intervals takes at operations that jump within the box.
///
/// Over a box that holds parts of two cells of a repetition, an interval of the cell's number is of little use, and one of
/// its hash of none. So the first operation with more than one whole result can be decided: for each of these results the
/// field is evaluated again, with that one in the place of all. An angle across its cut is decided as two results, one of each side. At each point of the box some path through the
/// results gives the field, so what holds for all paths holds in the box; and on a path that leaves nothing open the formula is
/// one without jumps, whose range shrinks with the box.
///
/// ```
/// use sdfc_graph::eval::{FrameValues, Interval, BranchPath, Tape};
/// use sdfc_graph::{Dim, Graph, Unary};
///
/// // x - round(x) + 1 lies between 0.5 and 1.5, which one interval cannot see about a jump.
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
    decided: Vec<Decision>,
    /// How many decisions the evaluation under way has come by.
    passed: usize,
    open: Open,
    /// How many operations had more than one result and were not decided.
    undecided: usize,
}

/// The result taken of those that are possible.
#[derive(Clone, Copy, Debug)]
struct Decision {
    taken: f64,
    last: f64,
}

/// What an evaluation left open.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Open {
    #[default]
    Nothing,
    /// The results of the first operation that has more than one.
    Whole(Interval),
    /// An operation jumps whose results cannot be told apart.
    Cut,
}

impl BranchPath {
    /// An operation with more results is not decided.
    pub const MOST_RESULTS: f64 = 4.0;

    /// Back to where nothing is decided.
    pub fn clear(&mut self) {
        self.decided.clear();
    }

    /// Whether nothing is decided.
    pub fn is_empty(&self) -> bool {
        self.decided.is_empty()
    }

    /// Whether the last evaluation met a jump that was not decided.
    pub fn is_open(&self) -> bool {
        self.open != Open::Nothing
    }

    /// Decides the first jump that the last evaluation left open, with the least result. `false` if it cannot be decided, or if
    /// the path has more jumps than `most`.
    pub fn fork(&mut self, most: usize) -> bool {
        let Open::Whole(results) = self.open else { return false };
        let few = results.hi - results.lo < Self::MOST_RESULTS;
        if few && self.decided.len() + self.undecided <= most {
            self.decided.push(Decision { taken: results.lo, last: results.hi });
            return true;
        }
        false
    }

    /// On to the next result of the last decision that has one. `false` if all paths have been taken.
    pub fn advance(&mut self) -> bool {
        while let Some(decision) = self.decided.last_mut() {
            if decision.taken < decision.last {
                decision.taken += 1.0;
                return true;
            }
            self.decided.pop();
        }
        false
    }

    /// Before an evaluation.
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
        if !op.is_whole() {
            // At the vector that has no direction.
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
    /// The angle of a vector on one side of the cut, which is a choice of two.
    fn on_one_side(&mut self, y: Interval, x: Interval, result: Interval) -> Interval {
        let [below, above] = Interval::angles_at_cut(y, x);
        let taken = self.decision(Interval { lo: 0.0, hi: 1.0 });
        taken.map_or(result, |taken| if taken == 0.0 { below } else { above })
    }

    /// The result that is taken of several; `None` where that is not decided.
    fn decision(&mut self, results: Interval) -> Option<f64> {
        if let Some(decision) = self.decided.get(self.passed) {
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
