//! Interval exclusion: the search for a box outside which intervals show a formula to clear a
//! limit.

use crate::eval::{Evaluator, FrameValues, Interval, Tape};
use crate::graph::Graph;
use crate::node::{Dim, NodeId};

/// Scalar operations that a search may spend, and its minimum and maximum number of evaluations.
const OPERATIONS: usize = 400_000;
const LEAST_EVALUATIONS: usize = 512;
const MOST_EVALUATIONS: usize = 8_000;

/// Evaluations that may be spent on one slab, per pass.
const PER_SLAB: [usize; 3] = [16, 48, 160];

/// An unbounded side is closed at a power of two in this range, if at all.
const NEAREST: i32 = -6;
const FARTHEST: i32 = 40;

/// Faces are moved in steps larger than this fraction of the box, as often as possible, and finally
/// by each of these fractions.
const RESOLUTION: f64 = 1.0 / 256.0;
const FINER: [f64; 2] = [1.0 / 256.0, 1.0 / 512.0];

/// The search ends after a pass that moves every side by less than this fraction: the next one
/// would not find more that rays notice.
const MIN_PROGRESS: f64 = 1.0 / 128.0;

/// A box in numbers, lower and upper end by axis; empty if `lo > hi`.
pub(super) type Region = [[f64; 2]; 3];

/// A flat formula, and the limit that it is shown to clear.
pub(super) struct Search {
    tape: Tape,
    frame: FrameValues<Interval>,
    limit: Interval,
    above: bool,
    width: usize,
}

impl Search {
    /// A search; `None` if the formula is not flat.
    pub(super) fn new(
        graph: &Graph,
        node: NodeId,
        limit: Interval,
        above: bool,
        dim: Dim,
        frame: &FrameValues<Interval>,
    ) -> Option<Self> {
        let tape = Tape::new(graph, &[node]).ok()?;
        Some(Self { tape, frame: frame.clone(), limit, above, width: dim.point_type().width() })
    }

