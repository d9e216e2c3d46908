//! What a ray is asked before it is marched, and what is left to march.

use sdfc_graph::{Bounds, Dim, ExpandError, Expander, Graph, NodeId, Rays, fold_transforms};

use crate::analytic::boxes::{clip, outermost, through};
use crate::analytic::intervals::{Known, first, joined};
use crate::analytic::split::{Open, Parts, around};

/// Rays are clipped to a box around no more operands than this: their bounds take longer to derive than the box saves.
const MOST_CLIPPED: usize = 256;
/// What is left to march is known near a place by no more intervals than this: each costs as much as a distance.
const MOST_COPIES: usize = 64;
/// Of no more operands than this each has a box of its own.
const MOST_BOXES: usize = 16;

/// What a ray is asked before it is marched.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Asked {
    hits: Option<NodeId>,
    clip: Option<NodeId>,
    copies: Option<NodeId>,
}

/// The first hit of what is closed, the way through the bounds of what is left, and what of that is known near a place.
pub(crate) fn asked_of_rays(
    graph: &mut Graph,
    expander: &mut Expander,
    bounds: &mut Bounds,
    apart: &Parts,
) -> Result<Asked, ExpandError> {
    let spans: Vec<_> =
        apart.closed.iter().flat_map(|part| part.known.spans.iter().copied()).collect();
    let mut roots = Vec::new();
    if !spans.is_empty() {
        roots.push(first(graph, &spans));
    }
    let hits = roots.len();
    let ray = [0, 1].map(|level| graph.point(level, Dim::Three));
    let boxes = boxes(graph, expander, bounds, &apart.open, ray)?;
    let ways: Option<Vec<_>> = boxes.into_iter().map(|ends| clip(graph, ray, ends)).collect();
    if let Some(ends) = ways.and_then(|ways| through(graph, &ways)) {
        roots.push(graph.compose(&ends));
    }
    let clips = roots.len();
    roots.extend(near(graph, &apart.open));
    let folded = fold_transforms(graph, &roots).roots;
    let [hits, clip, copies] = [&folded[..hits], &folded[hits..clips], &folded[clips..]];
    let [hits, clip, copies] = [hits, clip, copies].map(|root| root.first().copied());
    Ok(Asked { hits, clip, copies })
}

/// Where a ray first meets what is left, and how far that is known from the ray's origin; `None` where that is not known of all.
fn near(graph: &mut Graph, open: &[Open]) -> Option<NodeId> {
    let known = open.iter().map(|part| part.near.clone()).collect::<Option<Vec<Known>>>()?;
    let known = joined(graph, known);
    let reach = known.reach.filter(|_| known.spans.len() <= MOST_COPIES)?;
    let met = first(graph, &known.spans);
    Some(graph.compose(&[met, reach]))
}

/// Corners of boxes that hold what is left to march.
fn boxes(
    graph: &mut Graph,
    expander: &mut Expander,
    bounds: &mut Bounds,
    open: &[Open],
    ray: [NodeId; 2],
) -> Result<Vec<[NodeId; 2]>, ExpandError> {
    let size = match open.len() {
        0..=MOST_BOXES => 1,
        many if many <= MOST_CLIPPED => many,
        _ => return Ok(Vec::new()),
    };
    let mut boxes = Vec::with_capacity(open.len() / size);
    for group in open.chunks(size) {
        let Some(shape) = around(graph, group) else { continue };
        let [lo, hi] = bounds.of(graph, shape);
        boxes.push([expander.node(graph, lo, &ray)?, expander.node(graph, hi, &ray)?]);
    }
    Ok(outermost(graph, &boxes))
}

/// The functions of rays, from the fields of the whole, of what is closed and of what is left, as far as there are such.
pub(crate) fn rays(apart: &Parts, fields: &[NodeId], asked: Asked) -> Rays {
    let Asked { hits, clip, copies } = asked;
    let (whole, parts) = (fields.first().copied(), fields.get(1..).unwrap_or_default());
    match (apart.closed.is_empty(), apart.open.is_empty()) {
        (true, _) => Rays { first_hit: hits, analytic: None, marched: whole, clip, copies },
        (false, is_all) => {
            let marched = parts.get(1).copied().filter(|_| !is_all);
            Rays { first_hit: hits, analytic: parts.first().copied(), marched, clip, copies }
        }
    }
}
