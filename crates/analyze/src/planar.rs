//! The picture of a scene of regions, as one formula of a pixel.
//!
//! A planar picture has no rays, so nothing is marched: a pixel is a formula of its middle and its
//! size. The regions are layers, each over the ones before it. A layer covers the fraction `1/2 - d
//! / (|grad d| w)` of a pixel of width w, clamped to 0..1: the part of the pixel on the inner side
//! of a straight edge at the signed distance `d / |grad d|`. The gradient is not computed where its
//! length is known to be 1. Through a colour that is not opaque, the layers below show.
//!
//! Shaders and the CPU renderer evaluate the same formula, as they do for fields.

use sdfc_graph::{
    Binary, Bounds, Dim, ExpandError, Expander, Graph, Guard, MaterialField, NodeId, Program,
    Scene, ShapeId, SurfaceVector, Ternary, Type, Unary, best_gradient, guarded_distance,
    substitute,
};

use crate::certify::conservative::{Uncertified, conservative_field};
use crate::certify::inexact::inexact_operators;
use crate::certify::quality::Qualities;
use crate::colored::colored;
use crate::cost::cost;
use crate::guards::guard_of_region;
use crate::leaves::count_leaves;
use crate::report::{Report, shape_reports};
use crate::reroll::kinds::OperandBounds;
use crate::reroll::materials::{fold_with_chains, reroll_materials};
use crate::reroll::rewrite::{RerolledLoop, reroll};
use crate::reroll::strategy::LoopStrategy;
use crate::unit_slope::unit_slopes;

/// Linear colour of the background of a scene that states none: #1c2027.
const BACKGROUND: [f64; 3] = [0.0116, 0.0144, 0.0203];
/// Lower bound of the length of a gradient that is divided by.
const LEAST_SLOPE: f64 = 1e-6;
/// Lower bound of the spacing of isolines, which a param may set to 0.
const LEAST_SPACING: f64 = 1e-9;
/// Width of an isoline in pixels, and of the one where the distance is 0.
const LINE_WIDTHS: [f64; 2] = [1.0, 2.5];
/// Opacity of an isoline, and of the one where the distance is 0.
const LINE_OPACITIES: [f64; 2] = [0.3, 0.9];
/// Isolines vanish where they are this many pixels apart, and are whole from twice that on.
const LEAST_LINE_SPACING: f64 = 3.0;
/// Lines are black on colours of at least this luminance, and white on darker ones. It is the
/// linear value of middle grey.
const BRIGHT: f64 = 0.18;
/// Luminance of linear red, green and blue (ITU-R BT.709).
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

type Material = [NodeId; 6];

/// One region of a planar picture.
struct Layer {
    distance: NodeId,
    material: Option<Material>,
    /// The weight of the parts with a colour; `None` if all colours are opaque.
    colored: Option<NodeId>,
    /// True if the gradient has length 1.
    has_unit_slope: bool,
}

/// The formulas of a planar scene.
struct Formulas {
    /// The conservative field of the union of all regions.
    conservative: NodeId,
    uncertified: Vec<Uncertified>,
    /// The shapes that were divided by a constant in it.
    divided: Vec<ShapeId>,
    /// The fields of the union and of each layer, undivided.
    distances: Vec<NodeId>,
    /// One for each distance, or none.
    materials: Vec<Material>,
    /// See [`colored`]; one for each distance, or none.
    colored: Vec<NodeId>,
    leaves: usize,
    loops: Vec<RerolledLoop>,
    unrolled_limit: usize,
}

