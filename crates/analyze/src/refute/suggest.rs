//! Clauses that would give a shape without a Lipschitz constant one.

use sdfc_graph::eval::{Dual, Evaluator, FrameValues, Tape};
use sdfc_graph::{Dim, Expander, Graph, NodeId, Param, ShapeId};

use crate::certify::local_slope::{Region, region, steepest_within};
use crate::refute::frames::frames;
use crate::refute::probe::Probe;
use crate::refute::sampling::Effort;

/// Least half of the edge of the box that is suggested as bounds, and the greatest one.
const REACHES: [f64; 2] = [2.0, 1024.0];
/// Suggested bounds divided by the extent of the samples, if it is above the least one.
const EXTENT_MARGIN: f64 = 1.3;
/// Budget of the search with suggested bounds, in scalar operations.
const OPERATIONS: usize = 1 << 22;
/// Points along each axis at which slopes are sampled.
const SAMPLES: usize = 12;
/// The number of points, the steepest ones, from which steeper ones are sought.
const STARTS: usize = 16;
/// The number of halvings of the distance at which a steeper point is sought.
const HALVINGS: usize = 24;
/// A suggested constant divided by the largest slope that was found.
const MARGIN: f64 = 1.2;
/// A field has no constant if its slope grows by more than this factor near a sample.
const MOST_GROWTH: f64 = 16.0;
/// Number of times that pairs of points may refute a suggestion.
const TRIES: usize = 4;
/// Budget of the pairs of points at one frame, in scalar operations.
const PAIR_OPERATIONS: u64 = 1 << 23;

/// Clauses to add to a declaration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SuggestedClauses {
    /// Half the edge of a cube around the origin, for the clause `bounds`; `None` if there are
    /// bounds, or a shape that seems to have no end seems to have a constant everywhere.
    pub bounds: Option<f64>,
    /// The constant for the clause `lipschitz`, from samples.
    pub lipschitz: Option<SampledSlope>,
}

/// What samples say of the slope of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SampledSlope {
    /// A constant above all that were found.
    Constant(f64),
    /// There is none: the slope grows without limit near this point.
    Unlimited([f64; 3]),
}

/// Clauses with which an uncertified shape would be certified, if its children are: bounds if
/// interval derivatives give a constant within them, else a constant from samples.
pub fn suggested_clauses(
    graph: &Graph,
    shape: ShapeId,
    params: &[Param],
) -> Option<SuggestedClauses> {
    let mut graph = graph.clone();
    let dim = graph.shape(shape).dim;
    if graph.shape(shape).level > 0 {
        return None;
    }
    let point = graph.point(0, dim);
    let field = Expander::new().field(&mut graph, shape, point).ok()?;
    let tape = Tape::new(&graph, &[field]).ok()?;
    let mut field = tape.prepare::<Dual>(&FrameValues::defaults(params));
    let stated = graph.shape(shape).contract.bounds;
    let missing = match stated {
        Some(_) => None,
        None => extent(&mut field, dim).or_else(|| steepens(&mut field).then_some(REACHES[0])),
    };
    let reach = missing.unwrap_or(REACHES[0]);
    let ends = stated.unwrap_or_else(|| {
        [-reach, reach].map(|end| {
            let width = dim.point_type().width();
            graph.constant(dim.point_type(), &[end; 3][..width])
        })
    });
    if missing.is_some() {
        let mut budget = OPERATIONS;
        let slope = steepest_within(&mut graph, shape, ends, params, &mut budget);
        if slope.is_some_and(|slope| slope.is_uniform()) {
            return Some(SuggestedClauses { bounds: missing, lipschitz: None });
        }
    }
    let region = region(&graph, ends, &FrameValues::ranges(params))?;
    let sampled = sampled_slope(&mut field, region)?;
    let lipschitz = Some(confirmed(&mut graph, shape, params, ends, sampled));
    Some(SuggestedClauses { bounds: missing, lipschitz })
}

/// The constant, raised until pairs of points refute it at none of the tested values of the params
/// and of the time. Jumps have no derivative, but pairs of points find them.
fn confirmed(
    graph: &mut Graph,
    shape: ShapeId,
    params: &[Param],
    ends: [NodeId; 2],
    sampled: SampledSlope,
) -> SampledSlope {
    let SampledSlope::Constant(first) = sampled else { return sampled };
    let mut constant = first;
    for _ in 0..TRIES {
        let steeper = frames(graph, params).into_iter().find_map(|frame| {
            let effort = Effort(PAIR_OPERATIONS);
            Probe::new(graph, shape, ends, &frame, effort)?.steeper(constant)
        });
        match steeper {
            None => return SampledSlope::Constant(constant),
            Some((at, _, slope)) if slope > MOST_GROWTH * first => {
                return SampledSlope::Unlimited(at);
            }
            Some((_, _, slope)) => constant = rounded_up(MARGIN * slope),
        }
    }
    SampledSlope::Constant(constant)
}

