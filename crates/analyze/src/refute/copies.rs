//! Tests of the clause `copies`.
//!
//! Within a ball around p, whose radius the formula states, the shape equals the copies that are
//! sampled at p: a point of the ball is inside the shape if and only if it is inside one of these
//! samples, under the maps that are valid at p. And every point inside the shape is inside a sample
//! at that point.

use sdfc_graph::eval::{Dual, Evaluator, FrameValues, Tape};
use sdfc_graph::{Bounds, Dim, Expander, Graph, NodeId, Param, Scene, ShapeId};

use crate::analytic::copies::{CopySample, split_copies};
use crate::refute::sampling::{Effort, REACH, Random, corners_at, grown, longest, window};

/// Number of points around which balls are tested, and of points outside from which each point of
/// the shape is tested.
const POINTS: usize = 2000;
const OUTSIDE_POINTS: usize = 6;
/// Evaluations that the tests around one point count as: three for each of nine balls, and the
/// Newton steps.
const EVALUATIONS: usize = 40;
/// Newton steps towards the inside of the shape.
const STEPS: usize = 12;
/// Number of lengths of the sampled interval on an axis without bounds, each four times as long as
/// the one before.
const WIDENINGS: usize = 4;
/// Rounding error of the field, as a fraction of the size of the shape.
const SLACK: f64 = 1e-6;

/// A point of a ball at which the shape differs from the copies sampled at the ball's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopiesViolation {
    /// The centre of the ball.
    pub from: [f64; 3],
    /// The radius of the ball: the stated distance to the copies that are not sampled.
    pub reach: f64,
    /// The point.
    pub to: [f64; 3],
    /// The field at that point.
    pub field: f64,
}

/// Searches for a point that refutes the clause `copies` of a shape, with the radius of all balls
/// multiplied by `radius_factor`. Returns `None` also for a shape without the clause, or whose
/// formula does not have the required form.
pub fn refute_copies(
    scene: &Scene,
    shape: ShapeId,
    frame: &FrameValues,
    radius_factor: f64,
) -> Option<CopiesViolation> {
    let mut extract = scene.graph.extract(&[], &[shape]);
    let shape = extract.shape(shape)?;
    let effort = Effort(u64::MAX);
    copies_violation(&mut extract.graph, &scene.params, shape, frame, radius_factor, effort)
}

/// As [`refute_copies`], in a graph to which nodes may be added.
pub(super) fn copies_violation(
    graph: &mut Graph,
    params: &[Param],
    shape: ShapeId,
    frame: &FrameValues,
    radius_factor: f64,
    effort: Effort,
) -> Option<CopiesViolation> {
    let stated = graph.shape(shape);
    if !stated.contract.copies || stated.dim != Dim::Three || stated.level > 0 {
        return None;
    }
    let corners = Bounds::new(params).of(graph, shape);
    let [around, field] = [ball_tape(graph, shape)?, field(graph, shape)?];
    let mut sampler = Sampler {
        around: around.prepare(frame),
        field: field.prepare(frame),
        random: Random(5),
        bounds: corners_at(graph, corners, frame)?,
        radius_factor,
    };
    (0..effort.samples(POINTS, EVALUATIONS, &around)).find_map(|_| sampler.point())
}

fn field(graph: &mut Graph, shape: ShapeId) -> Option<Tape> {
    let p = graph.point(0, Dim::Three);
    let field = Expander::new().field(graph, shape, p).ok()?;
    Tape::new(graph, &[field]).ok()
}

/// A tape of a point p and an offset: the field at p + offset, the minimum there of the samples at
/// p, and the radius of the ball around p.
fn ball_tape(graph: &mut Graph, shape: ShapeId) -> Option<Tape> {
    let copies = split_copies(graph, shape).ok()?;
    let [p, offset] = [0, 1].map(|level| graph.point(level, Dim::Three));
    let sample = |copied: &CopySample| {
        let carried = copied.direction(graph, offset);
        let there = graph.add(copied.at, carried);
        graph.sample(copied.child, there)
    };
    let samples: Vec<NodeId> = copies.samples.iter().map(sample).collect();
    let mut expander = Expander::new();
    let end = graph.add(p, offset);
    let field = expander.field(graph, shape, end).ok()?;
    let mut least = |nodes: Vec<NodeId>| {
        let node = nodes.into_iter().reduce(|a, b| graph.min(a, b))?;
        expander.node(graph, node, &[p, offset]).ok()
    };
    let roots = [field, least(samples)?, least(copies.limits)?];
    Tape::for_rays(graph, &roots).ok()
}

