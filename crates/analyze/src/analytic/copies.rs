//! Formulas with the clause `copies`, taken apart into samples and limits.
//!
//! Such a formula is the minimum of samples and of values without samples. Each sample is at a map
//! of the point that is rigid between the jumps of `floor` and the like, and may be intersected
//! with a box. Each value without samples is a lower bound of the distance to the copies that are
//! not sampled.

use rustc_hash::FxHashSet;
use sdfc_graph::{Binary, Dim, Graph, Node, NodeId, Shape, ShapeId, reachable};

use crate::certify::affine::{Linear, applied, linear_between_jumps, similarity};

/// The operands of such a minimum, in the formula's own point.
pub(crate) struct Copies {
    pub samples: Vec<CopySample>,
    /// The minimum of these bounds the distance to all other copies from below; not empty.
    pub limits: Vec<NodeId>,
}

/// One sample of a shape.
pub(crate) struct CopySample {
    pub child: ShapeId,
    /// The point at which it is sampled.
    pub at: NodeId,
    linear: Linear,
}

impl CopySample {
    /// Applies the linear part of the map to a direction.
    pub fn direction(&self, graph: &mut Graph, direction: NodeId) -> NodeId {
        applied(graph, &self.linear, direction)
    }
}

/// The reason why the clause `copies` of a shape cannot be used to intersect rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CopiesObstacle {
    /// An operand of the minimum is neither a single sample nor a value without samples.
    NotASample,
    /// The point of a sample is not a rigid map: it is scaled, sheared or bent.
    NotRigid,
    /// No operand samples a shape.
    NoSample,
    /// No operand bounds the distance to the other copies.
    NoLimit,
}

/// The reason why the clause `copies` of a shape has no effect; `None` if it has one, or is not
/// stated.
pub fn copies_obstacle(graph: &Graph, shape: ShapeId) -> Option<CopiesObstacle> {
    let Shape { contract, dim, .. } = graph.shape(shape);
    if !contract.copies || *dim != Dim::Three {
        return None;
    }
    let mut extract = graph.extract(&[], &[shape]);
    let shape = extract.shape(shape)?;
    split_copies(&mut extract.graph, shape).err()
}

/// Takes the formula of a shape with the clause `copies` apart.
pub(crate) fn split_copies(graph: &mut Graph, shape: ShapeId) -> Result<Copies, CopiesObstacle> {
    let Shape { formula, level, .. } = *graph.shape(shape);
    let mut copies = Copies { samples: Vec::new(), limits: Vec::new() };
    let (mut seen, mut pending) = (FxHashSet::default(), vec![formula]);
    while let Some(node) = pending.pop() {
        if !seen.insert(node) {
            continue;
        }
        if let Node::Binary(Binary::Min, a, b) = graph.node(node) {
            pending.extend([b, a]);
        } else if has_samples(graph, node) {
            copies.samples.push(copy_sample(graph, node, level)?);
        } else {
            copies.limits.push(node);
        }
    }
    match (copies.samples.is_empty(), copies.limits.is_empty()) {
        (true, _) => Err(CopiesObstacle::NoSample),
        (_, true) => Err(CopiesObstacle::NoLimit),
        (false, false) => Ok(copies),
    }
}

/// The sample in an operand: the operand itself, or the one operand of a maximum that has samples.
fn copy_sample(
    graph: &mut Graph,
    mut node: NodeId,
    level: u16,
) -> Result<CopySample, CopiesObstacle> {
    while let Node::Binary(Binary::Max, a, b) = graph.node(node) {
        node = match [a, b].map(|operand| has_samples(graph, operand)) {
            [true, false] => a,
            [false, true] => b,
            [true, true] | [false, false] => return Err(CopiesObstacle::NotASample),
        };
    }
    let (child, at) = graph.as_sample(node).ok_or(CopiesObstacle::NotASample)?;
    let linear = linear_between_jumps(graph, at, level).ok_or(CopiesObstacle::NotRigid)?;
    let scale = similarity(graph, &linear).and_then(|scale| graph.as_number(scale));
    if scale != Some(1.0) {
        return Err(CopiesObstacle::NotRigid);
    }
    Ok(CopySample { child, at, linear })
}

fn has_samples(graph: &Graph, node: NodeId) -> bool {
    reachable(graph, &[node]).into_iter().any(|node| graph.as_sample(node).is_some())
}
