//! How fast a formula can change within a box, by interval derivatives.
//!
//! For formulas that the rules of [`crate::certify::lipschitz`] do not cover, such as products of coordinates. The gradient is evaluated over
//! intervals; the box is cut where it may be longest, until what is left to gain is little. Params take
//! part with their ranges, so the constant holds for every position of their sliders.

use std::collections::BinaryHeap;

use sdfc_graph::eval::{BranchPath, Evaluator, FrameValues, Interval, Tape};
use sdfc_graph::{Expander, Graph, NodeId, Param, ShapeId, gradient};

/// Scalar operations that one shape's search may take.
const OPERATIONS: usize = 1_000_000;
/// But no more boxes than this, and no fewer than the other.
const MOST_BOXES: usize = 2048;
const FEWEST_BOXES: usize = 64;
/// A constant is good enough if it exceeds a slope that occurs by no more than this part.
const LOOSE: f64 = 0.02;

/// Steps that are shorter than the usual slope asks for by more than this cost more than the proof of stretches that takes their
/// place where there is no constant.
const UNEVEN: f64 = 16.0;
/// Places to an axis where the slope is looked at.
const PLACES: usize = 5;

/// A box, per axis from low to high.
type Region = [[f64; 2]; 3];

/// How fast a formula changes within a box.
pub(crate) struct Slope {
    /// A constant that holds all over the box.
    pub(crate) most: f64,
    /// The median over the box.
    usual: f64,
}

impl Slope {
    /// Whether a field divided by the greatest slope is still worth stepping by.
    pub(crate) fn is_even(&self) -> bool {
        self.most <= UNEVEN * self.usual
    }
}

/// How fast a shape's formula changes within its bounds, for all values of the params; `None` where the bounds or the slope
/// have no end, or the formula jumps.
pub(crate) fn steepest_within(
    graph: &mut Graph,
    shape: ShapeId,
    bounds: [NodeId; 2],
    params: &[Param],
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
    let boxes = (OPERATIONS / cost).clamp(FEWEST_BOXES, MOST_BOXES);
    let [field, slope] = &tapes;
    let mut search = Search {
        field: field.prepare_in(&ranges),
        slope: slope.prepare_in(&ranges),
        path: BranchPath::default(),
        axes: dim.point_type().width(),
    };
    let most = search.run(region, boxes)?;
    Some(Slope { most, usual: search.usual(region) })
}

/// The box in which the bounds lie whatever the params are; `None` if it is empty or has no end.
fn region(graph: &Graph, bounds: [NodeId; 2], ranges: &FrameValues<Interval>) -> Option<Region> {
    let tape = Tape::new(graph, &bounds).ok()?;
    let mut corners = tape.prepare_in(ranges);
    let [lo, hi] = corners.eval([Interval::ENTIRE; 3]) else { return None };
    let axis = |i: usize| [lo[i].lo(), hi[i].hi()];
    let region = [axis(0), axis(1), axis(2)];
    let sound = |[lo, hi]: &[f64; 2]| lo.is_finite() && hi.is_finite() && lo <= hi;
    region.iter().all(sound).then_some(region)
}

/// A box and the longest that the gradient may be in it.
struct Part {
    limit: f64,
    region: Region,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.limit.total_cmp(&other.limit)
    }
}

struct Search<'t> {
    field: Evaluator<'t, Interval>,
    slope: Evaluator<'t, Interval>,
    path: BranchPath,
    axes: usize,
}

impl Search<'_> {
    fn run(&mut self, region: Region, boxes: usize) -> Option<f64> {
        // The longest gradient that certainly occurs somewhere.
        let mut reached: f64 = 0.0;
        let mut parts = BinaryHeap::from([self.part(region, &mut reached)]);
        for _ in 0..boxes {
            let worst = parts.pop()?;
            if worst.limit <= reached * (1.0 + LOOSE) {
                parts.push(worst);
                break;
            }
            for half in self.halves(&worst.region) {
                let part = self.part(half, &mut reached);
                parts.push(part);
            }
        }
        let limit = parts.pop()?.limit;
        limit.is_finite().then_some(limit)
    }

    /// The median of the slopes at places evenly spread over a region.
    fn usual(&mut self, region: Region) -> f64 {
        let at = |axis: usize, i: usize| {
            let [lo, hi] = region[axis];
            let place = lo + (hi - lo) * (i as f64 + 0.5) / PLACES as f64;
            Interval::new(place, place)
        };
        let mut slopes = Vec::with_capacity(PLACES.pow(3));
        for i in 0..PLACES.pow(3) {
            let place = [at(0, i % PLACES), at(1, i / PLACES % PLACES), at(2, i / PLACES.pow(2))];
            slopes.push(self.lengths(place).1);
        }
        slopes.sort_by(f64::total_cmp);
        slopes[slopes.len() / 2]
    }

    /// Without a limit where the field may jump.
    fn part(&mut self, region: Region, reached: &mut f64) -> Part {
        let at = region.map(|[lo, hi]| Interval::new(lo, hi));
        self.path.clear();
        self.field.scalar_along(at, &mut self.path);
        if self.path.is_open() {
            return Part { limit: f64::INFINITY, region };
        }
        let (shortest, limit) = self.lengths(at);
        *reached = reached.max(shortest);
        Part { limit, region }
    }

    /// The least and the greatest length of the gradient on a box.
    fn lengths(&mut self, at: [Interval; 3]) -> (f64, f64) {
        let lanes = self.slope.eval(at).first().copied().unwrap_or([Interval::ENTIRE; 4]);
        let lanes = &lanes[..self.axes];
        let length = |end: fn(&Interval) -> f64| lanes.iter().map(end).map(|x| x * x).sum::<f64>();
        let least =
            |x: &Interval| if x.contains(0.0) { 0.0 } else { x.lo().abs().min(x.hi().abs()) };
        let most = |x: &Interval| x.lo().abs().max(x.hi().abs());
        // Above the rounding of the sum and its root.
        (length(least).sqrt(), length(most).sqrt() * (1.0 + 1e-12))
    }

    /// Cut across the longest side.
    fn halves(&self, region: &Region) -> [Region; 2] {
        let side = |axis: &usize| region[*axis][1] - region[*axis][0];
        let longest = (0..self.axes).max_by(|a, b| side(a).total_cmp(&side(b))).unwrap_or(0);
        let [lo, hi] = region[longest];
        let middle = lo + 0.5 * (hi - lo);
        let (mut first, mut second) = (*region, *region);
        first[longest] = [lo, middle];
        second[longest] = [middle, hi];
        [first, second]
    }
}
