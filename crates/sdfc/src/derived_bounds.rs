//! The bounding box of a scene, as nodes that are evaluated for each frame.

use rustc_hash::FxHashSet;
use sdfc_analyze::sampled_bounds;
use sdfc_graph::eval::{FrameValues, evaluate_frame};
use sdfc_graph::{Bounds, Graph, Node, NodeId, Scene, ShapeId, bounds, reachable_where};

/// The largest number of shapes that are looked at for the bounded parts of a scene.
const MOST_PARTS: usize = 1024;

/// The largest number of parts without bounds that are sampled.
const MOST_SAMPLED: usize = 8;

/// Lowest and highest corner of a box.
pub(crate) type Corners = [[f64; 3]; 2];

/// Lowest and highest corner of everything that is drawn, in a graph of their own.
#[derive(Debug)]
pub(crate) struct DerivedBounds {
    graph: Graph,
    corners: [NodeId; 2],
}

impl DerivedBounds {
    /// Derives the bounds of a scene, or returns `None` if it draws nothing.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let root = scene.root?;
        let mut extract = scene.graph.extract(&[], &[root]);
        let root = extract.shape(root)?;
        let corners = bounds(&mut extract.graph, root, &scene.params);
        Some(Self { graph: extract.graph, corners })
    }

    /// Returns the corners at a frame, infinite where the scene has no limit.
    pub(crate) fn at(&self, frame: &FrameValues) -> Option<Corners> {
        corners_at(&self.graph, self.corners, frame)
    }
}

/// Returns the corners of what a fitted camera looks at, at one frame alone: of the bounded parts
/// if the scene has no limit and there are any, else of the parts that samples find an end of, else
/// of everything. Corners for one frame may be tighter than those that hold for all values of the
/// params.
pub(crate) fn focus_at_one_frame(scene: &Scene, frame: &FrameValues) -> Option<Corners> {
    let (mut graph, root) = scene.shapes_at(frame)?;
    let mut bounds = Bounds::new(&[]);
    let whole = corners_of(&mut graph, &mut bounds, root, frame)?;
    if is_finite(&whole) {
        return Some(whole);
    }
    let mut focus: Option<Corners> = None;
    let mut open = Vec::new();
    let mut seen = FxHashSet::default();
    let mut left = vec![root];
    while let Some(shape) = left.pop() {
        if !seen.insert(shape) || seen.len() > MOST_PARTS {
            continue;
        }
        let corners = corners_of(&mut graph, &mut bounds, shape, frame)?;
        if is_finite(&corners) {
            focus = Some(focus.map_or(corners, |focus| hull(focus, corners)));
        } else {
            let parts = joined(&graph, shape);
            if parts.is_empty() {
                open.push(shape);
            }
            left.extend(parts);
        }
    }
    if focus.is_none() {
        open.truncate(MOST_SAMPLED);
        let sampled = open.into_iter().filter_map(|shape| sampled_bounds(&mut graph, shape, frame));
        focus = sampled.reduce(hull);
    }
    Some(focus.unwrap_or(whole))
}

/// Returns the corners of a shape at a frame.
pub(crate) fn corners_of(
    graph: &mut Graph,
    bounds: &mut Bounds,
    shape: ShapeId,
    frame: &FrameValues,
) -> Option<Corners> {
    let corners = bounds.of(graph, shape);
    corners_at(graph, corners, frame)
}

fn corners_at(graph: &Graph, corners: [NodeId; 2], frame: &FrameValues) -> Option<Corners> {
    let values = evaluate_frame(graph, &corners, frame);
    let corner = |index: usize| values.get(index).copied();
    Some([corner(0)?, corner(1)?].map(|[x, y, z, _]| [x, y, z]))
}

/// Returns the shapes that a shape's formula samples at its own point.
fn joined(graph: &Graph, shape: ShapeId) -> Vec<ShapeId> {
    let shape = graph.shape(shape);
    let inside = |id| !matches!(graph.node(id), Node::Sample(..));
    let nodes = reachable_where(graph, &[shape.formula], inside);
    let sampled = nodes.into_iter().filter_map(|id| graph.as_sample(id));
    let here = |at: NodeId| matches!(graph.node(at), Node::Point(level, _) if level == shape.level);
    sampled.filter(|(_, at)| here(*at)).map(|(child, _)| child).collect()
}

/// True if a box is limited on all sides and not empty.
fn is_finite([lo, hi]: &Corners) -> bool {
    (0..3).all(|axis| lo[axis].is_finite() && hi[axis].is_finite() && lo[axis] <= hi[axis])
}

fn hull([a, b]: Corners, [c, d]: Corners) -> Corners {
    [[0, 1, 2].map(|axis| a[axis].min(c[axis])), [0, 1, 2].map(|axis| b[axis].max(d[axis]))]
}