/// The tapes of a shape, and the points to sample.
struct Sampler<'t> {
    around: Evaluator<'t, f64>,
    field: Evaluator<'t, Dual>,
    random: Random,
    bounds: [[f64; 3]; 2],
    radius_factor: f64,
}

impl Sampler<'_> {
    /// Tests one random point and a point of the shape near it.
    fn point(&mut self) -> Option<CopiesViolation> {
        let (p, size) = self.random_point()?;
        for fraction in [1.0 - 1e-9, self.random.next()] {
            let reach = self.reach(p).clamp(0.0, size);
            let offset = self.random.direction().map(|x| x * reach * fraction);
            if let Some(fault) = self.fault(p, offset, size) {
                return Some(fault);
            }
        }
        let ([nx, ny, nz], within) = self.within(p, size);
        if let Some(fault) = self.fault(within, [0.0; 3], size) {
            return Some(fault);
        }
        // A ball around a point above the surface touches the surface at its nearest point.
        (0..OUTSIDE_POINTS).find_map(|index| {
            let height =
                size * 0.01f64.powf((index as f64 + self.random.next()) / OUTSIDE_POINTS as f64);
            let up = if index == 0 { self.random.direction() } else { [nx, ny, nz] };
            let from = [0, 1, 2].map(|axis| within[axis] + height * up[axis]);
            let offset = [0, 1, 2].map(|axis| within[axis] - from[axis]);
            self.fault(from, offset, size)
        })
    }

    /// The radius of the ball around a point.
    fn reach(&mut self, p: [f64; 3]) -> f64 {
        self.radius_factor * self.around.eval_ray(p, [0.0; 3])[2][0]
    }

    /// The normal of the surface near a point, and a point just inside the shape. The second may
    /// still be outside if the Newton steps did not converge.
    fn within(&mut self, mut p: [f64; 3], size: f64) -> ([f64; 3], [f64; 3]) {
        let mut normal = [0.0; 3];
        for step in 0..STEPS {
            let Dual { value, partials } = self.field.scalar(Dual::point(p));
            let slope = partials.iter().map(|slope| slope * slope).sum::<f64>().sqrt().max(1e-6);
            let depth = if step + 1 < STEPS { 0.0 } else { 10.0 * SLACK * size };
            normal = partials.map(|partial| partial / slope);
            p = [0, 1, 2].map(|axis| p[axis] - (value + depth) / slope * normal[axis]);
        }
        (normal, if p.iter().all(|x| x.is_finite()) { p } else { [0.0; 3] })
    }

    /// Compares the shape with the samples at `from`, at the end of an offset.
    fn fault(&mut self, from: [f64; 3], offset: [f64; 3], size: f64) -> Option<CopiesViolation> {
        let length = offset.iter().map(|x| x * x).sum::<f64>().sqrt();
        let reach = self.reach(from);
        if length > reach.max(0.0) {
            return None;
        }
        let [field, sampled] = [0, 1].map(|root| self.around.eval_ray(from, offset)[root][0]);
        let slack = SLACK * size;
        let is_other = field.min(sampled) < -slack && field.max(sampled) > slack;
        let to = [0, 1, 2].map(|axis| from[axis] + offset[axis]);
        is_other.then_some(CopiesViolation { from, reach, to, field })
    }

    /// A random point around the shape, and the size of the sampled box. Returns `None` if the
    /// bounds are empty.
    fn random_point(&mut self) -> Option<([f64; 3], f64)> {
        let reach = REACH * 4f64.powi(self.random.below(WIDENINGS) as i32);
        let [lo, hi] = window(self.bounds, 3, reach)?;
        let margin = [0, 1, 2].map(|axis| 0.25 * (hi[axis] - lo[axis]));
        let point = self.random.point(grown([lo, hi], margin), 3);
        Some((point, longest([lo, hi])))
    }
}