    /// A box within the given one that contains all of the level set in it; `lo > hi` if it is
    /// empty.
    pub(super) fn run(&self, start: Region) -> Region {
        if start.iter().any(|[lo, hi]| lo > hi) {
            return [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        }
        let budget =
            (OPERATIONS / self.tape.operations().max(1)).clamp(LEAST_EVALUATIONS, MOST_EVALUATIONS);
        let evaluator = self.tape.prepare_in(&self.frame);
        let mut work = Work { search: self, evaluator, budget, per_slab: 0, region: start };
        // A side may close, and move further, once others have closed.
        for _ in PER_SLAB {
            for axis in 0..self.width {
                work.close(axis, Side::Upper);
                work.close(axis, Side::Lower);
            }
        }
        for (pass, per_slab) in PER_SLAB.into_iter().enumerate() {
            let before = work.region;
            work.per_slab = per_slab;
            work.shave_all(self.width);
            // The first pass has few evaluations per slab, so its failure says little.
            if pass > 0 && !has_shrunk(before, work.region) {
                break;
            }
        }
        work.per_slab = PER_SLAB[0];
        for axis in 0..self.width {
            work.polish(axis, Side::Upper);
            work.polish(axis, Side::Lower);
        }
        work.region
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Side {
    Lower,
    Upper,
}

/// A search in progress.
struct Work<'s> {
    search: &'s Search,
    evaluator: Evaluator<'s, Interval>,
    /// Evaluations left.
    budget: usize,
    /// Evaluations that may be spent on one slab.
    per_slab: usize,
    region: Region,
}

impl Work<'_> {
    /// Bounds an unbounded side by a power of two beyond which the rest of the box is empty.
    fn close(&mut self, axis: usize, side: Side) {
        let [lo, hi] = self.region[axis];
        let open = match side {
            Side::Lower => lo == f64::NEG_INFINITY,
            Side::Upper => hi == f64::INFINITY,
        };
        if !open {
            return;
        }
        for power in (NEAREST..=FARTHEST).step_by(2) {
            if self.budget == 0 {
                return;
            }
            let position = 2_f64.powi(power);
            let (slab, face) = match side {
                Side::Lower => ([lo, (-position).min(hi)], [-position, hi.max(-position)]),
                Side::Upper => ([position.max(lo), hi], [lo.min(position), position]),
            };
            if self.is_clear(self.with(axis, slab)) {
                self.region[axis] = face;
                return;
            }
        }
    }

    /// Moves all faces inwards. Each may take an equal share of the evaluations that are left, so
    /// that none of them takes all.
    fn shave_all(&mut self, width: usize) {
        let faces = (0..width).flat_map(|axis| [(axis, Side::Upper), (axis, Side::Lower)]);
        for (done, (axis, side)) in faces.enumerate() {
            let share = self.budget / (2 * width - done);
            let others = std::mem::replace(&mut self.budget, share) - share;
            self.shave(axis, side);
            self.budget += others;
        }
    }

    /// Moves a face inwards over slabs that are empty.
    fn shave(&mut self, axis: usize, side: Side) {
        let mut step = self.size(axis, side) / 2.0;
        while self.budget > 0 && step > self.size(axis, side) * RESOLUTION {
            if !self.cuts_off(axis, side, step) {
                step /= 2.0;
            }
        }
    }

    /// Moves a face inwards by the remaining fractions of a step.
    fn polish(&mut self, axis: usize, side: Side) {
        for fraction in FINER {
            let step = self.size(axis, side) * fraction;
            if self.budget > 0 && step.is_finite() {
                self.cuts_off(axis, side, step);
            }
        }
    }

    /// The length of the box along an axis. If the box is unbounded on the other side, the face's
    /// distance from 0. Infinite if the face is, which is then not moved.
    fn size(&self, axis: usize, side: Side) -> f64 {
        let [lo, hi] = self.region[axis];
        let face = match side {
            Side::Lower => lo,
            Side::Upper => hi,
        };
        if face.is_finite() && (hi - lo).is_finite() { hi - lo } else { face.abs().max(1.0) }
    }

    /// Removes a slab of this thickness from the box if it is empty. Returns true if it is.
    fn cuts_off(&mut self, axis: usize, side: Side, step: f64) -> bool {
        let [lo, hi] = self.region[axis];
        let (slab, rest) = match side {
            Side::Lower => ([lo, hi.min(lo + step)], [lo + step, hi]),
            Side::Upper => ([lo.max(hi - step), hi], [lo, hi - step]),
        };
        let is_empty = self.is_empty(self.with(axis, slab));
        if is_empty && rest[0] < rest[1] {
            self.region[axis] = rest;
        } else if is_empty {
            self.region = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        }
        is_empty
    }

    fn with(&self, axis: usize, side: [f64; 2]) -> Region {
        let mut region = self.region;
        region[axis] = side;
        region
    }

    /// True if one evaluation shows that the formula clears the limit in all of the region.
    fn is_clear(&mut self, region: Region) -> bool {
        self.budget = self.budget.saturating_sub(1);
        let value = self.evaluator.scalar(region.map(|[lo, hi]| Interval::new(lo, hi)));
        if self.search.above {
            value.hi() < self.search.limit.lo()
        } else {
            value.lo() > self.search.limit.hi()
        }
    }

    /// True if the formula clears the limit in all of the region, which is split along its longest
    /// bounded side as needed.
    fn is_empty(&mut self, region: Region) -> bool {
        let mut parts = vec![region];
        let mut left = self.per_slab;
        while let Some(part) = parts.pop() {
            if left == 0 || self.budget == 0 {
                return false;
            }
            left -= 1;
            if !self.is_clear(part) {
                if !self.is_clear(part.map(middle)) {
                    return false; // most likely inside the shape
                }
                let Some(halves) = self.halves(part) else { return false };
                parts.extend(halves);
            }
        }
        true
    }

    fn halves(&self, region: Region) -> Option<[Region; 2]> {
        let width = |&axis: &usize| region[axis][1] - region[axis][0];
        let bounded = (0..self.search.width).filter(|axis| width(axis).is_finite());
        let axis = bounded.max_by(|a, b| width(a).total_cmp(&width(b)))?;
        let [lo, hi] = region[axis];
        let [middle, _] = middle([lo, hi]);
        if middle <= lo || middle >= hi {
            return None;
        }
        let (mut first, mut second) = (region, region);
        (first[axis], second[axis]) = ([lo, middle], [middle, hi]);
        Some([first, second])
    }
}

/// True if a side has shrunk enough for another pass.
fn has_shrunk(before: Region, after: Region) -> bool {
    let width = |[lo, hi]: [f64; 2]| hi - lo;
    let mut sides = before.into_iter().zip(after);
    sides.any(|(before, after)| width(after) < width(before) * (1.0 - MIN_PROGRESS))
}

/// The middle of a side; for an unbounded one, some number in it.
fn middle([lo, hi]: [f64; 2]) -> [f64; 2] {
    let position = if lo.is_finite() && hi.is_finite() { f64::midpoint(lo, hi) } else { 0.0 };
    // `clamp` would panic where `lo` is above `hi`.
    [position.max(lo).min(hi); 2]
}
