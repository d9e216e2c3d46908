//! Tests of stated clauses by samples.
//!
//! The field is compared with points of the surface, which bisection finds between points of
//! opposite sign. They are at least as far away as the nearest point of the surface, so a value
//! above their distance refutes `exact` and `bound`. If f is an exact distance with the gradient g,
//! then p - f g is on the surface; a point where that is not so, and which has no surface as near,
//! refutes `exact`. Two points refute a constant, and one point refutes bounds. A clause is tested
//! as it is meant: for children that keep the same promise.

use sdfc_graph::eval::FrameValues;
use sdfc_graph::{Bounds, Graph, Param, Scene, ShapeId};

use crate::certify::promise::Promise;
use crate::certify::quality::{Qualities, Stated};
use crate::refute::copies::{CopiesViolation, copies_violation};
use crate::refute::frames::frames;
use crate::refute::probe::Probe;
use crate::refute::rays::{RayViolation, intersect_violation};
use crate::refute::sampling::Effort;

/// Relative error that intervals along rays may have.
const RAY_ROUNDING: f64 = 1e-8;
/// Tests of a shape that share its operations: rays, copies, bounds, slopes and distances.
const TESTS: usize = 5;

/// A clause that does not hold, and the point that shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// The instance of the shape.
    pub shape: ShapeId,
    /// The clause.
    pub clause: Clause,
    /// A point at which it fails, in the shape's dimension.
    pub at: Vec<f64>,
    /// The field at that point.
    pub field: f64,
    /// The values of the params, and the time.
    pub frame: FrameValues,
}

/// A clause that does not hold, and what is true instead.
#[derive(Clone, Debug, PartialEq)]
pub enum Clause {
    /// `exact` or `bound`.
    Distance {
        /// True for `exact`, false for `bound`.
        exact: bool,
        /// True if the point is outside, false if it is inside.
        outside: bool,
        /// The distance to the surface, up to the accuracy of a search.
        distance: f64,
    },
    /// `lipschitz`.
    Lipschitz {
        /// The stated constant times the largest constant of a child.
        constant: f64,
        /// The change of the field between the two points, divided by their distance.
        slope: f64,
        /// The other point.
        to: Vec<f64>,
    },
    /// `bounds`.
    Bounds,
    /// `intersect`.
    Intersect(RayViolation),
    /// `copies`.
    Copies(CopiesViolation),
}

/// Searches for points at which clauses of the shapes fail, and returns at most one for each shape.
/// It takes some ten thousand evaluations for each shape, but no more than about five times
/// `operations` scalar operations in total: each sample counts as at least one evaluation, and
/// takes up to eight. Shapes whose arguments depend on a point, and fields that do not expand, are
/// skipped.
pub fn refute(scene: &Scene, shapes: &[ShapeId], operations: u64) -> Vec<Violation> {
    let is_fixed = |&&shape: &&ShapeId| scene.graph.shape(shape).level == 0;
    let tests = (TESTS * shapes.len() * frames(&scene.graph, &scene.params).len()).max(1);
    let effort = Effort(operations / tests as u64);
    let shapes = shapes.iter().filter(is_fixed);
    shapes.filter_map(|&shape| violation(scene, shape, effort)).collect()
}

/// A violated clause of one shape.
fn violation(scene: &Scene, shape: ShapeId, effort: Effort) -> Option<Violation> {
    let mut extract = scene.graph.extract(&[], &[shape]);
    let copy = extract.shape(shape)?;
    let (graph, params) = (&mut extract.graph, &scene.params[..]);
    let stated = Qualities::of_scene(graph, copy, params).stated(graph, copy);
    let (fault, frame) = intersect_fault(graph, params, copy, effort)
        .or_else(|| copies_fault(graph, params, copy, effort))
        .or_else(|| field_fault(graph, params, copy, &stated, effort))?;
    Some(Violation { shape, clause: fault.clause, at: fault.at, field: fault.field, frame })
}

/// A ray with wrong intervals.
fn intersect_fault(
    graph: &mut Graph,
    params: &[Param],
    shape: ShapeId,
    effort: Effort,
) -> Option<(Fault, FrameValues)> {
    frames(graph, params).into_iter().find_map(|frame| {
        let fault = intersect_violation::<f64>(graph, params, shape, &frame, RAY_ROUNDING, effort)?;
        let (at, field) = (fault.at().to_vec(), fault.field);
        Some((Fault { clause: Clause::Intersect(fault), at, field }, frame))
    })
}

/// A ball that contains more than the copies sampled at its centre.
fn copies_fault(
    graph: &mut Graph,
    params: &[Param],
    shape: ShapeId,
    effort: Effort,
) -> Option<(Fault, FrameValues)> {
    frames(graph, params).into_iter().find_map(|frame| {
        let fault = copies_violation(graph, params, shape, &frame, 1.0, effort)?;
        let (at, field) = (fault.to.to_vec(), fault.field);
        Some((Fault { clause: Clause::Copies(fault), at, field }, frame))
    })
}

/// A point at which a clause on bounds, the constant or distances fails.
fn field_fault(
    graph: &mut Graph,
    params: &[Param],
    shape: ShapeId,
    stated: &Stated,
    effort: Effort,
) -> Option<(Fault, FrameValues)> {
    if stated.is_empty() {
        return None;
    }
    let corners = Bounds::new(params).of(graph, shape);
    frames(graph, params).into_iter().find_map(|frame| {
        let probe = Probe::new(graph, shape, corners, &frame, effort)?;
        Some((first_fault(graph, stated, probe, &frame)?, frame))
    })
}

/// A clause that does not hold, as a probe finds it.
struct Fault {
    clause: Clause,
    at: Vec<f64>,
    field: f64,
}

/// Tests the clauses on bounds, constants and distances.
fn first_fault(
    graph: &Graph,
    stated: &Stated,
    mut probe: Probe,
    frame: &FrameValues,
) -> Option<Fault> {
    if stated.bounds
        && let Some((at, field)) = probe.beyond_bounds()
    {
        return Some(Fault { clause: Clause::Bounds, at, field });
    }
    let constant = stated.lipschitz.and_then(|node| {
        let values = sdfc_graph::eval::evaluate_frame(graph, &[node], frame);
        Some(values.first()?[0]).filter(|constant| constant.is_finite())
    });
    if let Some(constant) = constant
        && let Some((at, to, slope)) = probe.steeper(constant)
    {
        let field = probe.at(at);
        let clause = Clause::Lipschitz { constant, slope, to: probe.lanes(to) };
        return Some(Fault { clause, at: probe.lanes(at), field });
    }
    let promised = [stated.sides.outside, stated.sides.inside];
    if promised == [Promise::None; 2] {
        return None;
    }
    let (at, field, distance) = probe.wrong_distance(promised)?;
    let side = usize::from(field < 0.0);
    let exact = promised[side] == Promise::Exact;
    let clause = Clause::Distance { exact, outside: side == 0, distance };
    Some(Fault { clause, at, field })
}
