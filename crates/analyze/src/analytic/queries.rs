//! The functions of a ray that are evaluated before it is marched.

use sdfc_graph::{Bounds, Dim, ExpandError, Expander, Graph, NodeId, Rays, fold_transforms};

use crate::analytic::boxes::{clip, hull, outermost};
use crate::analytic::intervals::{RayIntervals, first_hit, union};
use crate::analytic::operands::{MarchedOperand, Operands, bounding_shape};

/// Largest number of marched operands whose bounds clip rays. Deriving the bounds of more takes
/// longer than the clipping saves.
const MAX_CLIPPED: usize = 256;
/// Largest number of intervals of copies near the ray's origin. Each costs as much as a distance.
const MAX_COPIES: usize = 64;
/// Largest number of marched operands that have a box each.
const MAX_BOXES: usize = 16;

/// The functions of a ray that are evaluated before it is marched.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RayQueries {
    /// The distance to the first analytic hit.
    hits: Option<NodeId>,
    /// The interval in which marched operands can be hit.
    clip: Option<NodeId>,
    /// The first hit with copies near the origin, and the distance up to which it is known.
    copies: Option<NodeId>,
}

/// Builds the queries of a scene, and folds their transforms.
pub(crate) fn ray_queries(
    graph: &mut Graph,
    expander: &mut Expander,
    bounds: &mut Bounds,
    operands: &Operands,
) -> Result<RayQueries, ExpandError> {
    let intervals: Vec<_> = operands
        .analytic
        .iter()
        .flat_map(|operand| operand.intervals.list.iter().copied())
        .collect();
    let mut roots = Vec::new();
    if !intervals.is_empty() {
        roots.push(first_hit(graph, &intervals));
    }
    let hits = roots.len();
    let ray = [0, 1].map(|level| graph.point(level, Dim::Three));
    let boxes = boxes(graph, expander, bounds, &operands.marched, ray)?;
    let intervals: Option<Vec<_>> = boxes.into_iter().map(|ends| clip(graph, ray, ends)).collect();
    if let Some(ends) = intervals.and_then(|intervals| hull(graph, &intervals)) {
        roots.push(graph.compose(&ends));
    }
    let clips = roots.len();
    roots.extend(local_hit(graph, &operands.marched));
    let folded = fold_transforms(graph, &roots).roots;
    let [hits, clip, copies] = [&folded[..hits], &folded[hits..clips], &folded[clips..]];
    let [hits, clip, copies] = [hits, clip, copies].map(|root| root.first().copied());
    Ok(RayQueries { hits, clip, copies })
}

/// The first hit of a ray with the marched operands, and the distance up to which that is known.
/// Returns `None` unless all operands are known near the ray's origin.
fn local_hit(graph: &mut Graph, marched: &[MarchedOperand]) -> Option<NodeId> {
    let known = marched
        .iter()
        .map(|operand| operand.local.clone())
        .collect::<Option<Vec<RayIntervals>>>()?;
    let known = union(graph, known);
    let reach = known.reach.filter(|_| known.list.len() <= MAX_COPIES)?;
    let hit = first_hit(graph, &known.list);
    Some(graph.compose(&[hit, reach]))
}

/// Boxes that hold the marched operands.
fn boxes(
    graph: &mut Graph,
    expander: &mut Expander,
    bounds: &mut Bounds,
    marched: &[MarchedOperand],
    ray: [NodeId; 2],
) -> Result<Vec<[NodeId; 2]>, ExpandError> {
    let size = match marched.len() {
        0..=MAX_BOXES => 1,
        many if many <= MAX_CLIPPED => many,
        _ => return Ok(Vec::new()),
    };
    let mut boxes = Vec::with_capacity(marched.len() / size);
    for group in marched.chunks(size) {
        let Some(shape) = bounding_shape(graph, group) else { continue };
        let [lo, hi] = bounds.of(graph, shape);
        boxes.push([expander.node(graph, lo, &ray)?, expander.node(graph, hi, &ray)?]);
    }
    Ok(outermost(graph, &boxes))
}

/// Assembles the functions of a ray from the queries and from the fields of the whole scene, of the
/// analytic operands and of the marched operands, of which the last two may be missing.
pub(crate) fn ray_functions(operands: &Operands, fields: &[NodeId], queries: RayQueries) -> Rays {
    let RayQueries { hits, clip, copies } = queries;
    let (whole, rest) = (fields.first().copied(), fields.get(1..).unwrap_or_default());
    match (operands.analytic.is_empty(), operands.marched.is_empty()) {
        (true, _) => Rays { first_hit: hits, analytic: None, marched: whole, clip, copies },
        (false, is_all) => {
            let marched = rest.get(1).copied().filter(|_| !is_all);
            Rays { first_hit: hits, analytic: rest.first().copied(), marched, clip, copies }
        }
    }
}
