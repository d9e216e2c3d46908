//! The passes, in order, from a scene to a flat program.

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_graph::{
    Bounds, Dim, ExpandError, Expander, Graph, NodeId, Program, Rays, Scene, ShapeId,
    fold_transforms, gradient, uniforms,
};

use crate::analytic::queries::{asked_of_rays, rays};
use crate::analytic::split::{Parts, least, parts};
use crate::certify::conservative::{Uncertified, conservative_field};
use crate::certify::inexact::{InexactOperator, inexact_operators, inexact_outside};
use crate::certify::lipschitz::Reason;
use crate::certify::quality::{Qualities, Sides, shapes_below};
use crate::cost::{Cost, cost};
use crate::leaves::count_leaves;
use crate::reroll::cullable::visits;
use crate::reroll::marched_bounds::within;
use crate::reroll::rewrite::{RerolledLoop, alike, reroll};
use crate::reroll::strategy::{LoopStrategy, has_secondary_rays};

/// A scene ready for code generation, and what was found on the way.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// Flat math.
    pub program: Program,
    /// What was modelled and why.
    pub report: Report,
}

/// What was modelled and why.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// What became loops; empty where all is written out.
    pub loops: Vec<RerolledLoop>,
    /// Up to how many operations the field would have been written out.
    pub unrolled_limit: usize,
    /// Leaf shapes evaluated per field evaluation: childless instances at distinct points.
    pub leaves: usize,
    /// Cost of the distance alone.
    pub distance_cost: Cost,
    /// Cost of the gradient, what it shares with the distance included.
    pub gradient_cost: Cost,
    /// Cost of what a ray is asked before it is marched.
    pub ray_cost: Cost,
    /// Cost of the distance to what is left to march.
    pub marched_cost: Cost,
    /// What rays meet without marching.
    pub analytic: Vec<ShapeId>,
    /// What is left to march.
    pub marched: Vec<ShapeId>,
    /// Every shape of the scene, children before parents.
    pub shapes: Vec<ShapeReport>,
    /// Parts that no Lipschitz constant covers; empty for a certified scene.
    pub uncertified: Vec<Uncertified>,
    /// Operators that want an exact distance and have none.
    pub inexact_operators: Vec<InexactOperator>,
    /// Where the scene's field stops being the distance outside; `None` where it is that everywhere.
    pub inexact_outside: Option<ShapeId>,
}

impl Report {
    /// Operations that a ray takes on average, by a method that looks ahead or not, from the mean of evaluations, of which
    /// looking ahead is one.
    pub fn operations_per_ray(&self, evaluations: f64, looks_ahead: bool) -> f64 {
        if looks_ahead && self.ray_cost.operations > 0 {
            let steps = (evaluations - 1.0).max(0.0);
            return self.ray_cost.operations as f64 + steps * self.marched_cost.operations as f64;
        }
        evaluations * self.distance_cost.operations as f64
    }
}

/// What is known of one shape.
#[derive(Clone, Debug)]
pub struct ShapeReport {
    /// Which.
    pub shape: ShapeId,
    /// Its promises outside and inside.
    pub sides: Sides,
    /// Its Lipschitz constant: a number, or as text where it follows a param or is not known.
    pub lipschitz: Lipschitz,
    /// Whether the distance was divided by it.
    pub divided: bool,
    /// The operation at which the field, or one that it samples, may jump; `None` where it has a constant, or nothing jumps.
    pub jump: Option<&'static str>,
    /// Whether it was found by interval derivatives, within the bounds.
    pub from_interval_derivatives: bool,
}

/// A Lipschitz constant as people want to read it.
#[derive(Clone, Debug, PartialEq)]
pub enum Lipschitz {
    /// Known when the scene compiles.
    Number(f64),
    /// Known when a frame starts.
    PerFrame,
    /// Not known, and why.
    Unknown(String),
}

/// Flattens a scene: promises and constants, the sound field, materials, folded transforms, gradient,
/// uniform slots.
///
/// # Errors
///
/// When expansion passes the graph's node limit.
pub fn prepare(scene: &Scene) -> Result<Prepared, ExpandError> {
    prepare_with(scene, [0.0; 3], LoopStrategy::Auto)
}

/// As [`prepare`], with the flat math's point counted from a place in the scene. Where a solid is moved to, less that
/// place, is computed in f64 here, so that near the place little is left for f32 to round.
///
/// # Errors
///
/// As [`prepare`].
pub fn prepare_with(
    scene: &Scene,
    origin: [f64; 3],
    writing: LoopStrategy,
) -> Result<Prepared, ExpandError> {
    let mut program = Program {
        origin,
        graph: scene.graph.clone(),
        params: scene.params.clone(),
        settings: scene.settings.clone(),
        ..Program::default()
    };
    let report = match scene.root {
        Some(root) => flatten(&mut program, root, scene.has_materials, writing)?,
        None => Report::default(),
    };
    program.uniforms = uniforms(&program.graph, &program.roots());
    Ok(Prepared { program, report })
}

