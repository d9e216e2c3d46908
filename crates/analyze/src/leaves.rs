//! The number of leaf shapes in one evaluation of a scene's field.

use rustc_hash::FxHashSet;
use sdfc_graph::{ExpandError, Expander, Graph, NodeId, ShapeId, reachable};

/// Counts the shapes without children at distinct points. A leaf that is sampled twice at one point
/// counts once, as it is evaluated once in the shader.
pub(crate) fn count_leaves(
    graph: &mut Graph,
    expander: &mut Expander,
    root: ShapeId,
    point: NodeId,
) -> Result<usize, ExpandError> {
    let mut leaves = 0;
    let mut seen: FxHashSet<(ShapeId, Vec<NodeId>)> = FxHashSet::default();
    let mut pending = vec![(root, vec![point])];
    while let Some((shape, points)) = pending.pop() {
        if !seen.insert((shape, points.clone())) {
            continue;
        }
        let formula = graph.shape(shape).formula;
        let samples: Vec<(ShapeId, NodeId)> = reachable(graph, &[formula])
            .into_iter()
            .filter_map(|node| graph.as_sample(node))
            .collect();
        if samples.is_empty() {
            leaves += 1;
        }
        for (child, q) in samples {
            let q = expander.node(graph, q, &points)?;
            let level = usize::from(graph.shape(child).level).min(points.len());
            let mut inner = points[..level].to_vec();
            inner.push(q);
            pending.push((child, inner));
        }
    }
    Ok(leaves)
}
