//! Where a formula falls into parts that are differentiated one after the other.

use crate::dominators::DominatorTree;
use crate::graph::Graph;
use crate::ids::{IdMap, IdSet};
use crate::node::{NodeId, Stage, Type};
use crate::schedule::dag::{Dag, Exclusive};

/// A scalar whose derivative is computed before that of what it is a part of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// The scalar.
    pub(super) value: NodeId,
    /// The node that it is differentiated by: all its paths to the point lead through it.
    pub(super) frame: NodeId,
}

/// The least number of lanes that a cut must leave to the rest of the formula.
const LEAST_REST: usize = 4;

/// The cuts below a root, ascending: scalars that alone need at least `least` lanes of other
/// values. Once a cut and its derivative are computed, these values are no longer needed.
///
/// `order` has all nodes that the root is computed from, ascending, the point included.
pub(super) fn cuts(
    graph: &Graph,
    [root, point]: [NodeId; 2],
    order: &[NodeId],
    live: &IdSet,
    least: usize,
) -> Vec<Cut> {
    let positions: IdMap<usize> = order.iter().copied().zip(0..).collect();
    let (Some(top), Some(bottom)) = (positions.get(root), positions.get(point)) else {
        return Vec::new();
    };
    let per_point = |id| id != point && graph.stage(id) == Stage::Point;
    let operands = |id| if per_point(id) { graph.inputs(id) } else { Vec::new() };
    let Exclusive { users, lanes } = Dag::new(graph, &[root], order, operands).exclusive();
    let is_cut = |position: usize| {
        let id = order[position];
        let rest = lanes[users.parent(position)].saturating_sub(lanes[position]);
        position != top
            && graph.ty(id) == Type::Scalar
            && live.contains(id)
            && id != point
            && lanes[position] >= least
            && rest >= LEAST_REST
    };
    let chosen: Vec<usize> = (0..order.len()).filter(|&position| is_cut(position)).collect();
    if chosen.is_empty() {
        return Vec::new();
    }
    let sources = sources_tree(graph, order, &positions, live, bottom);
    let is_frame = frames(&sources, &chosen, order.len(), bottom);
    let frame = |mut position: usize| {
        while position != bottom {
            position = sources.parent(position);
            if is_frame[position] {
                break;
            }
        }
        order[position]
    };
    chosen.iter().map(|&position| Cut { value: order[position], frame: frame(position) }).collect()
}

/// The dominators of the live nodes seen from the point: what they depend on it through.
fn sources_tree(
    graph: &Graph,
    order: &[NodeId],
    positions: &IdMap<usize>,
    live: &IdSet,
    bottom: usize,
) -> DominatorTree {
    let mut tree = DominatorTree::new(order.len(), bottom);
    for (position, &id) in order.iter().enumerate() {
        if position == bottom || !live.contains(id) {
            continue;
        }
        let sources = graph.inputs(id).into_iter().filter(|&input| live.contains(input));
        let parent = sources
            .filter_map(|input| positions.get(input))
            .reduce(|known, input| tree.common(known, input));
        tree.add(position, parent.unwrap_or(bottom));
    }
    tree
}

/// The nodes that several cuts depend on the point through, before anything else does.
fn frames(sources: &DominatorTree, cuts: &[usize], count: usize, bottom: usize) -> Vec<bool> {
    // How many branches of the tree below a node hold a cut; a node that is a cut counts as one.
    let mut branches = vec![0_u32; count];
    for &cut in cuts {
        branches[cut] += 1;
    }
    let mut held: Vec<bool> = branches.iter().map(|&count| count > 0).collect();
    // A node's dominator has a smaller id.
    for position in (0..count).rev() {
        if held[position] && position != bottom {
            let parent = sources.parent(position);
            branches[parent] += 1;
            held[parent] = true;
        }
    }
    branches.into_iter().map(|count| count > 1).collect()
}
