//! A formula that says `copies`, taken apart.
//!
//! It is the least of samples, each at a map of the point that is rigid while what jumps keeps its value, by itself or cut by a box
//! around it, and of values without samples, which say how near what is not sampled there is at most.

use rustc_hash::FxHashSet;
use sdfc_graph::{Binary, Dim, Graph, Node, NodeId, Shape, ShapeId, reachable};

use crate::certify::affine::{Linear, applied, linear_between_jumps, similarity};

/// What such a formula is made of, in its own point.
pub(crate) struct Copies {
    pub samples: Vec<Copied>,
    /// Nothing that is not sampled is nearer than the least of these; one at least.
    pub limits: Vec<NodeId>,
}

/// A sample of a shape.
pub(crate) struct Copied {
    pub child: ShapeId,
    /// Where it is sampled.
    pub at: NodeId,
    linear: Linear,
}

impl Copied {
    /// What the map makes of a direction.
    pub fn direction(&self, graph: &mut Graph, direction: NodeId) -> NodeId {
        applied(graph, &self.linear, direction)
    }
}

/// Why a shape that says `copies` is not met by its copies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CopiesObstacle {
    /// Something in its minimum samples shapes otherwise.
    NotASample,
    /// A sample is stretched, sheared or bent.
    NotRigid,
    /// Nothing is sampled.
    NoSample,
    /// Only samples stand there.
    NoLimit,
}

/// Why the clause `copies` of a shape does nothing; `None` if it is of use, or not stated.
pub fn copies_obstacle(graph: &mut Graph, shape: ShapeId) -> Option<CopiesObstacle> {
    let Shape { contract, dim, .. } = graph.shape(shape);
    if !contract.copies || *dim != Dim::Three {
        return None;
    }
    taken_apart(graph, shape).err()
}

/// The samples and limits of a shape's formula.
pub(crate) fn taken_apart(graph: &mut Graph, shape: ShapeId) -> Result<Copies, CopiesObstacle> {
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
            copies.samples.push(copied(graph, node, level)?);
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

/// A sample by itself, or the one in a maximum with values without samples.
fn copied(graph: &mut Graph, mut node: NodeId, level: u16) -> Result<Copied, CopiesObstacle> {
    while let Node::Binary(Binary::Max, a, b) = graph.node(node) {
        node = match [a, b].map(|operand| has_samples(graph, operand)) {
            [true, false] => a,
            [false, true] => b,
            [true, true] | [false, false] => return Err(CopiesObstacle::NotASample),
        };
    }
    let (child, at) = graph.as_sample(node).ok_or(CopiesObstacle::NotASample)?;
    let linear = linear_between_jumps(graph, at, level).ok_or(CopiesObstacle::NotRigid)?;
    let stretch = similarity(graph, &linear).and_then(|stretch| graph.as_number(stretch));
    if stretch != Some(1.0) {
        return Err(CopiesObstacle::NotRigid);
    }
    Ok(Copied { child, at, linear })
}

fn has_samples(graph: &Graph, node: NodeId) -> bool {
    reachable(graph, &[node]).into_iter().any(|node| graph.as_sample(node).is_some())
}
