//! Tests of the clause `intersect`: the field along rays is compared with the stated intervals.
//!
//! The rays start near and far, inside the shape and on its surface. Some are parallel to axes, and
//! some barely touch or miss the surface. Within the intervals the field must not be positive, and
//! outside of them not negative. At their ends it must be 0.

use sdfc_graph::eval::{Evaluator, FrameValues, Number, Tape};
use sdfc_graph::{Bounds, Dim, Expander, Graph, NodeId, Param, Scene, ShapeId};

use crate::refute::sampling::{Effort, Random, corners_at, longest, window};

/// Number of rays for each shape.
const RAYS: usize = 4000;
/// Number of samples along each ray.
const SAMPLES: usize = 24;
/// Largest distance of a ray's origin, in sizes of the shape.
const FARTHEST: f64 = 30.0;
/// Half the length of the sampled interval on an axis without bounds.
const REACH: f64 = 1.5;

/// A ray along which the field contradicts the intervals.
#[derive(Clone, Debug, PartialEq)]
pub struct RayViolation {
    /// The origin and the direction.
    pub ray: [[f64; 3]; 2],
    /// The distance along the ray at which they differ.
    pub t: f64,
    /// The field at that point.
    pub field: f64,
    /// True if that point is within an interval, false if it is not, `None` at the end of one.
    pub inside: Option<bool>,
}

impl RayViolation {
    /// The point at which they differ.
    pub fn at(&self) -> [f64; 3] {
        at(self.ray, self.t)
    }
}

/// Searches for a ray that refutes the intervals of a shape. They are computed in the number type
/// `N`, and `rounding` is the relative error that is accepted. Returns `None` also for a shape
/// without the clause `intersect`.
pub fn refute_intersect<N: Number + Into<f64>>(
    scene: &Scene,
    shape: ShapeId,
    frame: &FrameValues,
    rounding: f64,
) -> Option<RayViolation> {
    let mut extract = scene.graph.extract(&[], &[shape]);
    let shape = extract.shape(shape)?;
    let effort = Effort(u64::MAX);
    intersect_violation::<N>(&mut extract.graph, &scene.params, shape, frame, rounding, effort)
}

/// As [`refute_intersect`], in a graph to which nodes may be added.
pub(super) fn intersect_violation<N: Number + Into<f64>>(
    graph: &mut Graph,
    params: &[Param],
    shape: ShapeId,
    frame: &FrameValues,
    rounding: f64,
    effort: Effort,
) -> Option<RayViolation> {
    let stated = graph.shape(shape).intersect.clone();
    if stated.is_empty() {
        return None;
    }
    let corners = Bounds::new(params).of(graph, shape);
    let rays = [0, 1].map(|level| graph.point(level, Dim::Three));
    let mut expander = Expander::new();
    let distance = expander.field(graph, shape, rays[0]).ok()?;
    let ends: Option<Vec<NodeId>> =
        stated.as_flattened().iter().map(|&end| expander.node(graph, end, &rays).ok()).collect();
    let (field, ends) = (Tape::new(graph, &[distance]).ok()?, Tape::for_rays(graph, &ends?).ok()?);
    let window = window(corners_at(graph, corners, frame)?, 3, REACH)?;
    let mut sampler = Sampler {
        exact: field.prepare(frame),
        ends: ends.prepare::<N>(frame),
        random: Random(1),
        window,
        size: longest(window).max(1e-3),
        rounding,
    };
    // Each ray takes samples of the field.
    let rays = effort.samples(RAYS, SAMPLES, &field);
    (0..rays).find_map(|_| sampler.ray())
}

/// The field and the intervals of a shape, and the rays to sample.
struct Sampler<'t, N> {
    exact: Evaluator<'t, f64>,
    /// The ends of the stated intervals.
    ends: Evaluator<'t, N>,
    random: Random,
    window: [[f64; 3]; 2],
    size: f64,
    rounding: f64,
}

