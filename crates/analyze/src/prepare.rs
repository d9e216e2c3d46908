//! The passes from a scene to a flat program.

use sdfc_graph::{
    Bounds, Dim, ExpandError, Expander, Graph, Light, NodeId, Program, Rays, Scene, Settings,
    Shadow, ShapeId, SurfaceVector, Unary, best_gradient, reachable, substitute, uniforms,
};

use crate::analytic::operands::Operands;
use crate::analytic::queries::{ray_functions, ray_queries};
use crate::analytic::split::split_analytic;
use crate::certify::conservative::conservative_field;
use crate::certify::faithful::is_faithful;
use crate::certify::inexact::inexact_operators;
use crate::certify::quality::Qualities;
use crate::cost::{Cost, cost};
use crate::guards::{bounds_of_loops, guards, limit_operands};
use crate::leaves::count_leaves;
use crate::planar::planar_picture;
use crate::report::{Report, shape_reports};
use crate::reroll::cullable::cullable_loops;
use crate::reroll::kinds::OperandBounds;
use crate::reroll::marched_bounds::looped_bounds;
use crate::reroll::materials::{fold_with_chains, reroll_materials};
use crate::reroll::rewrite::{reroll, similar_groups};
use crate::reroll::strategy::{LoopStrategy, has_secondary_rays};
use crate::shapes::minimum;

/// A scene that is ready for code generation, and a report.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The flat program.
    pub program: Program,
    /// The findings and decisions of the passes.
    pub report: Report,
}

/// The largest Lipschitz constant by which a field is divided without a loss of accuracy. `auto`
/// takes 1/256 of the tolerance, a quarter of a pixel, for a hit; eight times that is 1/128 of a
/// pixel.
const LOOSE: f64 = 8.0;

/// Turns a scene into a flat program. For solids, it derives promises and constants, expands the
/// conservative field and the materials, splits off analytic operands, folds transforms, rerolls
/// loops, derives the gradient and lists the uniform slots. Regions need no rays: see `planar`.
///
/// # Errors
///
/// If the expansion exceeds the graph's node limit.
pub fn prepare(scene: &Scene) -> Result<Prepared, ExpandError> {
    prepare_with(scene, [0.0; 3], LoopStrategy::Auto)
}

/// As [`prepare`], with a loop strategy and with the point of the flat program relative to
/// `origin`. The positions of solids relative to the origin are computed in f64 here, so that
/// rounding errors of f32 are small near the origin.
///
/// # Errors
///
/// As [`prepare`].
pub fn prepare_with(
    scene: &Scene,
    origin: [f64; 3],
    strategy: LoopStrategy,
) -> Result<Prepared, ExpandError> {
    // The passes turn this copy of the scene's graph into the graph of the flat program.
    let program_graph = scene.graph.clone();
    let mut program = Program {
        origin,
        graph: program_graph,
        params: scene.params.clone(),
        settings: scene.settings.clone(),
        ..Program::default()
    };
    let report = match scene.root {
        Some(root) if scene.graph.shape(root).dim == Dim::Two => {
            planar_picture(&mut program, scene, root, strategy)?
        }
        Some(root) => flatten(&mut program, root, scene.has_materials, strategy)?,
        None => Report::default(),
    };
    program.uniforms = uniforms(&program.graph, &program.roots());
    Ok(Prepared { program, report })
}

