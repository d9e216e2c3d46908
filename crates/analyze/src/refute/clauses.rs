//! Tests of stated clauses by samples.
//!
//! The field is compared with points of the surface, which bisection finds between points of
//! opposite sign. They are at least as far away as the nearest point of the surface, so a value
//! above their distance refutes `exact` and `bound`. If f is an exact distance with the gradient g,
//! then p - f g is on the surface; a point where that is not so, and which has no surface as near,
//! refutes `exact`. Two points refute a constant, and one point refutes bounds. A clause is tested
//! as it is meant: for children that keep the same promise.

use sdfc_graph::eval::FrameValues;
use sdfc_graph::{Bounds, Graph, Scene, ShapeId};

use crate::certify::promise::Promise;
use crate::certify::quality::{Qualities, Stated};
use crate::refute::copies::{CopiesViolation, refute_copies};
use crate::refute::frames::{ParamValues, frames};
use crate::refute::probe::Probe;
use crate::refute::rays::{RayViolation, refute_intersect};

/// Relative error that intervals along rays may have.
const RAY_ROUNDING: f64 = 1e-8;

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
    /// The values of the params.
    pub params: ParamValues,
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
    /// `hits`.
    Intersect(RayViolation),
    /// `copies`.
    Copies(CopiesViolation),
}

/// Searches for points at which clauses of the shapes fail, and returns at most one for each shape.
/// The budget is about ten thousand evaluations for each shape. Shapes whose arguments depend on a
/// point, and fields that do not expand, are skipped.
pub fn refute(scene: &Scene, shapes: &[ShapeId]) -> Vec<Violation> {
    let mut graph = scene.graph.clone();
    let mut bounds = Bounds::new(&scene.params);
    let mut found = Vec::new();
    for &shape in shapes.iter().filter(|&&shape| scene.graph.shape(shape).level == 0) {
        let stated =
            Qualities::of_scene(&mut graph, shape, &scene.params).stated(&mut graph, shape);
        let refuted = refuted_hits(scene, shape).or_else(|| refuted_copies(scene, shape));
        if let Some(refuted) = refuted {
            found.push(refuted);
            continue;
        }
        if stated.is_empty() {
            continue;
        }
        let corners = bounds.of(&mut graph, shape);
        let refuted = frames(&scene.params).into_iter().find_map(|(params, frame)| {
            let probe = Probe::new(&mut graph, shape, corners, &frame)?;
            let fault = first_fault(&graph, &stated, probe, &frame)?;
            Some(Violation {
                shape,
                clause: fault.clause,
                at: fault.at,
                field: fault.field,
                params,
            })
        });
        found.extend(refuted);
    }
    found
}

/// A ray with wrong intervals.
fn refuted_hits(scene: &Scene, shape: ShapeId) -> Option<Violation> {
    frames(&scene.params).into_iter().find_map(|(params, frame)| {
        let fault = refute_intersect::<f64>(scene, shape, &frame, RAY_ROUNDING)?;
        let (at, field) = (fault.at().to_vec(), fault.field);
        Some(Violation { shape, clause: Clause::Intersect(fault), at, field, params })
    })
}

/// A ball that contains more than the copies sampled at its centre.
fn refuted_copies(scene: &Scene, shape: ShapeId) -> Option<Violation> {
    frames(&scene.params).into_iter().find_map(|(params, frame)| {
        let fault = refute_copies(scene, shape, &frame, 1.0)?;
        let (at, field) = (fault.to.to_vec(), fault.field);
        Some(Violation { shape, clause: Clause::Copies(fault), at, field, params })
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
