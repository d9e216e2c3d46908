//! Which shape a place on the surface belongs to.
//!
//! The scene is painted anew, a shape with the binary digits of its number as its material, and expanded as any scene's
//! material is: by the shares that shapes have in the field. Where two of them blend, each digit in which they
//! differ goes to the one with the greater share, so that digits rounded to 0 or 1 are again the number of one.

use std::collections::{HashMap, HashSet};
use std::sync::OnceLock;

use sdfc::analyze::Promise;
use sdfc::diagnostics::Sources;
use sdfc::graph::eval::Tape;
use sdfc::graph::{Dim, Expander, Graph, MaterialField, MaterialRule, NodeId, ShapeId};
use sdfc::{FrameValues, Scene};

use crate::probe::in_parallel;

/// Digits of a number that one material holds: coverage is 1 throughout.
const DIGITS: u32 = 9;

/// Tells the shapes of a list apart.
#[derive(Debug)]
pub struct Identity {
    /// Each tells some digits.
    passes: Vec<Tape>,
    /// By number, from 1.
    shapes: Vec<ShapeId>,
}

impl Identity {
    /// Of the shapes that the scene writes and within which it writes no other; where it writes none, of those that
    /// sample no other. What a shape of the library is made of is not the scene's.
    pub fn of_leaves(scene: &Scene) -> Self {
        let graph = &scene.graph().graph;
        let children = |shape: ShapeId| &graph.shape(shape).children;
        let written: HashSet<ShapeId> = scene.sites().iter().map(|site| site.shape).collect();
        let mut below: Vec<ShapeId> = scene.report().shapes.iter().map(|it| it.shape).collect();
        // What a shape samples was made before it.
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
        Self::of(scene, leaves)
    }

    /// Of the operands of the unions that the scene is, as far as those are nothing but the nearest of several.
    pub fn of_parts(scene: &Scene) -> Self {
        let report = scene.report();
        Self::of(scene, report.analytic.iter().chain(&report.marched).copied().collect())
    }

    fn of(scene: &Scene, mut shapes: Vec<ShapeId>) -> Self {
        // Equal shapes at several places are one.
        shapes.sort_unstable();
        shapes.dedup();
        let bits = u32::BITS - (shapes.len() as u32).leading_zeros();
        let pass = |pass: u32| pass_of(scene, &shapes, pass * DIGITS);
        let passes: Option<Vec<Tape>> = (0..bits.div_ceil(DIGITS)).map(pass).collect();
        // What cannot be expanded belongs to nothing.
        Self { passes: passes.unwrap_or_default(), shapes }
    }

    /// The shapes.
    pub fn shapes(&self) -> &[ShapeId] {
        &self.shapes
    }

    /// Of points, counted from the program's origin, the places of their shapes in the list.
    pub fn at(&self, frame: &FrameValues, points: &[Option<[f64; 3]>]) -> Vec<Option<usize>> {
        let mut numbers = vec![0; points.len()];
        for (pass, tape) in self.passes.iter().enumerate() {
            let digits = in_parallel(points, || {
                let mut fields = tape.prepare::<f64>(frame);
                move |point: &Option<[f64; 3]>| point.map_or(0, |point| number(fields.eval(point)))
            });
            for (number, digits) in numbers.iter_mut().zip(digits) {
                *number |= digits << (pass as u32 * DIGITS);
            }
        }
        let found = numbers.into_iter().map(|number: usize| number.checked_sub(1));
        found.map(|place| place.filter(|place| *place < self.shapes.len())).collect()
    }
}

/// The shapes of a scene by name; told apart when that is first asked for.
#[derive(Debug, Default)]
pub struct Shapes {
    labels: HashMap<ShapeId, String>,
    leaves: OnceLock<Identity>,
    parts: OnceLock<Identity>,
}

impl Shapes {
    /// Named as the scene calls them, and where it does.
    pub fn new(scene: &Scene, sources: &Sources) -> Self {
        let graph = &scene.graph().graph;
        let label = |site: &sdfc::lang::Site| {
            let place = sources.line_column(site.span.file, site.span.start);
            let file = sources.name(site.span.file);
            let own = graph.shape(site.shape).name.as_ref();
            let name = own.map_or(site.name.clone(), |own| format!("{own} ({})", site.name));
            (site.shape, format!("{name}  {file}:{}:{}", place.line, place.column))
        };
        // Of equal shapes the first that is written.
        let labels = scene.sites().iter().rev().map(label).collect();
        Self { labels, ..Self::default() }
    }

    /// What a shape is called, and where it is written.
    pub fn label(&self, scene: &Scene, shape: ShapeId) -> String {
        let definition = || scene.graph().graph.shape(shape).definition.clone();
        self.labels.get(&shape).cloned().unwrap_or_else(definition)
    }

    /// See [`Identity::of_leaves`].
    pub fn leaves(&self, scene: &Scene) -> &Identity {
        self.leaves.get_or_init(|| Identity::of_leaves(scene))
    }

    /// The same where it has been asked for before: finding out takes a while.
    pub fn known_leaves(&self) -> Option<&Identity> {
        self.leaves.get()
    }

