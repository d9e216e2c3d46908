//! Stated clauses, held against samples.
//!
//! What a field is compared with is not the field itself: points of the surface, found by bisection between
//! signs, are at least as far as the nearest one, so a value above that distance refutes `exact` and `bound`; an
//! exact distance f with the gradient g has a point of the surface at p - f g, so one that has none there, and no
//! surface as near, refutes `exact`; two points refute a constant, one refutes bounds. A clause is held to what it says:
//! given children that keep the same promise.

use sdfc_graph::eval::FrameValues;
use sdfc_graph::{Bounds, Graph, Scene, ShapeId};

use crate::certify::quality::{Promise, Qualities, Stated};
use crate::refute::copies::{CopiesViolation, refute_copies};
use crate::refute::frames::{ParamValues, frames};
use crate::refute::probe::Probe;
use crate::refute::rays::{RayViolation, refute_intersect};

/// What intervals of rays may be off, in parts of the lengths that they are computed from.
const RAY_ROUNDING: f64 = 1e-8;

/// A clause that does not hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// The instance.
    pub shape: ShapeId,
    /// Which clause.
    pub clause: Clause,
    /// Where it fails, in the shape's dimension.
    pub at: Vec<f64>,
    /// The field there.
    pub field: f64,
    /// Where the params stand.
    pub params: ParamValues,
}

/// A refuted clause and what is the case instead.
#[derive(Clone, Debug, PartialEq)]
pub enum Clause {
    /// `exact` or `bound`, and how far the surface is, up to the accuracy of a search.
    Distance {
        /// Whether it is `exact`.
        exact: bool,
        /// On which side of the surface.
        outside: bool,
        /// The distance.
        distance: f64,
    },
    /// `lipschitz`.
    Lipschitz {
        /// As stated, times the largest of the children's.
        constant: f64,
        /// The change of the field to another point, divided by the way there.
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

/// Looks for points at which clauses of the shapes fail; at most one is told of each shape. The budget is fixed: some
/// ten thousand evaluations a shape. Shapes whose arguments depend on a point, and fields that do not
/// expand, are passed over.
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
        if stated.says_nothing() {
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

/// A ray whose intervals do not hold.
fn refuted_hits(scene: &Scene, shape: ShapeId) -> Option<Violation> {
    frames(&scene.params).into_iter().find_map(|(params, frame)| {
        let fault = refute_intersect::<f64>(scene, shape, &frame, RAY_ROUNDING)?;
        let (at, field) = (fault.at().to_vec(), fault.field);
        Some(Violation { shape, clause: Clause::Intersect(fault), at, field, params })
    })
}

/// A ball in which there is something else than what is sampled in its middle.
fn refuted_copies(scene: &Scene, shape: ShapeId) -> Option<Violation> {
    frames(&scene.params).into_iter().find_map(|(params, frame)| {
        let fault = refute_copies(scene, shape, &frame, 1.0)?;
        let (at, field) = (fault.to.to_vec(), fault.field);
        Some(Violation { shape, clause: Clause::Copies(fault), at, field, params })
    })
}

/// What a probe finds.
struct Fault {
    clause: Clause,
    at: Vec<f64>,
    field: f64,
}

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
    let (at, field, distance) = probe.no_distance(promised)?;
    let side = usize::from(field < 0.0);
    let exact = promised[side] == Promise::Exact;
    let clause = Clause::Distance { exact, outside: side == 0, distance };
    Some(Fault { clause, at, field })
}