/// Fills in the program of a planar scene, whose graph is a copy of the scene's graph.
pub(crate) fn planar_picture(
    program: &mut Program,
    scene: &Scene,
    root: ShapeId,
    strategy: LoopStrategy,
) -> Result<Report, ExpandError> {
    let point = program.graph.point(0, Dim::Two);
    let qualities = Qualities::of_scene(&mut program.graph, root, &scene.params);
    let formulas = formulas(program, scene, root, &qualities, strategy)?;
    let graph = &mut program.graph;
    let unit_slopes = unit_slopes(graph, &qualities, root);
    let layer = |(index, shape): (usize, &ShapeId)| Layer {
        distance: formulas.distances[index],
        material: formulas.materials.get(index).copied(),
        colored: formulas.colored.get(index).copied(),
        has_unit_slope: unit_slopes.contains(shape),
    };
    let whole = layer((0, &root));
    let mut layers: Vec<Layer> = (1..).zip(&scene.layers).map(layer).collect();
    let distance = formulas.conservative;
    let (gradient, gradient_report) = best_gradient(graph, distance, point);
    (program.distance, program.gradient) = (Some(distance), Some(gradient));
    program.material = whole.material.map(|nearest| topmost(graph, nearest, &layers));
    let mut guards = Vec::new();
    if program.settings.isolines.is_none() {
        let origin = graph.constant(Type::Vec2, &program.origin[..2]);
        let at = graph.add(point, origin);
        guards = guard_layers(graph, scene, &qualities, &mut layers, at)?;
    }
    // Regions are drawn as written, without light.
    program.settings.environment = None;
    let background = program.settings.background;
    let background = background.unwrap_or_else(|| graph.constant(Type::Vec3, &BACKGROUND));
    let mut color = layered(graph, background, &layers, point);
    if let Some(spacing) = program.settings.isolines {
        let distance = in_pixels(graph, &whole, point);
        color = with_isolines(graph, [color, background], distance, spacing);
    }
    let [red, green, blue] = [0, 1, 2].map(|lane| graph.component(color, lane));
    let sign = if guards.is_empty() { whole.distance } else { nearest(graph, &layers) };
    let pixel = graph.compose(&[red, green, blue, sign]);
    program.planar_pixel = Some(pixel);
    let (guarded, guards) = guards.into_iter().unzip();
    program.guards = guards;
    Ok(Report {
        loops: formulas.loops,
        unrolled_limit: formulas.unrolled_limit,
        leaves: formulas.leaves,
        distance_cost: cost(graph, &[distance]),
        gradient_cost: cost(graph, &[gradient]),
        gradient: gradient_report,
        pixel_cost: cost(graph, &[pixel]),
        guarded,
        shapes: shape_reports(graph, &qualities, root, &formulas.divided),
        uncertified: formulas.uncertified,
        inexact_operators: inexact_operators(graph, &qualities, root),
        ..Report::default()
    })
}

/// Expands the regions and their materials, and simplifies them like fields of solids.
fn formulas(
    program: &mut Program,
    scene: &Scene,
    root: ShapeId,
    qualities: &Qualities,
    strategy: LoopStrategy,
) -> Result<Formulas, ExpandError> {
    let graph = &mut program.graph;
    let mut expander = Expander::new();
    let own_point = graph.point(0, Dim::Two);
    let origin = graph.constant(Type::Vec2, &program.origin[..2]);
    let point = graph.add(own_point, origin);
    let shapes: Vec<ShapeId> = [root].iter().chain(&scene.layers).copied().collect();
    let field = conservative_field(graph, &mut expander, qualities, root, point)?;
    let mut nodes = vec![field.distance];
    for &shape in &shapes {
        nodes.push(expander.field(graph, shape, point)?);
    }
    let leaves = count_leaves(graph, &mut expander, root, point)?;
    for &shape in shapes.iter().filter(|_| scene.has_materials) {
        let material = expander.material(graph, shape, point)?;
        nodes.extend(seen_from_the_front(graph, &material));
    }
    let colored = colored(graph, &shapes, point)?;
    nodes.extend(seen_from_the_front(graph, &colored));
    let (uses_loops, unrolled_limit) =
        strategy.uses_loops(graph, nodes[0], &program.settings, None);
    let chains = if uses_loops { expander.material_chains(graph)? } else { Vec::new() };
    let (folded, chains) = fold_with_chains(graph, &nodes, chains);
    program.names = folded.names(graph, &expander.names());
    let (fields, materials) = folded.roots.split_at(1 + shapes.len());
    let (mut fields, mut materials, mut loops) = (fields.to_vec(), materials.to_vec(), Vec::new());
    if uses_loops {
        let bounds = OperandBounds::default();
        let rerolled = reroll(graph, &fields, &bounds);
        materials = reroll_materials(graph, &materials, (&rerolled.replaced, &bounds), &chains);
        (fields, loops) = (rerolled.roots, rerolled.loops);
    }
    let (conservative, distances) = (fields[0], fields[1..].to_vec());
    let (materials, colored) = materials.split_at(materials.len() - colored.len());
    let (materials, colored) = (materials.as_chunks().0.to_vec(), colored.to_vec());
    let (uncertified, divided) = (field.uncertified, field.divided);
    Ok(Formulas {
        conservative,
        uncertified,
        divided,
        distances,
        materials,
        colored,
        leaves,
        loops,
        unrolled_limit,
    })
}

