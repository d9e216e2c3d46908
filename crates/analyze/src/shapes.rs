//! Shapes of a graph: those below a shape, and auxiliary ones.

use rustc_hash::FxHashSet;
use sdfc_graph::{Arg, Bounds, Contract, Dim, Graph, MaterialRule, NodeId, Shape, ShapeId};

/// `root` and all shapes that its formulas and materials sample, children before parents.
pub(crate) fn shapes_below(graph: &Graph, root: ShapeId) -> Vec<ShapeId> {
    let mut seen = FxHashSet::default();
    let mut pending = vec![root];
    while let Some(shape) = pending.pop() {
        if seen.insert(shape) {
            pending.extend(graph.shape(shape).children.iter().copied());
        }
    }
    let mut order: Vec<ShapeId> = seen.into_iter().collect();
    order.sort_unstable();
    order
}

/// The minimum of some values; `None` if there are none.
pub(crate) fn minimum(
    graph: &mut Graph,
    values: impl IntoIterator<Item = NodeId>,
) -> Option<NodeId> {
    values.into_iter().reduce(|a, b| graph.min(a, b))
}

/// True if the bounds of a shape are finite on all sides.
pub(crate) fn is_bounded(graph: &mut Graph, bounds: &mut Bounds, shape: ShapeId) -> bool {
    let corners = bounds.of(graph, shape);
    corners.into_iter().all(|corner| graph.is_finite(corner))
}

/// Adds a shape of level 0 that no report mentions.
pub(crate) fn unnamed_shape(
    graph: &mut Graph,
    formula: NodeId,
    mut children: Vec<ShapeId>,
) -> ShapeId {
    children.sort_unstable();
    children.dedup();
    let depth = children.iter().map(|&child| graph.shape(child).depth).max().unwrap_or(0);
    graph.add_shape(Shape {
        definition: "unnamed".to_owned(),
        dim: Dim::Three,
        level: 0,
        args: vec![Arg::Node(formula)],
        formula,
        contract: Contract::default(),
        intersect: Vec::new(),
        material: MaterialRule::Weighted(formula),
        children,
        depth: depth + 1,
        name: None,
    })
}