/// Fills in the program, whose graph is a copy of the scene's graph.
fn flatten(
    program: &mut Program,
    root: ShapeId,
    has_material: bool,
    strategy: LoopStrategy,
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
    let mut operands = split_analytic(graph, &mut expander, &qualities, &mut bounds, root, point)?;
    let lipschitz =
        lipschitz_constant(graph, &qualities, root).filter(|_| field.uncertified.is_empty());
    let (uses_loops, unrolled_limit) =
        strategy.uses_loops(graph, field.distance, &program.settings, lipschitz);
    if uses_loops {
        march_similar_operands(graph, &mut operands);
    }
    let mut whole = field.distance;
    let is_union = operands.analytic.len() + operands.marched.len() > 1;
    if is_union && field.uncertified.is_empty() && !(uses_loops && has_similar(graph, &operands)) {
        let (known, marched) = ((&mut bounds, &qualities), &mut operands.marched);
        let limited = limit_operands(graph, &mut expander, known, marched)?;
        whole = substitute(graph, whole, &limited);
    }
    let mut flat = fields(graph, whole, &operands);
    let count = flat.len();
    if uses_estimate(&program.settings) && !field.divided.is_empty() && !uses_loops {
        let undivided = expander.field(graph, root, point)?;
        flat.push(graph.max(undivided, whole));
    }
    program.falls_behind = flat.len() == count
        && !uses_loops
        && has_soft_shadows(&program.settings)
        && !is_faithful(graph, &qualities, root);
    let with_estimate = flat.len();
    if has_material {
        flat.extend(expander.material(graph, root, point)?);
    }
    let with_material = flat.len();
    for operand in &operands.marched {
        flat.extend([operand.value, operand.limit.unwrap_or(operand.value)]);
    }
    let with_operands = flat.len();
    if uses_loops {
        let known = (&mut bounds, &qualities);
        let bounds = bounds_of_loops(graph, &mut expander, known, &operands.marched)?;
        flat.extend(bounds.into_iter().flat_map(|(value, [lower, upper])| [value, lower, upper]));
    }
    let chains = if uses_loops { expander.material_chains(graph)? } else { Vec::new() };
    let (folded, chains) = fold_with_chains(graph, &flat, chains);
    program.names = folded.names(graph, &expander.names());
    let (flat, operand_bounds) = folded.roots.split_at(with_operands);
    let (operand_bounds, _) = operand_bounds.as_chunks();
    let operand_bounds: OperandBounds =
        operand_bounds.iter().map(|&[value, lower, upper]| (value, [lower, upper])).collect();
    let (flat, marched) = flat.split_at(with_material);
    let (marched, _) = marched.as_chunks();
    let (fields, material) = flat.split_at(with_estimate);
    let (fields, estimate) = fields.split_at(count);
    program.estimate = estimate.first().copied();
    let (mut fields, mut material, mut loops) = (fields.to_vec(), material.to_vec(), Vec::new());
    if uses_loops {
        let rerolled = reroll(graph, &fields, &operand_bounds);
        let known = (&rerolled.replaced, &operand_bounds);
        material = reroll_materials(graph, &material, known, &chains);
        (fields, loops) = (rerolled.roots, rerolled.loops);
    }
    let Some(&distance) = fields.first() else { return Ok(Report::default()) };
    program.distance = Some(distance);
    let (gradient, gradient_report) = best_gradient(graph, distance, own_point);
    program.gradient = Some(gradient);
    (program.material, program.seen_material) =
        materials(graph, material.try_into().ok(), gradient);
    program.is_loose = field.divided.iter().any(|&shape| is_loose(graph, &qualities, shape));
    program.cullable_loops = cullable_loops(graph, &fields, lipschitz);
    if !program.cullable_loops.is_empty() && has_secondary_rays(&program.settings) {
        program.loop_bounds = looped_bounds(graph, &mut bounds, root);
    }
    let known = (&mut bounds, &qualities);
    let guards = guards(graph, &mut expander, known, &operands.marched, marched, &fields)?;
    let (guarded, guards) = guards.into_iter().unzip();
    program.guards = guards;
    let queries = ray_queries(graph, &mut expander, &mut bounds, &operands)?;
    program.rays = ray_functions(&operands, &fields, queries);
    let Rays { first_hit, marched, clip, copies, .. } = program.rays;
    let queries: Vec<NodeId> = first_hit.into_iter().chain(clip).collect();
    Ok(Report {
        loops,
        unrolled_limit,
        leaves,
        distance_cost: cost(graph, &[distance]),
        gradient_cost: cost(graph, &[gradient]),
        gradient: gradient_report,
        pixel_cost: Cost::default(),
        ray_cost: cost(graph, &queries),
        marched_cost: cost(graph, copies.or(marched).as_slice()),
        analytic: operands.analytic.iter().map(|operand| operand.shape).collect(),
        marched: operands.marched.iter().map(|operand| operand.shape).collect(),
        guarded,
        shapes: shape_reports(graph, &qualities, root, &field.divided),
        uncertified: field.uncertified,
        inexact_operators: inexact_operators(graph, &qualities, root),
    })
}