/// Half the edge of a cube that contains all samples within the shape, and those next to them;
/// `None` if some lie at the end of the largest cube. A cube counts beyond the one before it, whose
/// samples are nearer to each other.
fn extent(field: &mut Evaluator<'_, Dual>, dim: Dim) -> Option<f64> {
    let axes = dim.point_type().width();
    let (mut reach, mut farthest) = (REACHES[0], 0.0_f64);
    let mut known = 0.0;
    while reach <= REACHES[1] {
        let spacing = 2.0 * reach / (SAMPLES as f64 - 0.94);
        for p in grid([[-reach, reach]; 3]) {
            let far = p[..axes].iter().fold(0.0_f64, |far, x| far.max(x.abs()));
            if far >= known && field.scalar(Dual::point(p)).value <= 0.0 {
                farthest = farthest.max(far + spacing);
            }
        }
        known = reach;
        reach *= 2.0;
    }
    // In a large cube, samples miss what is thin.
    let margin = if farthest > REACHES[0] { EXTENT_MARGIN } else { 1.0 };
    (farthest <= REACHES[1]).then(|| rounded_up((margin * farthest).max(REACHES[0])))
}

/// True if a field is steeper far from the origin than near it, so that a constant needs bounds.
fn steepens(field: &mut Evaluator<'_, Dual>) -> bool {
    let [near, far] = REACHES.map(|reach| {
        let slopes = grid([[-reach, reach]; 3]).map(|p| slope(field, p));
        slopes.fold(0.0, f64::max)
    });
    far > 2.0 * near
}

/// The length of the gradient; 0 where it has none.
fn slope(field: &mut Evaluator<'_, Dual>, p: [f64; 3]) -> f64 {
    let partials = field.scalar(Dual::point(p)).partials;
    let length = partials.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length.is_finite() { length } else { 0.0 }
}

/// The points at which a field is sampled.
fn grid(region: Region) -> impl Iterator<Item = [f64; 3]> {
    (0..SAMPLES.pow(3)).map(move |i| {
        let steps = [i % SAMPLES, i / SAMPLES % SAMPLES, i / SAMPLES.pow(2)];
        std::array::from_fn(|axis| {
            let [lo, hi] = region[axis];
            // Points off the middle, where symmetric fields have no slope.
            lo + (hi - lo) * (steps[axis] as f64 + 0.03) / (SAMPLES as f64 - 0.94)
        })
    })
}

/// The largest slope that is found from a grid of points, with the params at their defaults.
fn sampled_slope(field: &mut Evaluator<'_, Dual>, region: Region) -> Option<SampledSlope> {
    let mut slope = |p: [f64; 3]| slope(field, p);
    let mut samples: Vec<([f64; 3], f64)> = grid(region).map(|p| (p, slope(p))).collect();
    samples.sort_by(|a, b| b.1.total_cmp(&a.1));
    let steepest = samples.first().filter(|sample| sample.1 > 0.0)?.1;
    samples.truncate(STARTS);
    let steeper = samples.into_iter().map(|sample| climbed(&mut slope, region, sample));
    let (at, most) = steeper.max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(match most > MOST_GROWTH * steepest {
        true => SampledSlope::Unlimited(at),
        false => SampledSlope::Constant(rounded_up(MARGIN * most)),
    })
}

/// A steeper point near a sample, by a pattern search: steps along the axes to where the slope is
/// greater, which are halved where there is none.
fn climbed(
    slope: &mut impl FnMut([f64; 3]) -> f64,
    region: Region,
    (mut at, mut most): ([f64; 3], f64),
) -> ([f64; 3], f64) {
    let mut fraction = 1.0 / SAMPLES as f64;
    for _ in 0..HALVINGS {
        for axis in 0..3 {
            let [lo, hi] = region[axis];
            for sign in [-1.0, 1.0] {
                let mut next = at;
                next[axis] = (at[axis] + sign * fraction * (hi - lo)).clamp(lo, hi);
                let found = slope(next);
                if found > most {
                    (at, most) = (next, found);
                }
            }
        }
        fraction *= 0.5;
    }
    (at, most)
}

/// The number, rounded up to two digits.
pub fn rounded_up(x: f64) -> f64 {
    let digits = (1.0 - x.log10().floor()).clamp(-12.0, 12.0) as i32;
    let scale = 10f64.powi(digits);
    (x * scale).ceil() / scale
}