impl<N: Number + Into<f64>> Sampler<'_, N> {
    /// Tests one random ray.
    fn ray(&mut self) -> Option<RayViolation> {
        let (target, direction) = (self.target(), self.random.direction_by_axes());
        let back = match self.random.below(4) {
            0 => 0.0,
            1 => FARTHEST * self.random.next(),
            _ => 2.0 * self.random.next(),
        } * self.size;
        let narrow = |x: f64| -> f64 { N::constant(x).into() };
        let direction = direction.map(narrow);
        let origin = [0, 1, 2].map(|axis| narrow(target[axis] - back * direction[axis]));
        let intervals = self.intervals([origin, direction]);
        // The rounding error of the origin, the direction and the point on the ray.
        let slack = |t: f64| self.rounding * (back + t.abs() + self.size);
        let fault = |t, field, inside| RayViolation { ray: [origin, direction], t, field, inside };
        for &t in intervals.as_flattened().iter().filter(|t| t.abs() < 10.0 * (back + self.size)) {
            let within =
                |interval: &[f64; 2]| interval[0] + slack(t) < t && t < interval[1] - slack(t);
            let field = self.exact.scalar(at([origin, direction], t));
            let is_zero = field.abs() <= slack(t);
            if !is_zero && !intervals.iter().any(within) {
                return Some(fault(t, field, None));
            }
        }
        for sample in 0..SAMPLES {
            let t = back
                + self.size * (2.0 * (sample as f64 + self.random.next()) / SAMPLES as f64 - 1.0);
            let field = self.exact.scalar(at([origin, direction], t));
            let inside = intervals.iter().any(|interval| interval[0] <= t && t <= interval[1]);
            let right = if inside { field <= slack(t) } else { field >= -slack(t) };
            if !right {
                return Some(fault(t, field, Some(inside)));
            }
        }
        None
    }

    /// The intervals that are not empty. An end that is NaN makes no interval empty, so that the
    /// test fails.
    fn intervals(&mut self, ray: [[f64; 3]; 2]) -> Vec<[f64; 2]> {
        let [origin, direction] = ray.map(|vector| vector.map(N::constant));
        let ends = self.ends.eval_ray(origin, direction);
        let intervals = ends.chunks_exact(2).map(|pair| [pair[0][0].into(), pair[1][0].into()]);
        let is_empty = |interval: &[f64; 2]| interval[0] > interval[1];
        intervals.filter(|interval| !is_empty(interval)).collect()
    }

    /// A point that the ray goes through: in the window, often on its walls or at its centre, or
    /// next to the surface.
    fn target(&mut self) -> [f64; 3] {
        let [lo, hi] = self.window;
        let mut point = [0, 1, 2].map(|axis| match self.random.below(6) {
            0 => lo[axis],
            1 => hi[axis],
            2 => 0.5 * (lo[axis] + hi[axis]),
            _ => lo[axis] + (hi[axis] - lo[axis]) * self.random.next(),
        });
        if self.random.below(2) == 0 {
            // Newton steps to the surface, and a tiny step beyond it.
            for _ in 0..4 {
                let [field, slopes @ ..] = self.slopes(point);
                let square = slopes.iter().map(|slope| slope * slope).sum::<f64>().max(1e-12);
                let step = field / square;
                point = [0, 1, 2].map(|axis| point[axis] - step * slopes[axis]);
            }
            let step_beyond = self.size * [0.0, 1e-6, -1e-6, 1e-3, -1e-3][self.random.below(5)];
            let [_, slopes @ ..] = self.slopes(point);
            point = [0, 1, 2].map(|axis| point[axis] + step_beyond * slopes[axis]);
        }
        if point.iter().all(|x| x.is_finite()) { point } else { [0.0; 3] }
    }

    /// The field and its slopes along the axes.
    fn slopes(&mut self, point: [f64; 3]) -> [f64; 4] {
        let step = 1e-5 * self.size;
        let here = self.exact.scalar(point);
        let mut slopes = [here; 4];
        for axis in 0..3 {
            let mut beside = point;
            beside[axis] += step;
            slopes[axis + 1] = (self.exact.scalar(beside) - here) / step;
        }
        slopes
    }
}

fn at([origin, direction]: [[f64; 3]; 2], t: f64) -> [f64; 3] {
    [0, 1, 2].map(|axis| origin[axis] + t * direction[axis])
}
