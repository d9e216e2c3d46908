//! Lipschitz constants within a box, by interval derivatives.
//!
//! They cover formulas that the rules of [`crate::certify::lipschitz`] do not, such as products of
//! coordinates. The gradient is evaluated over intervals. The box with the largest upper bound gets
//! another one from its operations ([`crate::certify::box_norms`]), and is split if it still has
//! the largest, until another split gains little. Params have the intervals of their ranges, so the
//! constant holds for all of their values.

use std::collections::BinaryHeap;

use sdfc_graph::eval::{BranchPath, Dual, Evaluator, FrameValues, Interval, Tape};
use sdfc_graph::{Expander, Graph, NodeId, Param, ShapeId, gradient};

use crate::certify::box_norms::BoxNorms;

/// Budget of one shape's search, in scalar operations.
const OPERATIONS: usize = 1_000_000;
/// Budget of all searches of a scene, in scalar operations: some seconds. Shapes beyond it have no
/// constant.
pub(crate) const SCENE_OPERATIONS: usize = 1 << 28;
/// Limits of the number of boxes, whatever the budget of the shape.
const MAX_BOXES: usize = 2048;
const MIN_BOXES: usize = 64;
/// The search ends if the constant exceeds a slope that occurs by no more than this fraction.
const TOLERANCE: f64 = 0.02;

/// Largest ratio of the largest to the median slope. Above it, the short steps cost more than
/// interval tracing, which is used if there is no constant.
const MAX_RATIO: f64 = 16.0;
/// Sample points for the median slope along each axis.
const SAMPLES: usize = 5;

/// The lowest and highest coordinate of a box on each axis.
pub(crate) type Region = [[f64; 2]; 3];

/// The slopes of a formula within a box.
pub(crate) struct Slope {
    /// An upper bound: a Lipschitz constant for the box.
    pub(crate) largest: f64,
    /// The median over the box.
    median: f64,
}

impl Slope {
    /// True if stepping by the field divided by the largest slope is worth it.
    pub(crate) fn is_uniform(&self) -> bool {
        self.largest <= MAX_RATIO * self.median
    }
}

/// The slopes of a shape's formula within its bounds, for all values of the params. Returns `None`
/// if the bounds or the slope are infinite, the formula jumps, or the search may need more
/// operations than `budget`. What it uses is taken from that.
pub(crate) fn steepest_within(
    graph: &mut Graph,
    shape: ShapeId,
    bounds: [NodeId; 2],
    params: &[Param],
    budget: &mut usize,
) -> Option<Slope> {
    if graph.shape(shape).level > 0 {
        return None;
    }
    let ranges = FrameValues::ranges(params);
    let region = region(graph, bounds, &ranges)?;
    let dim = graph.shape(shape).dim;
    let point = graph.point(0, dim);
    let field = Expander::new().field(graph, shape, point).ok()?;
    let slope = gradient(graph, field, point);
    let tapes = [Tape::new(graph, &[field]).ok()?, Tape::new(graph, &[slope]).ok()?];
    let cost = tapes.iter().map(Tape::operations).fold(1, usize::saturating_add);
    let boxes = (OPERATIONS / cost).clamp(MIN_BOXES, MAX_BOXES);
    let most = 1 + 2 * boxes + SAMPLES.pow(3);
    if cost.saturating_mul(most) > *budget {
        return None;
    }
    let norms = BoxNorms::new(graph, field);
    let norm_cost = norms.as_ref().map_or(1, BoxNorms::cost);
    let [field, slope] = &tapes;
    let mut search = Search {
        field: field.prepare_in(&ranges),
        slope: slope.prepare_in(&ranges),
        norms: norms.as_ref().map(|norms| (norms, norms.prepare(&ranges))),
        refinements: OPERATIONS.min(*budget - cost * most) / norm_cost,
        path: BranchPath::default(),
        axes: dim.point_type().width(),
        evaluations: 0,
        refined: 0,
    };
    let largest = search.run(region, boxes);
    let slope = largest.map(|largest| Slope { largest, median: search.median(region) });
    *budget -= cost * search.evaluations.min(most);
    *budget = budget.saturating_sub(norm_cost * search.refined);
    slope
}

/// The smallest box that holds the bounds for all values of the params; `None` if it is empty or
/// infinite.
pub(crate) fn region(
    graph: &Graph,
    bounds: [NodeId; 2],
    ranges: &FrameValues<Interval>,
) -> Option<Region> {
    let tape = Tape::new(graph, &bounds).ok()?;
    let mut corners = tape.prepare_in(ranges);
    let [lo, hi] = corners.eval([Interval::ENTIRE; 3]) else { return None };
    let axis = |i: usize| [lo[i].lo(), hi[i].hi()];
    let region = [axis(0), axis(1), axis(2)];
    let is_valid = |[lo, hi]: &[f64; 2]| lo.is_finite() && hi.is_finite() && lo <= hi;
    region.iter().all(is_valid).then_some(region)
}