fn flatten(
    program: &mut Program,
    root: ShapeId,
    painted: bool,
    writing: LoopStrategy,
) -> Result<Report, ExpandError> {
    let params = program.params.clone();
    let graph = &mut program.graph;
    let mut expander = Expander::new();
    let own_point = graph.point(0, Dim::Three);
    let origin = graph.constant(Dim::Three.point_type(), &program.origin);
    let point = graph.add(own_point, origin);
    let qualities = Qualities::of_scene(graph, root, &params);
    let field = conservative_field(graph, &mut expander, &qualities, root, point)?;
    let leaves = count_leaves(graph, &mut expander, root, point)?;
    let mut bounds = Bounds::new(&params);
    let mut apart = parts(graph, &mut expander, &qualities, &mut bounds, root, point)?;
    let steepest = steepest(graph, &qualities, root).filter(|_| field.uncertified.is_empty());
    let (rolls, unrolled_limit) = writing.rolls(graph, field.distance, &program.settings, steepest);
    if rolls {
        leave_lists_to_march(graph, &mut apart);
    }
    let mut flat = fields(graph, field.distance, &apart);
    let count = flat.len();
    if painted {
        flat.extend(expander.material(graph, root, point)?);
    }
    let folded = fold_transforms(graph, &flat);
    program.names = folded.names(graph, &expander.names());
    let (fields, material) = folded.roots.split_at(count);
    let (fields, rolled) =
        if rolls { reroll(graph, fields) } else { (fields.to_vec(), Vec::new()) };
    let Some(&distance) = fields.first() else { return Ok(Report::default()) };
    program.distance = Some(distance);
    program.material = material.try_into().ok();
    program.gradient = Some(gradient(graph, distance, own_point));
    program.cullable_loops = visits(graph, &fields, steepest);
    if !program.cullable_loops.is_empty() && has_secondary_rays(&program.settings) {
        program.loop_bounds = within(graph, &mut bounds, root);
    }
    let asked = asked_of_rays(graph, &mut expander, &mut bounds, &apart)?;
    program.rays = rays(&apart, &fields, asked);
    let Rays { first_hit: hits, marched, clip, copies, .. } = program.rays;
    let asked: Vec<NodeId> = hits.into_iter().chain(clip).collect();
    Ok(Report {
        loops: rolled,
        unrolled_limit,
        leaves,
        distance_cost: cost(graph, &[distance]),
        gradient_cost: cost(graph, program.gradient.as_slice()),
        ray_cost: cost(graph, &asked),
        marched_cost: cost(graph, copies.or(marched).as_slice()),
        analytic: apart.closed.iter().map(|part| part.shape).collect(),
        marched: apart.open.iter().map(|part| part.shape).collect(),
        shapes: shape_reports(graph, &qualities, root, &field.divided),
        uncertified: field.uncertified,
        inexact_operators: inexact_operators(graph, &qualities, root),
        inexact_outside: inexact_outside(graph, &qualities, root),
    })
}

/// The largest slope that the scene's field can have; infinite where that follows a param, `None` where it has none.
fn steepest(graph: &Graph, qualities: &Qualities, root: ShapeId) -> Option<f64> {
    let constant = qualities.get(root)?.lipschitz.as_ref().ok()?;
    Some(graph.as_number(*constant).unwrap_or(f64::INFINITY))
}

/// What a list holds is met by marching: all of it met in closed form would be asked of each ray, and the copies that one
/// round is near would be taken for those of all.
fn leave_lists_to_march(graph: &mut Graph, apart: &mut Parts) {
    let values: Vec<NodeId> = apart.closed.iter().map(|part| part.value).collect();
    let mut many = alike(graph, &values).concat();
    many.sort_unstable();
    apart.march(&many);
    apart.open.iter_mut().for_each(|part| part.near = None);
}

/// The field, and where some of it is met in closed form the fields of that and of the rest, if there is any.
fn fields(graph: &mut Graph, whole: NodeId, apart: &Parts) -> Vec<NodeId> {
    let mut fields = vec![whole];
    if !apart.closed.is_empty() {
        fields.extend(least(graph, apart.closed.iter().map(|part| part.value)));
        fields.extend(least(graph, apart.open.iter().map(|part| part.value)));
    }
    fields
}

fn shape_reports(
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
            Err(reason) => Lipschitz::Unknown(reason.to_string()),
        };
        let divided = divided.contains(&shape);
        let from_interval_derivatives = quality.within.is_some();
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
