//! Films: surfaces without thickness, where a cut ends flush in the face that it cuts.
//!
//! The difference `max(a, -b)` is 0 where the faces of `a` and `b` coincide, and positive on both
//! sides: a surface without an inside. Rays hit it, each at its own rounding error. Two pockets
//! that touch leave such a film, too, as do solids that touch and are intersected.
//!
//! Along a random line, a film is a minimum of the field that is 0 and not negative. A line that
//! passes an edge has such a minimum with probability 0.

use rustc_hash::FxHashSet;
use sdfc_graph::eval::{FrameValues, evaluate_frame};
use sdfc_graph::{Bounds, Graph, NodeId, Param, Scene, ShapeId};

use crate::refute::frames::axes;
use crate::refute::probe::{Effort, Probe};

/// A shape with a film, although none of its children has one.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// The instance of the shape.
    pub shape: ShapeId,
    /// A point of the film, in the shape's dimension.
    pub at: Vec<f64>,
}

/// Searches the scene's combinations of shapes for films, with the params at their defaults. It
/// takes about `operations` scalar operations at most. Shapes whose arguments depend on a point, and
/// fields that do not expand, are skipped. Films that are small beside the bounds of all children
/// are missed.
pub fn films(scene: &Scene, operations: u64) -> Vec<Film> {
    let graph = &scene.graph;
    let drawn = descendants(graph, scene.root.as_slice());
    let is_combined = |&&id: &&ShapeId| {
        let shape = graph.shape(id);
        let is_alike = |&child: &ShapeId| graph.shape(child).dim == shape.dim;
        shape.level == 0 && shape.children.len() > 1 && shape.children.iter().all(is_alike)
    };
    let mut combined: Vec<ShapeId> = drawn.iter().filter(is_combined).copied().collect();
    // Children come before their parents.
    combined.sort_unstable();
    let children: usize = combined.iter().map(|&id| graph.shape(id).children.len()).sum();
    let effort = Effort(operations / children.max(1) as u64);
    let frame = FrameValues::defaults(&scene.params);
    let mut found: Vec<Film> = Vec::new();
    for shape in combined {
        let below = descendants(graph, &[shape]);
        if found.iter().any(|film| below.contains(&film.shape)) {
            continue;
        }
        if let Some(at) = film(graph, &scene.params, shape, &frame, effort) {
            found.push(Film { shape, at });
        }
    }
    found
}

/// The shapes and all that they are made of.
fn descendants(graph: &Graph, shapes: &[ShapeId]) -> FxHashSet<ShapeId> {
    let mut pending = shapes.to_vec();
    let mut found = FxHashSet::default();
    while let Some(shape) = pending.pop() {
        if found.insert(shape) {
            pending.extend(&graph.shape(shape).children);
        }
    }
    found
}

/// A point of a film of the shape. Lines are drawn where the bounds of the shape and of one child
/// overlap, so that the face of a small cut is not missed.
fn film(
    graph: &Graph,
    params: &[Param],
    shape: ShapeId,
    frame: &FrameValues,
    effort: Effort,
) -> Option<Vec<f64>> {
    let mut extract = graph.extract(&[], &[shape]);
    let shape = extract.shape(shape)?;
    let graph = &mut extract.graph;
    let mut bounds = Bounds::new(params);
    let whole = bounds.of(graph, shape);
    let width = axes(graph.shape(shape).dim);
    graph.shape(shape).children.clone().into_iter().find_map(|child| {
        let part = bounds.of(graph, child);
        let window = overlap(graph, whole, part, frame, width)?;
        Probe::new(graph, shape, window, frame, effort)?.film()
    })
}

/// The box in which two boxes overlap. `None` if they do not.
fn overlap(
    graph: &mut Graph,
    a: [NodeId; 2],
    b: [NodeId; 2],
    frame: &FrameValues,
    width: usize,
) -> Option<[NodeId; 2]> {
    let corners = [graph.max(a[0], b[0]), graph.min(a[1], b[1])];
    let ends = evaluate_frame(graph, &corners, frame);
    let [lo, hi] = [ends.first()?, ends.get(1)?];
    (0..width).all(|axis| lo[axis] <= hi[axis]).then_some(corners)
}