/// A box and an upper bound of the gradient's length in it.
struct Cell {
    limit: f64,
    region: Region,
    /// True if the operations of the field give no lower bound, or have been asked for it.
    is_refined: bool,
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Cell {}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Cell {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.limit.total_cmp(&other.limit)
    }
}

struct Search<'t> {
    field: Evaluator<'t, Interval>,
    slope: Evaluator<'t, Interval>,
    norms: Option<(&'t BoxNorms, Evaluator<'t, Dual<Interval>>)>,
    /// The number of boxes that may still be bounded by `norms`, and of those that were.
    refinements: usize,
    refined: usize,
    path: BranchPath,
    axes: usize,
    /// The number of boxes and points that were evaluated.
    evaluations: usize,
}

impl Search<'_> {
    fn run(&mut self, region: Region, boxes: usize) -> Option<f64> {
        // The largest gradient length that certainly occurs.
        let mut reached: f64 = 0.0;
        let mut cells = BinaryHeap::from([self.cell(region, &mut reached)]);
        let mut splits = 0;
        while splits < boxes {
            let worst = cells.pop()?;
            if worst.limit <= reached * (1.0 + TOLERANCE) {
                cells.push(worst);
                break;
            }
            if !worst.is_refined && self.refinements > 0 {
                cells.push(self.refined(worst));
                continue;
            }
            splits += 1;
            for half in self.halves(&worst.region) {
                let cell = self.cell(half, &mut reached);
                // What holds in a box holds in its halves.
                cells.push(Cell { limit: cell.limit.min(worst.limit), ..cell });
            }
        }
        while self.refinements > 0 && cells.peek().is_some_and(|worst| !worst.is_refined) {
            let worst = cells.pop()?;
            cells.push(self.refined(worst));
        }
        let limit = cells.pop()?.limit;
        limit.is_finite().then_some(limit)
    }

    /// The box with the bound that the operations of the field give, if it is lower.
    fn refined(&mut self, cell: Cell) -> Cell {
        self.refinements -= 1;
        self.refined += 1;
        let at = cell.region.map(|[lo, hi]| Interval::new(lo, hi));
        let Some((norms, evaluator)) = &mut self.norms else {
            return Cell { is_refined: true, ..cell };
        };
        let limit = cell.limit.min(norms.slope(evaluator, at));
        Cell { limit, is_refined: true, ..cell }
    }

    /// The median of the slopes at evenly spaced points of a region.
    fn median(&mut self, region: Region) -> f64 {
        let at = |axis: usize, i: usize| {
            let [lo, hi] = region[axis];
            let coordinate = lo + (hi - lo) * (i as f64 + 0.5) / SAMPLES as f64;
            Interval::new(coordinate, coordinate)
        };
        let mut slopes = Vec::with_capacity(SAMPLES.pow(3));
        self.evaluations += SAMPLES.pow(3);
        for i in 0..SAMPLES.pow(3) {
            let point =
                [at(0, i % SAMPLES), at(1, i / SAMPLES % SAMPLES), at(2, i / SAMPLES.pow(2))];
            slopes.push(self.lengths(point).1);
        }
        slopes.sort_by(f64::total_cmp);
        slopes[slopes.len() / 2]
    }

    /// Evaluates the gradient on a box. The upper bound is infinite if the field may jump there.
    fn cell(&mut self, region: Region, reached: &mut f64) -> Cell {
        let at = region.map(|[lo, hi]| Interval::new(lo, hi));
        self.evaluations += 1;
        self.path.clear();
        self.field.scalar_along(at, &mut self.path);
        if self.path.is_open() {
            return Cell { limit: f64::INFINITY, region, is_refined: true };
        }
        let (shortest, limit) = self.lengths(at);
        *reached = reached.max(shortest);
        Cell { limit, region, is_refined: self.norms.is_none() }
    }

    /// Lower and upper bound of the gradient's length on a box.
    fn lengths(&mut self, at: [Interval; 3]) -> (f64, f64) {
        let lanes = self.slope.eval(at).first().copied().unwrap_or([Interval::ENTIRE; 4]);
        let lanes = &lanes[..self.axes];
        let length = |end: fn(&Interval) -> f64| lanes.iter().map(end).map(|x| x * x).sum::<f64>();
        let least =
            |x: &Interval| if x.contains(0.0) { 0.0 } else { x.lo().abs().min(x.hi().abs()) };
        let most = |x: &Interval| x.lo().abs().max(x.hi().abs());
        // The factor covers the rounding of the sum and of its root.
        (length(least).sqrt(), length(most).sqrt() * (1.0 + 1e-12))
    }

    /// Splits a box across its longest side.
    fn halves(&self, region: &Region) -> [Region; 2] {
        let side = |axis: &usize| region[*axis][1] - region[*axis][0];
        let widest = (0..self.axes).max_by(|a, b| side(a).total_cmp(&side(b))).unwrap_or(0);
        let [lo, hi] = region[widest];
        let middle = lo + 0.5 * (hi - lo);
        let (mut first, mut second) = (*region, *region);
        first[widest] = [lo, middle];
        second[widest] = [middle, hi];
        [first, second]
    }
}
