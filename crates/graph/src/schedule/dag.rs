//! The nodes of one function, and which of them each reads.

use rustc_hash::FxHashSet;

use crate::dominators::DominatorTree;
use crate::graph::Graph;
use crate::ids::IdMap;
use crate::node::{Node, NodeId, Type};

/// Nodes by position, each after the nodes that it reads.
pub(crate) struct Dag {
    /// The nodes, ascending.
    pub(super) nodes: Vec<NodeId>,
    /// The positions of the nodes that each node reads.
    pub(super) arguments: Vec<Vec<usize>>,
    /// The positions of the nodes that are read last.
    pub(super) roots: Vec<usize>,
    /// For each lane of a node's value, where it is computed: a position and a lane there. Lanes
    /// that are only moved are those of the node that computed them; lanes of constants and of
    /// other values that take no register have none.
    pub(super) lanes: Vec<[Option<(usize, u8)>; 4]>,
}

/// The dominators of the nodes, and the lanes that one node alone needs, by position.
pub(crate) struct Exclusive {
    /// The dominators of the nodes, seen from their users. The root stands for all that reads the
    /// nodes of the function; its position is their number.
    pub(crate) users: DominatorTree,
    /// The number of lanes that are computed for each node alone, its own included.
    pub(crate) lanes: Vec<usize>,
}

impl Dag {
    pub(crate) fn new(
        graph: &Graph,
        roots: &[NodeId],
        members: &[NodeId],
        operands: impl Fn(NodeId) -> Vec<NodeId>,
    ) -> Self {
        let positions: IdMap<usize> = members.iter().copied().zip(0..).collect();
        let mut dag =
            Self { nodes: members.to_vec(), arguments: vec![], roots: vec![], lanes: vec![] };
        let mut seen: FxHashSet<NodeId> = FxHashSet::default();
        for (position, &id) in members.iter().enumerate() {
            // Operands that are no members are looked through, each once.
            let mut arguments: Vec<usize> = Vec::new();
            seen.clear();
            let mut pending = operands(id);
            while let Some(operand) = pending.pop() {
                match positions.get(operand) {
                    Some(argument) if argument < position => arguments.push(argument),
                    Some(_) => {}
                    None if seen.insert(operand) => pending.extend(operands(operand)),
                    None => {}
                }
            }
            arguments.sort_unstable();
            arguments.dedup();
            let lanes = dag.lanes_of(graph, &positions, id, position, arguments.is_empty());
            dag.arguments.push(arguments);
            dag.lanes.push(lanes);
        }
        dag.roots = roots.iter().filter_map(|&root| positions.get(root)).collect();
        dag
    }

    /// The number of lanes that a node computes, rather than moves.
    pub(super) fn own_lanes(&self, position: usize) -> usize {
        self.lanes[position].iter().flatten().filter(|lane| lane.0 == position).count()
    }

    /// Returns the dominators, and the number of lanes that each node alone needs.
    pub(crate) fn exclusive(&self) -> Exclusive {
        let count = self.nodes.len();
        let mut users = DominatorTree::new(count + 1, count);
        let mut found: Vec<Option<usize>> = vec![None; count];
        for &root in &self.roots {
            found[root] = Some(count);
        }
        for position in (0..count).rev() {
            users.add(position, found[position].unwrap_or(count));
            for &argument in &self.arguments[position] {
                let common =
                    found[argument].map_or(position, |known| users.common(known, position));
                found[argument] = Some(common);
            }
        }
        let mut lanes: Vec<usize> = (0..count).map(|position| self.own_lanes(position)).collect();
        lanes.push(0);
        // A node's dominator has a greater position.
        for position in 0..count {
            lanes[users.parent(position)] += lanes[position];
        }
        Exclusive { users, lanes }
    }

    fn lanes_of(
        &self,
        graph: &Graph,
        positions: &IdMap<usize>,
        id: NodeId,
        position: usize,
        reads_nothing: bool,
    ) -> [Option<(usize, u8)>; 4] {
        let lane_of = |id: NodeId, lane: usize| Some(self.lanes[positions.get(id)?][lane]);
        let mut lanes = [None; 4];
        // Conditions take no register.
        let width = if graph.ty(id) == Type::Bool { 0 } else { graph.ty(id).width() };
        match graph.node(id) {
            Node::Swizzle(_, vector, from) => {
                for (lane, from) in lanes.iter_mut().zip(from).take(width) {
                    *lane = lane_of(vector, usize::from(from)).flatten();
                }
            }
            Node::Compose(_, parts) => {
                for (lane, part) in lanes.iter_mut().zip(parts).take(width) {
                    *lane = lane_of(part, 0).flatten();
                }
            }
            Node::Splat(_, scalar) => lanes[..width].fill(lane_of(scalar, 0).flatten()),
            // Loaded once for all threads, where it is read.
            Node::Const(_) | Node::Frame(..) => {}
            Node::Point(..) | Node::Variable(..) => lanes = computed_lanes(position, width),
            Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Transform(..) => {
                // What reads no member is the same for all threads.
                if !reads_nothing {
                    lanes = computed_lanes(position, width);
                }
            }
        }
        lanes
    }
}

/// The lanes of a value that its own node computes.
fn computed_lanes(position: usize, width: usize) -> [Option<(usize, u8)>; 4] {
    let mut lanes = [None; 4];
    for (lane, index) in lanes.iter_mut().zip(0..).take(width) {
        *lane = Some((position, index));
    }
    lanes
}
