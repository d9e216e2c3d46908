//! Finds the shape that a point of the surface belongs to.
//!
//! A copy of the scene gives each shape a material whose lanes are the binary digits of the shape's
//! number. Expansion mixes these materials by each shape's weight in the field, as it mixes
//! colours. In a blend of two shapes, every digit in which they differ is nearer to that of the
//! shape with the greater weight, so the digits rounded to 0 or 1 are that shape's number.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::OnceLock;

use sdfc::{FrameValues, Scene};
use sdfc_diagnostics::Sources;
use sdfc_graph::eval::Tape;
use sdfc_graph::{Expander, Graph, MaterialField, MaterialRule, NodeId, ShapeId};

use crate::scene::field_probe::{IsInterrupted, in_parallel};

/// The number of digits that one material holds: the lanes of all its fields except coverage, which
/// is 1.
const DIGITS: u32 = 9;

/// Maps points of the surface to the shapes of a list.
#[derive(Debug)]
pub struct ShapeClassifier {
    /// Each evaluates [`DIGITS`] digits.
    passes: Vec<Tape>,
    /// The shape with number `n` has index `n - 1`.
    shapes: Vec<ShapeId>,
}

impl ShapeClassifier {
    /// Classifies by leaves: shapes written in the scene that contain no other shape written there.
    /// If the scene writes none, shapes without children. The inside of a library shape is not
    /// looked at.
    pub fn leaves(scene: &Scene) -> Self {
        let graph = &scene.graph().graph;
        let children = |shape: ShapeId| &graph.shape(shape).children;
        let written: HashSet<ShapeId> = scene.sites().iter().map(|site| site.shape).collect();
        let mut below: Vec<ShapeId> = scene.report().shapes.iter().map(|it| it.shape).collect();
        // Children have lower ids than their parents.
        below.sort_unstable();
        let mut holding = HashSet::new();
        for shape in below {
            if children(shape).iter().any(|it| written.contains(it) || holding.contains(it)) {
                holding.insert(shape);
            }
        }
        let (mut leaves, mut seen) = (Vec::new(), HashSet::new());
        let mut next: Vec<ShapeId> = scene.graph().root.into_iter().collect();
        while let Some(shape) = next.pop() {
            if !seen.insert(shape) {
                continue;
            }
            let is_leaf = written.contains(&shape) && !holding.contains(&shape);
            if is_leaf || children(shape).is_empty() {
                leaves.push(shape);
            } else {
                next.extend(children(shape));
            }
        }
        Self::of_shapes(scene, leaves)
    }

    /// Classifies by the operands of the hard unions at the root of the scene.
    pub fn operands(scene: &Scene) -> Self {
        let report = scene.report();
        Self::of_shapes(scene, report.analytic.iter().chain(&report.marched).copied().collect())
    }

    /// Classifies by these shapes. A point that belongs to another shape has none. A shape inside
    /// another one of them does not count.
    pub fn of_shapes(scene: &Scene, mut shapes: Vec<ShapeId>) -> Self {
        // Equal shapes are one shape, even if the scene writes them several times.
        shapes.sort_unstable();
        shapes.dedup();
        let bits = u32::BITS - (shapes.len() as u32).leading_zeros();
        let pass = |pass: u32| pass_of(scene, &shapes, pass * DIGITS);
        let passes: Option<Vec<Tape>> = (0..bits.div_ceil(DIGITS)).map(pass).collect();
        // If a pass cannot be expanded, every point maps to `None`.
        Self { passes: passes.unwrap_or_default(), shapes }
    }

    /// The shapes of the list.
    pub fn shapes(&self) -> &[ShapeId] {
        &self.shapes
    }

    /// For each point, relative to the program's origin, the index of its shape in the list.
    pub fn at(
        &self,
        frame: &FrameValues,
        points: &[Option<[f64; 3]>],
        interrupted: IsInterrupted<'_>,
    ) -> Vec<Option<usize>> {
        let mut numbers = vec![0; points.len()];
        for (pass, tape) in self.passes.iter().enumerate() {
            let digits = in_parallel(points, interrupted, || {
                let mut fields = tape.prepare::<f64>(frame);
                move |point: &Option<[f64; 3]>| point.map_or(0, |point| number(fields.eval(point)))
            });
            for (number, digits) in numbers.iter_mut().zip(digits) {
                *number |= digits << (pass as u32 * DIGITS);
            }
        }
        let found = numbers.into_iter().map(|number: usize| number.checked_sub(1));
        found.map(|index| index.filter(|index| *index < self.shapes.len())).collect()
    }
}