/// Fields of materials whose normal and direction to the eye are z.
fn seen_from_the_front(graph: &mut Graph, fields: &[NodeId]) -> Vec<NodeId> {
    let front = graph.constant(Type::Vec3, &[0.0, 0.0, 1.0]);
    let pairs = SurfaceVector::ALL.map(|vector| (graph.surface_vector(vector), front));
    fields.iter().map(|&field| substitute(graph, field, &pairs)).collect()
}

/// Lets the distances of costly layers be evaluated only near the rectangles around them, and
/// returns the guards. A layer farther than a pixel away covers nothing of it.
fn guard_layers(
    graph: &mut Graph,
    scene: &Scene,
    qualities: &Qualities,
    layers: &mut [Layer],
    point: NodeId,
) -> Result<Vec<(ShapeId, Guard)>, ExpandError> {
    let size = graph.point(1, Dim::Two);
    let width = graph.component(size, 0);
    let (mut expander, mut bounds) = (Expander::new(), Bounds::new(&scene.params));
    let mut guards = Vec::new();
    for (layer, &shape) in layers.iter_mut().zip(&scene.layers) {
        let (value, known) = ((shape, layer.distance), (&mut expander, &mut bounds));
        if !layer.has_unit_slope {
            continue;
        }
        if let Some(guard) = guard_of_region(graph, known, qualities, value, point)? {
            layer.distance = guarded_distance(graph, guard, width);
            guards.push((shape, guard));
        }
    }
    Ok(guards)
}

/// The least distance of all layers, which has the sign of the union's.
fn nearest(graph: &mut Graph, layers: &[Layer]) -> NodeId {
    let least = layers.iter().map(|layer| layer.distance).reduce(|a, b| graph.min(a, b));
    least.unwrap_or_else(|| graph.number(f64::INFINITY))
}

/// The material of the topmost layer at a point; outside of all layers, of the nearest one.
fn topmost(graph: &mut Graph, nearest: Material, layers: &[Layer]) -> Material {
    let zero = graph.number(0.0);
    layers.iter().filter_map(|layer| Some((layer, layer.material?))).fold(
        nearest,
        |below, (layer, material)| {
            let inside = graph.le(layer.distance, zero);
            [0, 1, 2, 3, 4, 5].map(|field| graph.select(inside, material[field], below[field]))
        },
    )
}

/// The background with all layers over it.
fn layered(graph: &mut Graph, background: NodeId, layers: &[Layer], point: NodeId) -> NodeId {
    layers.iter().fold(background, |below, layer| {
        let color = color_of(graph, layer, below);
        let (distance, _) = in_pixels(graph, layer, point);
        let half = graph.number(0.5);
        let covered = graph.sub(half, distance);
        let covered = graph.unary(Unary::Saturate, covered);
        graph.ternary(Ternary::Mix, below, color, covered)
    })
}

