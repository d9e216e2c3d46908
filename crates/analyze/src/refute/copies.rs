//! What a shape says of its copies, held against its field.
//!
//! From p, within a ball as large as the formula says, the shape is what is sampled at p: there a point is inside of it if it is
//! inside of one of these samples, each carried along by its map as that is at p. And nowhere is the inside that of no sample.

use sdfc_graph::eval::{Dual, Evaluator, FrameValues, Tape, evaluate_frame};
use sdfc_graph::{Bounds, Dim, Expander, Graph, NodeId, Scene, ShapeId};

use crate::analytic::copies::taken_apart;
use crate::refute::probe::Random;

/// Points of which two balls are looked at, and one within the shape is looked at from places outside.
const POINTS: usize = 2000;
const PLACES: usize = 6;
/// Steps to get into the shape.
const STEPS: usize = 12;
/// How far an axis without bounds is looked at, at the least, and how often that is made four times as far.
const REACH: f64 = 2.0;
const WIDER: usize = 4;
/// Parts of the shape's size that rounding may make of the field.
const SLACK: f64 = 1e-6;

/// A point within a ball that is not what is sampled in the ball's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopiesViolation {
    /// The middle, where the shape is sampled.
    pub from: [f64; 3],
    /// How far what is sampled there should be all there is.
    pub reach: f64,
    /// The point.
    pub to: [f64; 3],
    /// The field there.
    pub field: f64,
}

/// Looks for a point that refutes the clause `copies` of a shape, if it said so of balls `farther` times as large. `None` also for a shape
/// that does not state it, or is not as the clause wants it.
pub fn refute_copies(
    scene: &Scene,
    shape: ShapeId,
    frame: &FrameValues,
    farther: f64,
) -> Option<CopiesViolation> {
    let stated = scene.graph.shape(shape);
    if !stated.contract.copies || stated.dim != Dim::Three || stated.level > 0 {
        return None;
    }
    let graph = &mut scene.graph.clone();
    let corners = Bounds::new(&scene.params).of(graph, shape);
    let [around, field] = [asked(graph, shape)?, field(graph, shape)?];
    let ends = evaluate_frame(graph, &corners, frame);
    let mut sampler = Sampler {
        around: around.prepare(frame),
        field: field.prepare(frame),
        random: Random(5),
        bounds: [0, 1].map(|end| [0, 1, 2].map(|axis| ends[end][axis])),
        farther,
    };
    (0..POINTS).find_map(|_| sampler.point())
}

fn field(graph: &mut Graph, shape: ShapeId) -> Option<Tape> {
    let p = graph.point(0, Dim::Three);
    let field = Expander::new().field(graph, shape, p).ok()?;
    Tape::new(graph, &[field]).ok()
}

/// Of a point p and a way: the field at the way's end, the least of what is sampled at p there, and the radius about p.
fn asked(graph: &mut Graph, shape: ShapeId) -> Option<Tape> {
    let copies = taken_apart(graph, shape).ok()?;
    let [p, way] = [0, 1].map(|level| graph.point(level, Dim::Three));
    let sample = |copied: &crate::analytic::copies::Copied| {
        let carried = copied.direction(graph, way);
        let there = graph.add(copied.at, carried);
        graph.sample(copied.child, there)
    };
    let samples: Vec<NodeId> = copies.samples.iter().map(sample).collect();
    let mut expander = Expander::new();
    let end = graph.add(p, way);
    let field = expander.field(graph, shape, end).ok()?;
    let mut least = |nodes: Vec<NodeId>| {
        let node = nodes.into_iter().reduce(|a, b| graph.min(a, b))?;
        expander.node(graph, node, &[p, way]).ok()
    };
    let roots = [field, least(samples)?, least(copies.limits)?];
    Tape::for_rays(graph, &roots).ok()
}

struct Sampler<'t> {
    around: Evaluator<'t, f64>,
    field: Evaluator<'t, Dual>,
    random: Random,
    bounds: [[f64; 3]; 2],
    farther: f64,
}

