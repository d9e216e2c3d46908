//! Interval exclusion: a box around what cannot be shown to be empty.

use crate::eval::{Evaluator, FrameValues, Interval, Tape};
use crate::{Dim, Graph, NodeId};

/// Scalar operations that a search may spend, and evaluations that it may in any case and at most.
const OPERATIONS: usize = 400_000;
const LEAST_EVALUATIONS: usize = 32;
const MOST_EVALUATIONS: usize = 8_000;

/// Evaluations that one slab may take to be shown empty, round by round.
const PER_SLAB: [usize; 3] = [16, 48, 160];

/// An open side is closed at a power of two in this range, if at all.
const NEAREST: i32 = -6;
const FARTHEST: i32 = 40;

/// Faces are moved in steps of more than this fraction of the box, as often as it goes, and at last by each of these.
const RESOLUTION: f64 = 1.0 / 256.0;
const FINER: [f64; 2] = [1.0 / 256.0, 1.0 / 512.0];

/// A round that takes away less of every side than this part is the last: rays would not tell what the next finds.
const WORTH_ANOTHER: f64 = 1.0 / 128.0;

/// A box in numbers, lower and upper end by axis; `lo > hi`: nowhere.
pub(super) type Region = [[f64; 2]; 3];

/// A flat formula, about to be shown to keep from a limit here and there.
pub(super) struct Search {
    tape: Tape,
    frame: FrameValues<Interval>,
    limit: Interval,
    above: bool,
    width: usize,
}

impl Search {
    /// `None` if the formula is not flat.
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

    /// A box within the given one that holds all that it holds of the zone; `lo > hi` if nothing.
    pub(super) fn run(&self, start: Region) -> Region {
        if start.iter().any(|[lo, hi]| lo > hi) {
            return [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        }
        let budget =
            (OPERATIONS / self.tape.operations().max(1)).clamp(LEAST_EVALUATIONS, MOST_EVALUATIONS);
        let evaluator = self.tape.prepare_in(&self.frame);
        let mut work = Work { search: self, evaluator, budget, per_slab: 0, region: start };
        // A side may close, and give way further, once others have.
        for _ in PER_SLAB {
            for axis in 0..self.width {
                work.close(axis, Side::Upper);
                work.close(axis, Side::Lower);
            }
        }
        for (round, per_slab) in PER_SLAB.into_iter().enumerate() {
            let before = work.region;
            work.per_slab = per_slab;
            for axis in 0..self.width {
                work.shave(axis, Side::Upper);
                work.shave(axis, Side::Lower);
            }
            // The first has few evaluations for each slab: that it moves nothing says little.
            if round > 0 && !has_shrunk(before, work.region) {
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

/// A search under way.
struct Work<'s> {
    search: &'s Search,
    evaluator: Evaluator<'s, Interval>,
    /// Evaluations left.
    budget: usize,
    /// Evaluations that one slab may take.
    per_slab: usize,
    region: Region,
}

impl Work<'_> {
    /// Bounds an open side by a power of two beyond which, as far as the other sides reach, there is nothing.
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
            let place = 2_f64.powi(power);
            let (slab, face) = match side {
                Side::Lower => ([lo, (-place).min(hi)], [-place, hi.max(-place)]),
                Side::Upper => ([place.max(lo), hi], [lo.min(place), place]),
            };
            if self.is_clear(self.with(axis, slab)) {
                self.region[axis] = face;
                return;
            }
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

    /// Moves a face inwards by what is left of a step.
    fn polish(&mut self, axis: usize, side: Side) {
        for part in FINER {
            let step = self.size(axis, side) * part;
            if self.budget > 0 && step.is_finite() {
                self.cuts_off(axis, side, step);
            }
        }
    }

    /// How long the box is along an axis; of one that is open on the other side, how far its face is away. Infinite where the face
    /// is, which is not to be moved.
    fn size(&self, axis: usize, side: Side) -> f64 {
        let [lo, hi] = self.region[axis];
        let face = match side {
            Side::Lower => lo,
            Side::Upper => hi,
        };
        if face.is_finite() && (hi - lo).is_finite() { hi - lo } else { face.abs().max(1.0) }
    }

    /// Whether a slab so thick was empty; then the box has lost it.
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

    /// Whether the formula keeps from the limit all over the region, by one evaluation.
    fn is_clear(&mut self, region: Region) -> bool {
        self.budget = self.budget.saturating_sub(1);
        let value = self.evaluator.scalar(region.map(|[lo, hi]| Interval::new(lo, hi)));
        if self.search.above {
            value.hi() < self.search.limit.lo()
        } else {
            value.lo() > self.search.limit.hi()
        }
    }

    /// Whether it does so on parts that the region is cut into, across its longest bounded side.
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
                    return false; // inside, most likely
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

/// Whether a side has lost a part that is worth another round.
fn has_shrunk(before: Region, after: Region) -> bool {
    let width = |[lo, hi]: [f64; 2]| hi - lo;
    let mut sides = before.into_iter().zip(after);
    sides.any(|(before, after)| width(after) < width(before) * (1.0 - WORTH_ANOTHER))
}

/// The middle of a side; of an open one some place in it.
fn middle([lo, hi]: [f64; 2]) -> [f64; 2] {
    let place = if lo.is_finite() && hi.is_finite() { f64::midpoint(lo, hi) } else { 0.0 };
    // Not `clamp`, which panics where `lo` is above `hi`.
    [place.max(lo).min(hi); 2]
}