/// What a layer shows without any light on it: its colour over the one below, and the light that it
/// emits.
fn color_of(graph: &mut Graph, layer: &Layer, below: NodeId) -> NodeId {
    let default = MaterialField::Color.default_value();
    let default = graph.constant(Type::Vec3, &default[..3]);
    let Some(material) = layer.material else { return default };
    let field = |field: MaterialField| material[field.index()];
    let coverage = field(MaterialField::Coverage);
    let own = field(MaterialField::Color);
    let color = match layer.colored {
        Some(colored) if colored != coverage => {
            // default * (1 - colored) + below * (colored - coverage) + own * coverage
            let base = graph.ternary(Ternary::Mix, default, below, colored);
            let change = graph.sub(own, below);
            let coverage = graph.splat(Type::Vec3, coverage);
            let change = graph.mul(change, coverage);
            graph.add(base, change)
        }
        Some(_) | None => graph.ternary(Ternary::Mix, default, own, coverage),
    };
    graph.add(color, field(MaterialField::Emission))
}

/// The signed distance to the edge of a region in pixels, and the change of its field over a pixel.
fn in_pixels(graph: &mut Graph, layer: &Layer, point: NodeId) -> (NodeId, NodeId) {
    let size = graph.point(1, Dim::Two);
    let mut change = graph.component(size, 0);
    if !layer.has_unit_slope {
        let (gradient, _) = best_gradient(graph, layer.distance, point);
        let slope = graph.length(gradient);
        let least = graph.number(LEAST_SLOPE);
        let slope = graph.max(slope, least);
        change = graph.mul(slope, change);
    }
    (graph.div(layer.distance, change), change)
}

/// A colour with isolines over it, given the results of [`in_pixels`]. Lines contrast with the
/// colour below them, and the line around a region with the background.
fn with_isolines(
    graph: &mut Graph,
    [color, background]: [NodeId; 2],
    (distance, change): (NodeId, NodeId),
    spacing: NodeId,
) -> NodeId {
    let [zero, one] = [0.0, 1.0].map(|number| graph.number(number));
    let least = graph.number(LEAST_SPACING);
    let spacing = graph.max(spacing, least);
    let apart = graph.div(spacing, change);
    // The distance to the nearest line, in pixels.
    let lines = graph.div(distance, apart);
    let nearest = graph.unary(Unary::Round, lines);
    let aside = graph.sub(lines, nearest);
    let aside = graph.mul(aside, apart);
    let aside = graph.unary(Unary::Abs, aside);
    let is_edge = graph.binary(Binary::Eq, nearest, zero);
    let line = |graph: &mut Graph, index: usize| {
        let reach = graph.number(0.5 + 0.5 * LINE_WIDTHS[index]);
        let covered = graph.sub(reach, aside);
        let covered = graph.unary(Unary::Saturate, covered);
        let opacity = graph.number(LINE_OPACITIES[index]);
        graph.mul(covered, opacity)
    };
    let (between, edge) = (line(graph, 0), line(graph, 1));
    let least = graph.number(1.0 / LEAST_LINE_SPACING);
    let fade = graph.mul(apart, least);
    let fade = graph.sub(fade, one);
    let fade = graph.unary(Unary::Saturate, fade);
    let between = graph.mul(between, fade);
    let opacity = graph.select(is_edge, edge, between);
    let weights = graph.constant(Type::Vec3, &LUMINANCE);
    let below = graph.select(is_edge, background, color);
    let luminance = graph.dot(below, weights);
    let bright = graph.number(BRIGHT);
    let is_bright = graph.le(bright, luminance);
    let ink = graph.select(is_bright, zero, one);
    let ink = graph.splat(Type::Vec3, ink);
    graph.ternary(Ternary::Mix, color, ink, opacity)
}
