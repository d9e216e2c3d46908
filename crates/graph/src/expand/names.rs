//! Names of expanded nodes, for the generated shader source.

use rustc_hash::FxHashMap;

use crate::graph::Graph;
use crate::node::{Node, NodeId, ShapeId, Stage};

#[derive(Clone, Debug)]
struct Name {
    text: String,
    /// True if the scene gives the name; false if it is the definition's.
    own: bool,
}

/// The first name of each node; a name from the scene replaces a definition's.
#[derive(Clone, Debug, Default)]
pub(super) struct Names {
    names: FxHashMap<NodeId, Name>,
}

impl Names {
    pub(super) fn record(&mut self, graph: &Graph, id: NodeId, shape: ShapeId) {
        let unnamed = matches!(graph.node(id), Node::Const(_) | Node::Point(..));
        if unnamed || graph.stage(id) < Stage::Point {
            return;
        }
        let shape = graph.shape(shape);
        let own = shape.name.is_some();
        if self.names.get(&id).is_none_or(|known| own && !known.own) {
            let text = shape.name.as_ref().unwrap_or(&shape.definition).clone();
            self.names.insert(id, Name { text, own });
        }
    }

    pub(super) fn to_map(&self) -> FxHashMap<NodeId, String> {
        self.names.iter().map(|(&id, name)| (id, name.text.clone())).collect()
    }
}
