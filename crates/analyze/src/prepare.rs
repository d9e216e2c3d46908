//! The passes, in order, from a scene to a flat program.

use rustc_hash::FxHashSet;
use sdfc_graph::{
    Dim, ExpandError, Expander, Graph, NodeId, Program, Scene, ShapeId, fold_transforms, gradient,
    uniforms,
};

use crate::cost::{Cost, cost};
use crate::leaves::count_leaves;
use crate::quality::{Qualities, Sides, shapes_below};
use crate::sound::{Uncertified, sound_field};
use crate::uneven::{Uneven, uneven};

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
    /// Leaf shapes evaluated per field evaluation: childless instances at distinct points.
    pub leaves: usize,
    /// Cost of the distance alone.
    pub distance: Cost,
    /// Cost of the gradient, what it shares with the distance included.
    pub gradient: Cost,
    /// Every shape of the scene, children before parents.
    pub shapes: Vec<ShapeReport>,
    /// Parts that no Lipschitz constant covers; empty for a certified scene.
    pub uncertified: Vec<Uncertified>,
    /// Operators that want an exact distance and have none.
    pub uneven: Vec<Uneven>,
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
    let mut program = Program {
        graph: scene.graph.clone(),
        params: scene.params.clone(),
        settings: scene.settings.clone(),
        ..Program::default()
    };
    let report = match scene.root {
        Some(root) => flatten(&mut program, root, scene.painted)?,
        None => Report::default(),
    };
    let roots = roots(&program);
    program.uniforms = uniforms(&program.graph, &roots);
    Ok(Prepared { program, report })
}

fn flatten(program: &mut Program, root: ShapeId, painted: bool) -> Result<Report, ExpandError> {
    let graph = &mut program.graph;
    let mut expander = Expander::new();
    let point = graph.point(0, Dim::Three);
    let qualities = Qualities::of_scene(graph, root);
    let field = sound_field(graph, &mut expander, &qualities, root, point)?;
    let leaves = count_leaves(graph, &mut expander, root, point)?;
    let mut flat = vec![field.distance];
    if painted {
        flat.extend(expander.material(graph, root, point)?);
    }
    let folded = fold_transforms(graph, &flat);
    program.names = folded.names(graph, &expander.names());
    let [distance, material @ ..] = &folded.roots[..] else { return Ok(Report::default()) };
    let distance = *distance;
    program.distance = Some(distance);
    program.material = material.try_into().ok();
    program.gradient = Some(gradient(graph, distance, point));
    Ok(Report {
        leaves,
        distance: cost(graph, &[distance]),
        gradient: cost(graph, program.gradient.as_slice()),
        shapes: shape_reports(graph, &qualities, root, &field.divided),
        uncertified: field.uncertified,
        uneven: uneven(graph, &qualities, root),
    })
}

/// Everything that a shader of the program computes at its points, and the settings.
fn roots(program: &Program) -> Vec<NodeId> {
    let field = program.distance.into_iter().chain(program.gradient);
    let material = program.material.into_iter().flatten();
    field.chain(material).collect()
}

fn shape_reports(
    graph: &Graph,
    qualities: &Qualities,
    root: ShapeId,
    divided: &[ShapeId],
) -> Vec<ShapeReport> {
    let divided: FxHashSet<ShapeId> = divided.iter().copied().collect();
    let mut shapes = Vec::new();
    for shape in shapes_below(graph, root) {
        let Some(quality) = qualities.get(shape) else { continue };
        let lipschitz = match &quality.lipschitz {
            Ok(node) => graph.as_number(*node).map_or(Lipschitz::PerFrame, Lipschitz::Number),
            Err(reason) => Lipschitz::Unknown(reason.to_string()),
        };
        let divided = divided.contains(&shape);
        shapes.push(ShapeReport { shape, sides: quality.sides, lipschitz, divided });
    }
    shapes
}