/// The names of a scene's shapes, and classifiers that are built on first use.
#[derive(Debug, Default)]
pub struct ShapeIndex {
    labels: HashMap<ShapeId, String>,
    /// Where the scene writes each shape: the name of the file and the range of the call.
    calls: HashMap<ShapeId, (String, Range<usize>)>,
    leaves: OnceLock<ShapeClassifier>,
    operands: OnceLock<ShapeClassifier>,
}

impl ShapeIndex {
    /// Collects the names and source positions at which the scene writes its shapes.
    pub fn new(scene: &Scene, sources: &Sources) -> Self {
        let graph = &scene.graph().graph;
        let label = |site: &sdfc_lang::Site| {
            let at = sources.line_column(site.span.file, site.span.start);
            let file = sources.name(site.span.file);
            let own = graph.shape(site.shape).name.as_ref();
            let name = own.map_or(site.name.clone(), |own| format!("{own} ({})", site.name));
            (site.shape, format!("{name}  {file}:{}:{}", at.line, at.column))
        };
        // The first position wins if equal shapes are written several times.
        let labels = scene.sites().iter().rev().map(label).collect();
        let call = |site: &sdfc_lang::Site| {
            let range = site.span.start as usize..site.span.end as usize;
            (site.shape, (sources.name(site.span.file).to_owned(), range))
        };
        let calls = scene.sites().iter().rev().map(call).collect();
        Self { labels, calls, ..Self::default() }
    }

    /// The name of a shape and its source position; of an unwritten shape, its definition's name.
    pub fn label(&self, scene: &Scene, shape: ShapeId) -> String {
        let definition = || scene.graph().graph.shape(shape).definition.clone();
        self.labels.get(&shape).cloned().unwrap_or_else(definition)
    }

    /// The name of the file that writes a shape, and the range of the call in it.
    pub fn call(&self, shape: ShapeId) -> Option<&(String, Range<usize>)> {
        self.calls.get(&shape)
    }

    /// See [`ShapeClassifier::leaves`].
    pub fn leaves(&self, scene: &Scene) -> &ShapeClassifier {
        self.leaves.get_or_init(|| ShapeClassifier::leaves(scene))
    }

    /// The classifier by leaves if it has been built: building it takes a while.
    pub fn known_leaves(&self) -> Option<&ShapeClassifier> {
        self.leaves.get()
    }

    /// See [`ShapeClassifier::operands`].
    pub fn operands(&self, scene: &Scene) -> &ShapeClassifier {
        self.operands.get_or_init(|| ShapeClassifier::operands(scene))
    }
}

/// The material fields of a scene in which each shape's material holds digits of its number.
fn pass_of(scene: &Scene, shapes: &[ShapeId], from: u32) -> Option<Tape> {
    let root = scene.graph().root?;
    let mut extract = scene.graph().graph.extract(&[], &[root]);
    let root = extract.shape(root)?;
    let layers = scene.graph().layers.iter().filter_map(|layer| extract.shape(*layer));
    let layers: Vec<ShapeId> = layers.collect();
    let numbers: HashMap<ShapeId, usize> = shapes.iter().copied().zip(1..).collect();
    for shape in scene.report().shapes.iter().map(|report| report.shape) {
        let Some(copy) = extract.shape(shape) else { continue };
        let graph = &mut extract.graph;
        let (formula, is_leaf) = (graph.shape(copy).formula, graph.shape(copy).children.is_empty());
        let rule = match numbers.get(&shape) {
            None if !is_leaf => MaterialRule::Weighted(formula),
            None => digits_material(graph, 0),
            Some(number) => digits_material(graph, *number >> from),
        };
        graph.set_material(copy, rule);
    }
    let graph = &mut extract.graph;
    let program = scene.drawn();
    let ty = program.dim().point_type();
    let own = graph.point(0, program.dim());
    let origin = graph.constant(ty, &program.origin[..ty.width()]);
    let point = graph.add(own, origin);
    let mut expander = Expander::new();
    let mut fields = expander.material(graph, root, point).ok()?;
    // Of regions, the topmost one at a point is seen.
    for layer in layers {
        let distance = expander.field(graph, layer, point).ok()?;
        let above = expander.material(graph, layer, point).ok()?;
        let zero = graph.number(0.0);
        let inside = graph.le(distance, zero);
        for (field, above) in fields.iter_mut().zip(above) {
            *field = graph.select(inside, above, *field);
        }
    }
    Tape::new(graph, &fields).ok()
}

