//! Claims about a field, stated by clauses or derived, and their refutation by samples.

use sdfc_analyze::{Promise, Qualities};
use sdfc_graph::{Graph, NodeId, Scene, ShapeId, SidePromise};

use crate::field::Field;
use crate::geometry::Point;
use crate::samples::Samples;

/// Relative difference that is allowed between compared distances: the rounding of f64 over a chain
/// of operations.
const SLACK: f64 = 1e-6;
/// The same for a slope.
const SLOPE_SLACK: f64 = 1e-7;

/// The sides of a surface, in the order of arrays.
pub const SIDES: [&str; 2] = ["outside", "inside"];

/// The claims about a field.
#[derive(Clone, Debug)]
pub struct Claims {
    /// For outside and inside.
    pub sides: [Promise; 2],
    /// The Lipschitz constant within the bounds.
    pub lipschitz: Option<f64>,
    /// The lowest and the highest corner.
    pub bounds: Option<[Point; 2]>,
}

impl Claims {
    /// No claims.
    pub const NONE: Self = Self { sides: [Promise::None; 2], lipschitz: None, bounds: None };

    /// Returns what the compiler derives for the shape from its clauses and its formula.
    pub fn derived(graph: &Graph, qualities: &Qualities, id: ShapeId, field: &Field) -> Self {
        let Some(quality) = qualities.get(id) else { return Self::NONE };
        let constant = quality.lipschitz.as_ref().ok().and_then(|&node| graph.as_number(node));
        let known =
            quality.everywhere || field.bounds.as_flattened().iter().all(|end| end.is_finite());
        Self {
            sides: [quality.sides.outside, quality.sides.inside],
            lipschitz: constant.filter(|_| known),
            bounds: Some(field.bounds),
        }
    }

    /// Returns the first claim that the samples refute.
    pub fn refuted_by(&self, samples: &Samples) -> Option<String> {
        self.constant_refuted(samples)
            .or_else(|| self.bounds_refuted(samples))
            .or_else(|| samples.points.iter().find_map(|sample| self.side_refuted(samples, sample)))
    }

    fn constant_refuted(&self, samples: &Samples) -> Option<String> {
        let constant = self.lipschitz?;
        let steepest = samples.steepest;
        if steepest.slope > constant * (1.0 + SLOPE_SLACK) + SLOPE_SLACK {
            let (slope, p, q) = (steepest.slope, steepest.p, steepest.q);
            return Some(format!("lipschitz {constant}, but {slope} between {p:?} and {q:?}"));
        }
        // The surface and the segment to it lie within the bounds, which are convex.
        samples.points.iter().filter(|sample| sample.within).find_map(|sample| {
            let most = constant * sample.nearest + SLACK * samples.scale;
            let (f, p, nearest) = (sample.f, sample.p, sample.nearest);
            (f.abs() > most).then(|| {
                format!(
                    "lipschitz {constant}, but {f} at {p:?}, which is {nearest} from the surface"
                )
            })
        })
    }

    fn bounds_refuted(&self, samples: &Samples) -> Option<String> {
        let [lo, hi] = self.bounds?;
        let slack = SLACK * samples.scale;
        let is_out = |p: &&Point| {
            (0..samples.axes).any(|axis| p[axis] < lo[axis] - slack || p[axis] > hi[axis] + slack)
        };
        let outside = samples.reached.iter().find(is_out)?;
        Some(format!("{outside:?} is inside but not within {lo:?} .. {hi:?}"))
    }

    fn side_refuted(&self, samples: &Samples, sample: &crate::samples::Sample) -> Option<String> {
        // Where the field is 0, the point is on neither side.
        if sample.f == 0.0 {
            return None;
        }
        let side = usize::from(sample.f < 0.0);
        let slack = SLACK * samples.scale;
        let (f, p, nearest) = (sample.f.abs(), sample.p, sample.nearest);
        let name = SIDES[side];
        let promise = self.sides[side];
        if promise >= Promise::Bound && f > nearest + slack {
            return Some(format!("{promise} {name}, but {f} at {p:?}, {nearest} from the surface"));
        }
        if promise == Promise::Exact && samples.has_surface && f < nearest - slack {
            return Some(format!("exact {name}, but {f} at {p:?}, {nearest} from the surface"));
        }
        None
    }
}

