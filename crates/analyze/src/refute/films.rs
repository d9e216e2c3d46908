//! Films: surfaces without thickness, where a cut ends flush in the face that it cuts, or where a
//! formula is 0 and negative nowhere near.
//!
//! The difference `max(a, -b)` is 0 where the faces of `a` and `b` coincide, and positive on both
//! sides: a surface without an inside. Rays hit it, each at its own rounding error. Two pockets
//! that touch leave such a film, too, as do solids that touch and are intersected.
//!
//! Along a random line, a film is a minimum of the field that is 0 and not negative. A line that
//! passes an edge has such a minimum with probability 0.

use rustc_hash::FxHashSet;
use sdfc_graph::eval::FrameValues;
use sdfc_graph::{Binary, Bounds, Graph, Node, NodeId, Scene, ShapeId, reachable_where};

use crate::refute::probe::Probe;
use crate::refute::sampling::{Effort, corners_at};

/// Number of lines for each child of a shape.
const LINES: usize = 32;
/// Evaluations that take about as long as making a tape.
const PREPARATION: u64 = 50;

/// A shape with a film, although none of its children has one, if it has children.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// The instance of the shape.
    pub shape: ShapeId,
    /// A point of the film, in the shape's dimension.
    pub at: Vec<f64>,
}

/// Searches the scene's combinations of shapes, and its own formulas, for films, with the params at
/// their defaults. `is_own` tells whether the scene declares a definition. It takes about
/// `operations` scalar operations at most, for one shape after the other, children first. Shapes
/// whose arguments depend on a point, and fields that do not expand, are skipped. Films that are
/// small beside the bounds of the shape and of all children are missed.
pub fn films(scene: &Scene, is_own: &dyn Fn(&str) -> bool, operations: u64) -> Vec<Film> {
    let Some(root) = scene.root else { return Vec::new() };
    let mut extract = scene.graph.extract(&[], &[root]);
    let mut bounds = Bounds::new(&scene.params);
    let frame = FrameValues::defaults(&scene.params);
    let mut left = operations;
    let mut marred = FxHashSet::default();
    let mut found = Vec::new();
    for shape in scene.graph.shape_ids() {
        // Only shapes that are drawn are in the extract.
        let Some(copy) = extract.shape(shape) else { continue };
        let children = &scene.graph.shape(shape).children;
        if children.iter().any(|child| marred.contains(child)) {
            marred.insert(shape);
        } else if left > 0
            && (may_leave_film(&scene.graph, shape) || is_formula(&scene.graph, shape, is_own))
            && let Some(at) = film(&mut extract.graph, &mut bounds, copy, &frame, &mut left)
        {
            marred.insert(shape);
            found.push(Film { shape, at });
        }
    }
    found
}

/// True if the shape combines shapes of its dimension in another way than by their least distance,
/// which leaves no new film.
fn may_leave_film(graph: &Graph, id: ShapeId) -> bool {
    let shape = graph.shape(id);
    let is_alike = |&child: &ShapeId| graph.shape(child).dim == shape.dim;
    shape.level == 0
        && shape.children.len() > 1
        && shape.children.iter().all(is_alike)
        && !is_union(graph, shape.formula)
}

/// True if the scene gives a formula that samples no other shape.
fn is_formula(graph: &Graph, id: ShapeId, is_own: &dyn Fn(&str) -> bool) -> bool {
    let shape = graph.shape(id);
    shape.level == 0 && shape.children.is_empty() && is_own(&shape.definition)
}

fn is_union(graph: &Graph, formula: NodeId) -> bool {
    let is_least = |id| matches!(graph.node(id), Node::Binary(Binary::Min, ..));
    let is_sample = |id| matches!(graph.node(id), Node::Sample(..));
    let parts = reachable_where(graph, &[formula], is_least);
    parts.into_iter().all(|id| is_least(id) || is_sample(id))
}

/// A point of a film of the shape. Lines are drawn where the bounds of the shape and of one child
/// overlap, so that the face of a small cut is not missed; within its own bounds if it has no
/// child.
fn film(
    graph: &mut Graph,
    bounds: &mut Bounds,
    shape: ShapeId,
    frame: &FrameValues,
    left: &mut u64,
) -> Option<Vec<f64>> {
    let whole = bounds.of(graph, shape);
    let width = graph.shape(shape).dim.point_type().width();
    let mut children = graph.shape(shape).children.clone();
    if children.is_empty() {
        children.push(shape);
    }
    let windows: Vec<[[f64; 3]; 2]> = children
        .into_iter()
        .filter_map(|child| {
            let part = bounds.of(graph, child);
            overlap(graph, whole, part, frame, width)
        })
        .collect();
    let mut probe = Probe::new(graph, shape, whole, frame, Effort(*left))?;
    *left = left.saturating_sub(PREPARATION * probe.operations());
    let lines = (0..LINES).flat_map(|_| &windows);
    lines.into_iter().find_map(|&window| {
        *left = left.checked_sub(probe.operations_of_line())?;
        probe.film_in(window)
    })
}

/// The box in which two boxes overlap. `None` if they do not.
fn overlap(
    graph: &mut Graph,
    a: [NodeId; 2],
    b: [NodeId; 2],
    frame: &FrameValues,
    width: usize,
) -> Option<[[f64; 3]; 2]> {
    let corners = [graph.max(a[0], b[0]), graph.min(a[1], b[1])];
    let [lo, hi] = corners_at(graph, corners, frame)?;
    (0..width).all(|axis| lo[axis] <= hi[axis]).then_some([lo, hi])
}