/// A material whose lanes are the digits of a number, the lowest first.
fn digits_material(graph: &mut Graph, number: usize) -> MaterialRule {
    let mut digits = (0..DIGITS).map(|digit| (number >> digit & 1) as f64);
    MaterialRule::Explicit(MaterialField::ALL.map(|field| -> NodeId {
        let mut lanes = [0.0; 4];
        for lane in lanes.iter_mut().take(width(field)) {
            *lane = digits.next().unwrap_or(0.0);
        }
        let lanes = if field == MaterialField::Coverage { [1.0; 4] } else { lanes };
        graph.constant(field.ty(), &lanes[..field.ty().width()])
    }))
}

/// The number that a material's lanes hold.
fn number(fields: &[[f64; 4]]) -> usize {
    let lanes = MaterialField::ALL.into_iter().zip(fields);
    let lanes = lanes.flat_map(|(field, lanes)| lanes.iter().take(width(field)));
    lanes.enumerate().map(|(digit, lane)| usize::from(*lane >= 0.5) << digit).sum()
}

/// The number of digits that a material field holds.
fn width(field: MaterialField) -> usize {
    if field == MaterialField::Coverage { 0 } else { field.ty().width() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(text: &str, point: [f64; 3]) -> Option<String> {
        let scene = sdfc::Compiler::new().compile("a", text).unwrap();
        let frame = FrameValues::defaults(scene.params());
        let classifier = ShapeClassifier::leaves(&scene);
        let index = classifier.at(&frame, &[None, Some(point)], &|| false)[1]?;
        Some(scene.graph().graph.shape(classifier.shapes()[index]).definition.clone())
    }

    #[test]
    fn a_point_belongs_to_the_shape_with_the_greater_weight() {
        let blend = "union(sphere(0.5).color(#f00), box(0.8).translate(x: 1), blend: smooth(0.3))\
                     .twist(5deg)";
        assert_eq!(named(blend, [-0.5, 0.0, 0.0]).as_deref(), Some("sphere"));
        assert_eq!(named(blend, [1.4, 0.0, 0.0]).as_deref(), Some("box"));
        // The name that the scene writes, not what the library builds it from.
        let tower = "cylinder(0.5, 1) | sphere(0.4).translate(y: 2)";
        assert_eq!(named(tower, [0.5, 0.0, 0.0]).as_deref(), Some("cylinder"));
        // The surface of a cut belongs to the shape that cuts.
        assert_eq!(named("box(2) - sphere(0.6)", [0.0, 0.0, 0.6]).as_deref(), Some("sphere"));
    }

    #[test]
    fn more_shapes_than_one_material_can_number_are_distinguished() {
        let mut text = String::new();
        for index in 0..600 {
            text += &format!("sphere(0.2{index:03}).translate(x: {index})\n");
        }
        let scene = sdfc::Compiler::new().compile("a", &text).unwrap();
        let frame = FrameValues::defaults(scene.params());
        let classifier = ShapeClassifier::operands(&scene);
        assert_eq!((classifier.passes.len(), classifier.shapes().len()), (2, 600));
        let points: Vec<_> = (0..600).map(|x| Some([f64::from(x), 0.0, 0.0])).collect();
        let mut found: Vec<_> =
            classifier.at(&frame, &points, &|| false).into_iter().flatten().collect();
        found.sort_unstable();
        found.dedup();
        assert_eq!(found.len(), 600);
    }
}