    /// See [`Identity::of_parts`].
    pub fn parts(&self, scene: &Scene) -> &Identity {
        self.parts.get_or_init(|| Identity::of_parts(scene))
    }
}

/// What the field of a part promises outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quality {
    /// It is the distance.
    Exact,
    /// It never exceeds the distance.
    Bound,
    /// It, or some of it, is divided by a constant so that it never does.
    Scaled,
    /// Nothing is known to keep it from exceeding the distance.
    Uncertified,
}

impl Quality {
    /// Of a part and all below it.
    pub fn of(scene: &Scene, part: ShapeId) -> Self {
        let (report, graph) = (scene.report(), &scene.graph().graph);
        let (mut below, mut next) = (HashSet::from([part]), vec![part]);
        while let Some(shape) = next.pop() {
            next.extend(graph.shape(shape).children.iter().filter(|child| below.insert(**child)));
        }
        let of = |shape: ShapeId| report.shapes.iter().find(move |it| it.shape == shape);
        let divided = report.shapes.iter().any(|it| it.divided && below.contains(&it.shape));
        if report.uncertified.iter().any(|found| below.contains(&found.shape)) {
            Self::Uncertified
        } else if divided {
            Self::Scaled
        } else if of(part).is_some_and(|it| it.sides.outside == Promise::Exact) {
            Self::Exact
        } else {
            Self::Bound
        }
    }
}

/// The material fields of a scene in which each shape of a list is painted with digits of its number.
fn pass_of(scene: &Scene, shapes: &[ShapeId], from: u32) -> Option<Tape> {
    let mut graph = scene.graph().graph.clone();
    let root = scene.graph().root?;
    let numbers: HashMap<ShapeId, usize> = shapes.iter().copied().zip(1..).collect();
    for shape in scene.report().shapes.iter().map(|report| report.shape) {
        let (formula, is_leaf) =
            (graph.shape(shape).formula, graph.shape(shape).children.is_empty());
        let rule = match numbers.get(&shape) {
            None if !is_leaf => MaterialRule::Weighted(formula),
            None => painted(&mut graph, 0),
            Some(number) => painted(&mut graph, *number >> from),
        };
        graph.set_material(shape, rule);
    }
    let own = graph.point(0, Dim::Three);
    let origin = graph.constant(Dim::Three.point_type(), &scene.drawn().origin);
    let point = graph.add(own, origin);
    let fields = Expander::new().material(&mut graph, root, point).ok()?;
    Tape::new(&graph, &fields).ok()
}

/// A material of digits, the lowest first.
fn painted(graph: &mut Graph, number: usize) -> MaterialRule {
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

/// The number in a material's fields.
fn number(fields: &[[f64; 4]]) -> usize {
    let lanes = MaterialField::ALL.into_iter().zip(fields);
    let lanes = lanes.flat_map(|(field, lanes)| lanes.iter().take(width(field)));
    lanes.enumerate().map(|(digit, lane)| usize::from(*lane >= 0.5) << digit).sum()
}

/// How many digits a field holds.
fn width(field: MaterialField) -> usize {
    if field == MaterialField::Coverage { 0 } else { field.ty().width() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(text: &str, point: [f64; 3]) -> Option<String> {
        let scene = sdfc::compile("a", text).scene.unwrap();
        let frame = FrameValues::defaults(scene.params());
        let identity = Identity::of_leaves(&scene);
        let place = identity.at(&frame, &[None, Some(point)])[1]?;
        Some(scene.graph().graph.shape(identity.shapes()[place]).definition.clone())
    }

    #[test]
    fn a_place_belongs_to_the_shape_with_the_greater_share() {
        let blend = "union(sphere(0.5).color(#f00), box(0.8).translate(x: 1), blend: smooth(0.3)).twist(5deg)";
        assert_eq!(named(blend, [-0.5, 0.0, 0.0]).as_deref(), Some("sphere"));
        assert_eq!(named(blend, [1.4, 0.0, 0.0]).as_deref(), Some("box"));
        // As the scene calls it, not what it is made of.
        let tower = "cylinder(0.5, 1) | sphere(0.4).translate(y: 2)";
        assert_eq!(named(tower, [0.5, 0.0, 0.0]).as_deref(), Some("cylinder"));
        // What cuts shows in the cut.
        assert_eq!(named("box(2) - sphere(0.6)", [0.0, 0.0, 0.6]).as_deref(), Some("sphere"));
    }

    #[test]
    fn numbers_beyond_one_material_are_told_apart() {
        let mut text = String::new();
        for place in 0..600 {
            text += &format!("sphere(0.2{place:03}).translate(x: {place})\n");
        }
        let scene = sdfc::compile("a", &text).scene.unwrap();
        let frame = FrameValues::defaults(scene.params());
        let identity = Identity::of_parts(&scene);
        assert_eq!((identity.passes.len(), identity.shapes().len()), (2, 600));
        let points: Vec<_> = (0..600).map(|place| Some([f64::from(place), 0.0, 0.0])).collect();
        let mut found: Vec<_> = identity.at(&frame, &points).into_iter().flatten().collect();
        found.sort_unstable();
        found.dedup();
        assert_eq!(found.len(), 600);
    }
}