impl Sampler<'_> {
    /// What is wrong about one point.
    fn point(&mut self) -> Option<CopiesViolation> {
        let (p, size) = self.somewhere();
        for share in [1.0 - 1e-9, self.random.next()] {
            let reach = self.reach(p).clamp(0.0, size);
            let way = self.direction().map(|x| x * reach * share);
            if let Some(fault) = self.fault(p, way, size) {
                return Some(fault);
            }
        }
        let ([nx, ny, nz], within) = self.within(p, size);
        if let Some(fault) = self.fault(within, [0.0; 3], size) {
            return Some(fault);
        }
        // The ball about a place over the surface touches it first.
        (0..PLACES).find_map(|place| {
            let away = size * 0.01f64.powf((place as f64 + self.random.next()) / PLACES as f64);
            let over = if place == 0 { self.direction() } else { [nx, ny, nz] };
            let from = [0, 1, 2].map(|axis| within[axis] + away * over[axis]);
            let way = [0, 1, 2].map(|axis| within[axis] - from[axis]);
            self.fault(from, way, size)
        })
    }

    /// How far from a point what is sampled there should be all there is.
    fn reach(&mut self, p: [f64; 3]) -> f64 {
        self.farther * self.around.eval_ray(p, [0.0; 3])[2][0]
    }

    /// A point just within the shape, or on the way to it, and the surface's normal there.
    fn within(&mut self, mut p: [f64; 3], size: f64) -> ([f64; 3], [f64; 3]) {
        let mut normal = [0.0; 3];
        for step in 0..STEPS {
            let Dual { value, partials } = self.field.scalar(Dual::point(p));
            let slope = partials.iter().map(|slope| slope * slope).sum::<f64>().sqrt().max(1e-6);
            let deep = if step + 1 < STEPS { 0.0 } else { 10.0 * SLACK * size };
            normal = partials.map(|partial| partial / slope);
            p = [0, 1, 2].map(|axis| p[axis] - (value + deep) / slope * normal[axis]);
        }
        (normal, if p.iter().all(|x| x.is_finite()) { p } else { [0.0; 3] })
    }

    fn fault(&mut self, from: [f64; 3], way: [f64; 3], size: f64) -> Option<CopiesViolation> {
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
        let reach = self.reach(from);
        if length > reach.max(0.0) {
            return None;
        }
        let [field, sampled] = [0, 1].map(|root| self.around.eval_ray(from, way)[root][0]);
        let slack = SLACK * size;
        let is_other = field.min(sampled) < -slack && field.max(sampled) > slack;
        let to = [0, 1, 2].map(|axis| from[axis] + way[axis]);
        is_other.then_some(CopiesViolation { from, reach, to, field })
    }

    /// A point about the shape, and the size of what was looked at.
    fn somewhere(&mut self) -> ([f64; 3], f64) {
        let wide = REACH * 4f64.powi(self.random.below(WIDER) as i32);
        let mut size = 0.0f64;
        let point = [0, 1, 2].map(|axis| {
            let [lo, hi] = match [self.bounds[0][axis], self.bounds[1][axis]] {
                [lo, hi] if lo.is_finite() && hi.is_finite() => [lo, hi],
                [lo, _] if lo.is_finite() => [lo, lo + wide],
                [_, hi] if hi.is_finite() => [hi - wide, hi],
                _ => [-wide, wide],
            };
            let margin = 0.25 * (hi - lo);
            size = size.max(hi - lo);
            lo - margin + (hi - lo + 2.0 * margin) * self.random.next()
        });
        (point, size)
    }

    /// A unit vector.
    fn direction(&mut self) -> [f64; 3] {
        loop {
            let vector = [0, 1, 2].map(|_| 2.0 * self.random.next() - 1.0);
            let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
            if length > 1e-3 && length <= 1.0 {
                return vector.map(|x| x / length);
            }
        }
    }
}
