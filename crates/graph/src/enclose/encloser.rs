//! The state of a pass that bounds nodes.

use rustc_hash::FxHashMap;

use super::values::BoundedValue;
use crate::graph::Graph;
use crate::ids::IdMap;
use crate::node::{LoopId, NodeId};

/// A graph to which bounds of its nodes are being added.
pub(super) struct Encloser<'g> {
    pub(super) graph: &'g mut Graph,
    /// The direction of slopes, if they are wanted.
    pub(super) direction: Option<NodeId>,
    pub(super) known: IdMap<BoundedValue>,
    pub(super) loops: FxHashMap<LoopId, Vec<BoundedValue>>,
}

impl<'g> Encloser<'g> {
    pub(super) fn new(graph: &'g mut Graph, direction: Option<NodeId>) -> Self {
        Self { graph, direction, known: IdMap::default(), loops: FxHashMap::default() }
    }
}
