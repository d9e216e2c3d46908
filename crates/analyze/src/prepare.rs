//! The passes, in order, from a scene to a flat program.

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_graph::{
    Bounds, Dim, ExpandError, Expander, Graph, NodeId, Program, Rays, Scene, Settings, Shadow,
    ShapeId, fold_transforms, gradient, uniforms,
};

use crate::clip::{clip, outermost, through};
use crate::closed::{Open, Parts, around, least, parts};
use crate::cost::{Cost, cost};
use crate::leaves::count_leaves;
use crate::lipschitz::Reason;
use crate::quality::{Qualities, Sides, shapes_below};
use crate::roll::{Rolled, alike, roll, visits, within};
use crate::sound::{Uncertified, sound_field};
use crate::spans::{Known, first, joined};
use crate::uneven::{Uneven, inexact_outside, uneven};

/// A scene ready for code generation, and what was found on the way.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// Flat math.
    pub program: Program,
    /// What was modelled and why.
    pub report: Report,
}

/// How a field of many parts is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Writing {
    /// As costs less: [`Writing::Rolled`] where the field takes more operations than [`Report::most_inline`] says.
    #[default]
    Auto,
    /// All that there is, one operation after the other.
    Inline,
    /// Parts that are equal up to constants as loops over lists, where there are such.
    Rolled,
}

/// More operations of a field take longer to compile and to evaluate than loops that visit what matters: of a scene all of whose rays come
/// from the eye, of one whose rays to lamps and mirrored rays go by lists for cells, and of one with soft shadows, which visit all rounds.
const MOST_INLINE: [usize; 3] = [425, 1200, 4500];
/// So many more for each loop, which is compiled too, and entered at each place.
const MORE_FOR_A_LOOP: [usize; 3] = [125, 250, 0];
/// The same where loops visit all rounds.
const MOST_WITHOUT_LISTS: usize = 4500;

/// How many operations a field may take that is written out though so many loops with lists could stand in its place.
fn most_inline(settings: &Settings, loops: usize) -> usize {
    if loops == 0 {
        return MOST_WITHOUT_LISTS;
    }
    let kind = if settings.lights.iter().any(|light| matches!(light.shadow, Shadow::Soft(_))) {
        2
    } else {
        usize::from(leave_the_eye(settings))
    };
    MOST_INLINE[kind] + loops * MORE_FOR_A_LOOP[kind]
}

/// Whether loops cost less, and up to how many operations they do not. `steepest` is as for [`visits`].
fn loops_pay(
    graph: &Graph,
    distance: NodeId,
    settings: &Settings,
    steepest: Option<f64>,
) -> (bool, usize) {
    let operations = cost(graph, &[distance]).operations;
    let least = most_inline(settings, 1);
    if operations <= least || operations > MOST_WITHOUT_LISTS {
        return (operations > least, least);
    }
    let mut trial = graph.clone();
    let folded = fold_transforms(&mut trial, &[distance]).roots;
    let rolled = roll(&mut trial, &folded).0;
    let most = most_inline(settings, visits(&mut trial, &rolled, steepest).len());
    (operations > most, most)
}

/// Whether the field is asked for elsewhere than on rays from the eye.
fn leave_the_eye(settings: &Settings) -> bool {
    let shaded = settings.lights.iter().any(|light| light.shadow != Shadow::Off);
    let mirrored = settings.reflections.is_some_and(|mirrors| mirrors.count > 0);
    shaded || mirrored || settings.occlusion.is_some()
}

/// Rays are clipped to a box around no more operands than this: their bounds take longer to derive than the box saves.
const MOST_CLIPPED: usize = 256;
/// What is left to march is known near a place by no more intervals than this: each costs as much as a distance.
const MOST_COPIES: usize = 64;
/// Of no more operands than this each has a box of its own.
const MOST_BOXES: usize = 16;

/// What was modelled and why.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// What became loops; empty where all is written out.
    pub rolled: Vec<Rolled>,
    /// Up to how many operations the field would have been written out.
    pub most_inline: usize,
    /// Leaf shapes evaluated per field evaluation: childless instances at distinct points.
    pub leaves: usize,
    /// Cost of the distance alone.
    pub distance: Cost,
    /// Cost of the gradient, what it shares with the distance included.
    pub gradient: Cost,
    /// Cost of what a ray is asked before it is marched.
    pub ray: Cost,
    /// Cost of the distance to what is left to march.
    pub marched: Cost,
    /// What rays meet without marching.
    pub closed: Vec<ShapeId>,
    /// What is left to march.
    pub open: Vec<ShapeId>,
    /// Every shape of the scene, children before parents.
    pub shapes: Vec<ShapeReport>,
    /// Parts that no Lipschitz constant covers; empty for a certified scene.
    pub uncertified: Vec<Uncertified>,
    /// Operators that want an exact distance and have none.
    pub uneven: Vec<Uneven>,
    /// Where the scene's field stops being the distance outside; `None` where it is that everywhere.
    pub inexact_outside: Option<ShapeId>,
}

