//! The report of the passes on a scene and its shapes.

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_graph::{GradientReport, Graph, ShapeId};

use crate::certify::conservative::Uncertified;
use crate::certify::inexact::InexactOperator;
use crate::certify::promise::Sides;
use crate::certify::quality::Qualities;
use crate::certify::reason::Reason;
use crate::cost::Cost;
use crate::reroll::rewrite::RerolledLoop;
use crate::shapes::shapes_below;

/// The findings and decisions of the passes.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The loops that stand for similar operands; empty if the field is unrolled.
    pub loops: Vec<RerolledLoop>,
    /// The number of operations that loops must replace, or the field stays unrolled.
    pub unrolled_limit: usize,
    /// Leaf shapes in one evaluation of the field: shapes without children at distinct points.
    pub leaves: usize,
    /// Cost of the distance.
    pub distance_cost: Cost,
    /// Cost of the gradient, including what it shares with the distance.
    pub gradient_cost: Cost,
    /// How the gradient is derived.
    pub gradient: GradientReport,
    /// Cost of a pixel of a planar picture; nothing for solids.
    pub pixel_cost: Cost,
    /// Cost of the functions of a ray that are evaluated before it is marched.
    pub ray_cost: Cost,
    /// Cost of the distance to the marched operands.
    pub marched_cost: Cost,
    /// The analytic operands.
    pub analytic: Vec<ShapeId>,
    /// The marched operands.
    pub marched: Vec<ShapeId>,
    /// The marched operands that shaders evaluate only near their boxes.
    pub guarded: Vec<ShapeId>,
    /// All shapes of the scene, children before parents.
    pub shapes: Vec<ShapeReport>,
    /// The parts without a known Lipschitz constant; empty for a certified scene.
    pub uncertified: Vec<Uncertified>,
    /// Operators that need an exact distance and are applied to an inexact field.
    pub inexact_operators: Vec<InexactOperator>,
}

impl Report {
    /// Estimated number of operations per ray. `evaluations` is the mean number of field
    /// evaluations; with `looks_ahead` the first of them is the analytic pre-intersection.
    pub fn operations_per_ray(&self, evaluations: f64, looks_ahead: bool) -> f64 {
        if looks_ahead && self.ray_cost.operations > 0 {
            let steps = (evaluations - 1.0).max(0.0);
            return self.ray_cost.operations as f64 + steps * self.marched_cost.operations as f64;
        }
        evaluations * self.distance_cost.operations as f64
    }
}

/// The results for one shape.
#[derive(Clone, Debug)]
pub struct ShapeReport {
    /// The shape.
    pub shape: ShapeId,
    /// The promises outside and inside.
    pub sides: Sides,
    /// The Lipschitz constant.
    pub lipschitz: Lipschitz,
    /// True if the distance was divided by the constant.
    pub divided: bool,
    /// The operation at which the field, or a field that it samples, may jump; `None` if it has a
    /// constant or does not jump.
    pub jump: Option<&'static str>,
    /// True if interval derivatives gave the constant, which then holds within the bounds.
    pub from_interval_derivatives: bool,
}

/// A Lipschitz constant for a report.
#[derive(Clone, Debug, PartialEq)]
pub enum Lipschitz {
    /// The constant.
    Number(f64),
    /// The constant depends on params, time or the frame number.
    PerFrame,
    /// There is no known constant, for this reason.
    Unknown(Reason),
}

/// Reports on every shape of a scene.
pub(crate) fn shape_reports(
    graph: &Graph,
    qualities: &Qualities,
    root: ShapeId,
    divided: &[ShapeId],
) -> Vec<ShapeReport> {
    let divided: FxHashSet<ShapeId> = divided.iter().copied().collect();
    let mut shapes = Vec::new();
    let mut jumps: FxHashMap<ShapeId, &'static str> = FxHashMap::default();
    for shape in shapes_below(graph, root) {
        let Some(quality) = qualities.get(shape) else { continue };
        let jump = match &quality.lipschitz {
            Ok(_) => None,
            Err(Reason::Jump(what)) => Some(*what),
            Err(_) => {
                graph.shape(shape).children.iter().find_map(|child| jumps.get(child).copied())
            }
        };
        jumps.extend(jump.map(|what| (shape, what)));
        let lipschitz = match &quality.lipschitz {
            Ok(node) => graph.as_number(*node).map_or(Lipschitz::PerFrame, Lipschitz::Number),
            Err(reason) => Lipschitz::Unknown(reason.clone()),
        };
        let divided = divided.contains(&shape);
        let from_interval_derivatives = quality.local_bounds.is_some();
        let sides = quality.sides;
        shapes.push(ShapeReport {
            shape,
            sides,
            lipschitz,
            divided,
            from_interval_derivatives,
            jump,
        });
    }
    shapes
}
