//! Where a formula falls into parts that are differentiated one after the other.

use crate::dominators::DominatorTree;
use crate::graph::Graph;
use crate::ids::{IdMap, IdSet};
use crate::node::{Node, NodeId, Stage, Type};

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
    let users = users_tree(graph, order, &positions, top, point);
    let lanes = exclusive_lanes(graph, order, &users, top);
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

/// The dominators of all nodes seen from the root: what alone uses them.
fn users_tree(
    graph: &Graph,
    order: &[NodeId],
    positions: &IdMap<usize>,
    top: usize,
    point: NodeId,
) -> DominatorTree {
    let mut tree = DominatorTree::new(order.len(), top);
    let mut found: Vec<Option<usize>> = vec![None; order.len()];
    for position in (0..order.len()).rev() {
        if let Some(parent) = found[position] {
            tree.add(position, parent);
        } else if position != top {
            continue;
        }
        if order[position] == point {
            continue;
        }
        for argument in graph.inputs(order[position]) {
            let Some(argument) = positions.get(argument) else { continue };
            found[argument] =
                Some(found[argument].map_or(position, |known| tree.common(known, position)));
        }
    }
    tree
}

/// The lanes of the values that only a node uses, its own included.
fn exclusive_lanes(
    graph: &Graph,
    order: &[NodeId],
    users: &DominatorTree,
    top: usize,
) -> Vec<usize> {
    let mut lanes: Vec<usize> = order.iter().map(|&id| own_lanes(graph, id)).collect();
    // A node's dominator has a greater id.
    for position in (0..order.len()).filter(|&position| position != top) {
        lanes[users.parent(position)] += lanes[position];
    }
    lanes
}

fn own_lanes(graph: &Graph, id: NodeId) -> usize {
    match graph.node(id) {
        Node::Const(_)
        | Node::Frame(..)
        | Node::Point(..)
        | Node::Variable(..)
        | Node::Splat(..)
        | Node::Compose(..)
        | Node::Swizzle(..) => 0,
        Node::Unary(..)
        | Node::Binary(..)
        | Node::Ternary(..)
        | Node::Transform(..)
        | Node::Loop(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => {
            if graph.stage(id) == Stage::Point {
                graph.ty(id).width()
            } else {
                0
            }
        }
    }
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