impl Report {
    /// Operations that a ray takes on average, by a method that looks ahead or not, from the mean of evaluations, of which
    /// looking ahead is one.
    pub fn operations(&self, evaluations: f64, looks_ahead: bool) -> f64 {
        if looks_ahead && self.ray.operations > 0 {
            let steps = (evaluations - 1.0).max(0.0);
            return self.ray.operations as f64 + steps * self.marched.operations as f64;
        }
        evaluations * self.distance.operations as f64
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
    pub found: bool,
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
    prepare_about(scene, [0.0; 3], Writing::Auto)
}

/// As [`prepare`], with the flat math's point counted from a place in the scene. Where a solid is moved to, less that
/// place, is computed in f64 here, so that near the place little is left for f32 to round.
///
/// # Errors
///
/// As [`prepare`].
pub fn prepare_about(
    scene: &Scene,
    origin: [f64; 3],
    writing: Writing,
) -> Result<Prepared, ExpandError> {
    let mut program = Program {
        origin,
        graph: scene.graph.clone(),
        params: scene.params.clone(),
        settings: scene.settings.clone(),
        ..Program::default()
    };
    let report = match scene.root {
        Some(root) => flatten(&mut program, root, scene.painted, writing)?,
        None => Report::default(),
    };
    program.uniforms = uniforms(&program.graph, &program.roots());
    Ok(Prepared { program, report })
}

fn flatten(
    program: &mut Program,
    root: ShapeId,
    painted: bool,
    writing: Writing,
) -> Result<Report, ExpandError> {
    let params = program.params.clone();
    let graph = &mut program.graph;
    let mut expander = Expander::new();
    let own_point = graph.point(0, Dim::Three);
    let origin = graph.constant(Dim::Three.point_type(), &program.origin);
    let point = graph.add(own_point, origin);
    let qualities = Qualities::of_scene(graph, root, &params);
    let field = sound_field(graph, &mut expander, &qualities, root, point)?;
    let leaves = count_leaves(graph, &mut expander, root, point)?;
    let mut bounds = Bounds::new(&params);
    let mut apart = parts(graph, &mut expander, &qualities, &mut bounds, root, point)?;
    let steepest = qualities.get(root).and_then(|quality| {
        let constant = quality.lipschitz.as_ref().ok()?;
        Some(graph.as_number(*constant).unwrap_or(f64::INFINITY))
    });
    let steepest = steepest.filter(|_| field.uncertified.is_empty());
    let (pays, most_inline) = loops_pay(graph, field.distance, &program.settings, steepest);
    let rolls = match writing {
        Writing::Auto => pays,
        Writing::Inline => false,
        Writing::Rolled => true,
    };
    if rolls {
        // What a list holds is met by marching: all of it met in closed form would be asked of each ray.
        let values: Vec<NodeId> = apart.closed.iter().map(|part| part.value).collect();
        let mut many = alike(graph, &values).concat();
        many.sort_unstable();
        apart.march(&many);
    }
    let mut flat = vec![field.distance];
    if !apart.closed.is_empty() {
        flat.extend(least(graph, apart.closed.iter().map(|part| part.value)));
        flat.extend(least(graph, apart.open.iter().map(|part| part.value)));
    }
    let fields = flat.len();
    if painted {
        flat.extend(expander.material(graph, root, point)?);
    }
    let folded = fold_transforms(graph, &flat);
    program.names = folded.names(graph, &expander.names());
    let (fields, material) = folded.roots.split_at(fields);
    let (fields, rolled) = if rolls { roll(graph, fields) } else { (fields.to_vec(), Vec::new()) };
    let Some(&distance) = fields.first() else { return Ok(Report::default()) };
    program.distance = Some(distance);
    program.material = material.try_into().ok();
    program.gradient = Some(gradient(graph, distance, own_point));
    program.visits = visits(graph, &fields, steepest);
    if !program.visits.is_empty() && leave_the_eye(&program.settings) {
        program.within = within(graph, &mut bounds, root);
    }
    if rolls {
        // One round's copies would be all rounds'.
        apart.open.iter_mut().for_each(|part| part.near = None);
    }
    let asked = asked_of_rays(graph, &mut expander, &mut bounds, &apart)?;
    program.rays = rays(&apart, &fields, asked);
    let Rays { hits, marched, clip, copies, .. } = program.rays;
    let asked: Vec<NodeId> = hits.into_iter().chain(clip).collect();
    Ok(Report {
        rolled,
        most_inline,
        leaves,
        distance: cost(graph, &[distance]),
        gradient: cost(graph, program.gradient.as_slice()),
        ray: cost(graph, &asked),
        marched: cost(graph, copies.or(marched).as_slice()),
        closed: apart.closed.iter().map(|part| part.shape).collect(),
        open: apart.open.iter().map(|part| part.shape).collect(),
        shapes: shape_reports(graph, &qualities, root, &field.divided),
        uncertified: field.uncertified,
        uneven: uneven(graph, &qualities, root),
        inexact_outside: inexact_outside(graph, &qualities, root),
    })
}

/// What a ray is asked before it is marched.
#[derive(Clone, Copy, Debug, Default)]
struct Asked {
    hits: Option<NodeId>,
    clip: Option<NodeId>,
    copies: Option<NodeId>,
}

/// The first hit of what is closed, the way through the bounds of what is left, and what of that is known near a place.
fn asked_of_rays(
    graph: &mut Graph,
    expander: &mut Expander,
    bounds: &mut Bounds,
    apart: &Parts,
) -> Result<Asked, ExpandError> {
    let spans: Vec<_> =
        apart.closed.iter().flat_map(|part| part.known.spans.iter().copied()).collect();
    let mut roots = Vec::new();
    if !spans.is_empty() {
        roots.push(first(graph, &spans));
    }
    let hits = roots.len();
    let ray = [0, 1].map(|level| graph.point(level, Dim::Three));
    let boxes = boxes(graph, expander, bounds, &apart.open, ray)?;
    let ways: Option<Vec<_>> = boxes.into_iter().map(|ends| clip(graph, ray, ends)).collect();
    if let Some(ends) = ways.and_then(|ways| through(graph, &ways)) {
        roots.push(graph.compose(&ends));
    }
    let clips = roots.len();
    roots.extend(near(graph, &apart.open));
    let folded = fold_transforms(graph, &roots).roots;
    let [hits, clip, copies] = [&folded[..hits], &folded[hits..clips], &folded[clips..]];
    let [hits, clip, copies] = [hits, clip, copies].map(|root| root.first().copied());
    Ok(Asked { hits, clip, copies })
}

/// Where a ray first meets what is left, and how far that is known from the ray's origin; `None` where that is not known of all.
fn near(graph: &mut Graph, open: &[Open]) -> Option<NodeId> {
    let known = open.iter().map(|part| part.near.clone()).collect::<Option<Vec<Known>>>()?;
    let known = joined(graph, known);
    let reach = known.reach.filter(|_| known.spans.len() <= MOST_COPIES)?;
    let met = first(graph, &known.spans);
    Some(graph.compose(&[met, reach]))
}

/// Corners of boxes that hold what is left to march.
fn boxes(
    graph: &mut Graph,
    expander: &mut Expander,
    bounds: &mut Bounds,
    open: &[Open],
    ray: [NodeId; 2],
) -> Result<Vec<[NodeId; 2]>, ExpandError> {
    let size = match open.len() {
        0..=MOST_BOXES => 1,
        many if many <= MOST_CLIPPED => many,
        _ => return Ok(Vec::new()),
    };
    let mut boxes = Vec::with_capacity(open.len() / size);
    for group in open.chunks(size) {
        let Some(shape) = around(graph, group) else { continue };
        let [lo, hi] = bounds.of(graph, shape);
        boxes.push([expander.node(graph, lo, &ray)?, expander.node(graph, hi, &ray)?]);
    }
    Ok(outermost(graph, &boxes))
}

/// The functions of rays, from the fields of the whole, of what is closed and of what is left, as far as there are such.
fn rays(apart: &Parts, fields: &[NodeId], asked: Asked) -> Rays {
    let Asked { hits, clip, copies } = asked;
    let (whole, parts) = (fields.first().copied(), fields.get(1..).unwrap_or_default());
    match (apart.closed.is_empty(), apart.open.is_empty()) {
        (true, _) => Rays { hits, closed: None, marched: whole, clip, copies },
        (false, is_all) => {
            let marched = parts.get(1).copied().filter(|_| !is_all);
            Rays { hits, closed: parts.first().copied(), marched, clip, copies }
        }
    }
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
        let found = quality.within.is_some();
        let sides = quality.sides;
        shapes.push(ShapeReport { shape, sides, lipschitz, divided, found, jump });
    }
    shapes
}
