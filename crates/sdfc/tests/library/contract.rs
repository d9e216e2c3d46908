//! Checks the contract of one entry with its example and with variants of it.

use std::collections::BTreeMap;

use sdfc_analyze::Qualities;
use sdfc_diagnostics::{Sources, has_errors};
use sdfc_graph::{Scene, ShapeId};
use sdfc_lang::{front, library::Entry};

use crate::claims::{Claims, PROMISES, SIDES, Stated, says};
use crate::field::Field;
use crate::geometry::Random;
use crate::samples::Samples;
use crate::{mutants, rays, variants};

/// Scenes with other numbers: the least number that is checked, and the largest number that is
/// tried. More than the least number are checked until every mutant is refuted.
const VARIANTS: usize = 12;
/// The same for a field of many scalar operations, such as a text: a scene of it takes seconds.
const FEW_VARIANTS: usize = 3;
const MANY_OPERATIONS: usize = 300;
const TRIES: usize = 400;

/// The outcome of a check.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Number of checked scenes; the example itself is the first.
    pub scenes: usize,
    /// The promises of the example, outside and inside.
    pub sides: [String; 2],
    /// The constant of the example, and the steepest slope found in it.
    pub lipschitz: Option<f64>,
    pub steepest: f64,
    /// True if bounds are stated.
    pub bounds: bool,
    /// The mutants, each with true if some scene refuted it.
    pub mutants: BTreeMap<String, bool>,
}

/// Checks all claims about the entry's shapes.
///
/// # Errors
///
/// A claim that samples refute, or a mutant that they do not refute.
pub fn check(entry: &Entry) -> Result<Outcome, String> {
    let mut outcome = Outcome::default();
    let scene = scene(&entry.example).ok_or("the example does not compile")?;
    if !of_entry(&scene, entry).any(|_| true) {
        return Err("the example contains no shape that this entry makes".into());
    }
    // All shapes of the example are checked, but of the variants only those of the entry.
    for id in scene.graph.shape_ids() {
        one(entry, &scene, id, &entry.example, &mut outcome)?;
    }
    outcome.scenes = 1;
    let variants = if is_costly(&scene) { FEW_VARIANTS } else { VARIANTS };
    let mut random = Random(1);
    for _ in 0..TRIES {
        if outcome.scenes > variants && missing(entry, &outcome).is_none() {
            break;
        }
        let text = variants::changed(&entry.example, &mut random);
        let Some(scene) = self::scene(&text) else { continue };
        for id in of_entry(&scene, entry) {
            one(entry, &scene, id, &text, &mut outcome)?;
        }
        outcome.scenes += 1;
    }
    missing(entry, &outcome).map_or(Ok(outcome), Err)
}

fn is_costly(scene: &Scene) -> bool {
    let cost = sdfc_analyze::cost_of_shapes(&scene.graph, scene.root.as_slice());
    cost.is_some_and(|cost| cost.operations > MANY_OPERATIONS)
}

/// Returns a mutant that no scene refutes, or a condition that holds in every scene.
fn missing(entry: &Entry, outcome: &Outcome) -> Option<String> {
    let missed: Vec<&String> = outcome.mutants.iter().filter(|it| !it.1).map(|it| it.0).collect();
    let missed = (!missed.is_empty()).then(|| {
        format!(
            "no sample refutes these stronger promises: {missed:?}; state them, or use an example \
             in which they are false"
        )
    });
    missed.or_else(|| condition_unseen(entry, outcome))
}

/// Checks all shapes of a scene that is not the example of an entry.
///
/// # Errors
///
/// A claim that samples refute.
pub fn check_scene(text: &str) -> Result<(), String> {
    let scene = scene(text).ok_or("it does not compile")?;
    let entry = Entry::default();
    for id in scene.graph.shape_ids() {
        one(&entry, &scene, id, text, &mut Outcome::default())?;
    }
    Ok(())
}

/// Returns the scene, if it has no errors.
pub fn scene(text: &str) -> Option<Scene> {
    let mut sources = Sources::new();
    let file = sources.add("scene.sdf", text);
    let (elaborated, found) = front(&mut sources, file);
    elaborated.filter(|_| !has_errors(&found)).map(|it| it.scene)
}

fn of_entry<'s>(scene: &'s Scene, entry: &'s Entry) -> impl Iterator<Item = ShapeId> + 's {
    scene.graph.shape_ids().filter(|&id| is_of(scene, entry, id))
}

fn is_of(scene: &Scene, entry: &Entry, id: ShapeId) -> bool {
    let shape = scene.graph.shape(id);
    let dim = if shape.dim == sdfc_graph::Dim::Two { "region" } else { "solid" };
    let kind = entry.kind == "shape" || entry.kind == dim;
    shape.definition == entry.name && kind && shape.level == 0
}

fn one(
    entry: &Entry,
    scene: &Scene,
    id: ShapeId,
    text: &str,
    outcome: &mut Outcome,
) -> Result<(), String> {
    let shape = scene.graph.shape(id);
    // A shape that is rebuilt at each point makes no promise by itself.
    if shape.level > 0 {
        return Ok(());
    }
    let Some(field) = Field::new(scene, id) else { return Ok(()) };
    let mut graph = scene.graph.clone();
    let qualities = Qualities::of_scene(&mut graph, id, &scene.params);
    let error = |what: String| format!("`{}` in {text}: {what}", shape.definition);
    let samples = Samples::of(&field).map_err(&error)?;
    let clauses = if is_of(scene, entry, id) { &*entry.clauses } else { &[] };
    let stated = Stated::of(scene, &graph, &qualities, id, &field, clauses);
    let derived = Claims::derived(&graph, &qualities, id, &field);
    for claims in [&stated.claims(), &derived] {
        if let Some(refuted) = claims.refuted_by(&samples) {
            return Err(error(refuted));
        }
    }
    if let Some(fault) = rays::fault(scene, id) {
        return Err(error(fault));
    }
    if let Some(fault) = rays::copies_fault(scene, id, 1.0) {
        return Err(error(fault));
    }
    if !is_of(scene, entry, id) {
        return Ok(());
    }
    if scene.graph.shape(id).contract.copies {
        let caught = outcome.mutants.entry(rays::FARTHER.to_owned()).or_default();
        *caught |= rays::copies_fault(scene, id, 1.25).is_some();
    }
    if outcome.scenes == 0 {
        outcome.sides = derived.sides.map(|promise| promise.to_string());
        outcome.lipschitz = derived.lipschitz;
        outcome.steepest = outcome.steepest.max(samples.steepest.slope);
        outcome.bounds = stated.bounds.is_some();
    }
    for mutant in mutants::of(&stated, &derived, field.axes) {
        let caught = outcome.mutants.entry(mutant.label).or_default();
        *caught |= mutant.claims.refuted_by(&samples).is_some();
    }
    Ok(())
}

/// Returns a mutant without its condition that would be true in all variants.
fn condition_unseen(entry: &Entry, outcome: &Outcome) -> Option<String> {
    let conditional: Vec<String> =
        entry.clauses.iter().filter(|clause| clause.contains(" if ")).cloned().collect();
    let all = PROMISES.into_iter().flat_map(|promise| SIDES.map(|side| (promise, side)));
    let mut labels = all
        .filter(|(promise, side)| says(&conditional, *promise, side))
        .map(|(promise, side)| mutants::without_condition(promise, side));
    let unseen = labels.find(|label| !outcome.mutants.contains_key(label))?;
    Some(format!(
        "`{unseen}` is true in all variants of the example; use one in which the condition is false"
    ))
}