/// The material of a point; and that of a seen surface, if it depends on the normal or on the
/// direction to the eye.
fn materials(
    graph: &mut Graph,
    fields: Option<[NodeId; 6]>,
    gradient: NodeId,
) -> (Option<[NodeId; 6]>, Option<[NodeId; 6]>) {
    let Some(fields) = fields else { return (None, None) };
    let vectors = SurfaceVector::ALL.map(|vector| graph.surface_vector(vector));
    let used = reachable(graph, &fields);
    if !vectors.iter().any(|vector| used.contains(vector)) {
        return (Some(fields), None);
    }
    let outward = graph.unary(Unary::Normalize, gradient);
    let seen = [1, 2].map(|level| graph.point(level, Dim::Three));
    let replaced = |graph: &mut Graph, by: [NodeId; 2]| {
        let [normal, view] = vectors;
        let pairs = [(normal, by[0]), (view, by[1])];
        fields.map(|field| substitute(graph, field, &pairs))
    };
    (Some(replaced(graph, [outward; 2])), Some(replaced(graph, seen)))
}

/// True if an estimate of the distance serves a picture better than a lower bound.
fn uses_estimate(settings: &Settings) -> bool {
    settings.occlusion.is_some() || has_soft_shadows(settings)
}

fn has_soft_shadows(settings: &Settings) -> bool {
    settings.lights.iter().any(|light: &Light| matches!(light.shadow, Shadow::Soft(_)))
}

/// True if the field of a shape is divided by a constant that can be large.
fn is_loose(graph: &Graph, qualities: &Qualities, shape: ShapeId) -> bool {
    let constant = qualities.get(shape).and_then(|quality| quality.lipschitz.as_ref().ok());
    constant.is_some_and(|&constant| graph.range(constant).hi > LOOSE)
}

/// The Lipschitz constant of the scene's field: infinite if it depends on a param, `None` if there
/// is none.
fn lipschitz_constant(graph: &Graph, qualities: &Qualities, root: ShapeId) -> Option<f64> {
    let constant = qualities.get(root)?.lipschitz.as_ref().ok()?;
    Some(graph.as_number(*constant).unwrap_or(f64::INFINITY))
}

/// Makes the operands that become loops marched ones. As analytic operands, all of them would be
/// intersected with every ray. The local intervals of copies are dropped, since those of one
/// iteration would count for all.
fn march_similar_operands(graph: &mut Graph, operands: &mut Operands) {
    let values: Vec<NodeId> = operands.analytic.iter().map(|operand| operand.value).collect();
    let mut many = similar_groups(graph, &values).concat();
    many.sort_unstable();
    operands.make_marched(&many);
    operands.marched.iter_mut().for_each(|operand| operand.local = None);
}

/// True if some marched operands become loops, which know the minima of operands by their nodes.
fn has_similar(graph: &mut Graph, operands: &Operands) -> bool {
    let values: Vec<NodeId> = operands.marched.iter().map(|operand| operand.value).collect();
    !similar_groups(graph, &values).is_empty()
}

/// The field of the whole scene. If there are analytic operands, their field follows, and then that
/// of the marched operands, if there are any.
fn fields(graph: &mut Graph, whole: NodeId, operands: &Operands) -> Vec<NodeId> {
    let mut fields = vec![whole];
    if !operands.analytic.is_empty() {
        fields.extend(minimum(graph, operands.analytic.iter().map(|operand| operand.value)));
        fields.extend(minimum(graph, operands.marched.iter().map(|operand| operand.value)));
    }
    fields
}