/// The clauses of one instance, and what they depend on.
pub struct Stated {
    /// For each side `exact` and `bound`: `None` if not stated, otherwise true if the condition
    /// holds here.
    pub promises: [[Option<bool>; 2]; 2],
    /// The constant, including those of the children, if they have one that holds everywhere.
    pub lipschitz: Option<f64>,
    pub bounds: Option<[Point; 2]>,
    /// True if all children are exact, and if all are bounds; `exact` and `bound` depend on this.
    pub children: [bool; 2],
}

/// The order of promises in [`Stated::promises`].
pub const PROMISES: [Promise; 2] = [Promise::Exact, Promise::Bound];

impl Stated {
    /// Returns the clauses of a shape. `clauses` are those of the entry, as written, because the
    /// graph keeps nothing of a clause whose condition is false.
    pub fn of(
        scene: &Scene,
        graph: &Graph,
        qualities: &Qualities,
        id: ShapeId,
        field: &Field,
        clauses: &[String],
    ) -> Self {
        let shape = scene.graph.shape(id);
        let contract = &shape.contract;
        let holds = |condition: Option<NodeId>| {
            let value = condition.and_then(|node| graph.as_const(node));
            value.is_some_and(|value| value.lanes()[0] != 0.0)
        };
        let one = |condition, promise, side| {
            let holds = holds(condition);
            (holds || says(clauses, promise, side)).then_some(holds)
        };
        let side = |promise: SidePromise, side| {
            [one(promise.exact, Promise::Exact, side), one(promise.bound, Promise::Bound, side)]
        };
        let children: Vec<_> = shape.children.iter().map(|&child| qualities.get(child)).collect();
        let all_at_least = |promise| {
            children.iter().all(|child| {
                child.is_some_and(|it| it.sides.outside >= promise && it.sides.inside >= promise)
            })
        };
        let largest = children.iter().try_fold(1.0f64, |largest, child| {
            let quality = (*child)?;
            let constant = graph.as_number(*quality.lipschitz.as_ref().ok()?)?;
            quality.everywhere.then_some(largest.max(constant))
        });
        let own = contract.lipschitz.and_then(|node| graph.as_number(node));
        Self {
            promises: [side(contract.outside, SIDES[0]), side(contract.inside, SIDES[1])],
            lipschitz: own
                .zip(largest)
                .map(|(own, largest)| own * largest)
                .filter(|it| it.is_finite()),
            bounds: contract.bounds.map(|_| field.bounds),
            children: PROMISES.map(all_at_least),
        }
    }

    /// Returns true if no clause is stated.
    pub fn is_silent(&self) -> bool {
        self.promises == [[None; 2]; 2] && self.lipschitz.is_none() && self.bounds.is_none()
    }

    /// Returns the clauses as claims.
    pub fn claims(&self) -> Claims {
        let side = |promises: [Option<bool>; 2]| {
            let holds = |at: usize| promises[at] == Some(true) && self.children[at];
            match (holds(0), holds(1)) {
                (true, _) => Promise::Exact,
                (false, true) => Promise::Bound,
                (false, false) => Promise::None,
            }
        };
        Claims { sides: self.promises.map(side), lipschitz: self.lipschitz, bounds: self.bounds }
    }
}

/// Returns true if one of the clauses, as written, states a promise for a side.
pub fn says(clauses: &[String], promise: Promise, side: &str) -> bool {
    clauses.iter().any(|clause| {
        let mut words = clause.split_whitespace();
        let is_it = words.next().is_some_and(|word| word == promise.to_string());
        let of_side = words.next().filter(|word| SIDES.contains(word));
        is_it && of_side.is_none_or(|word| word == side)
    })
}
