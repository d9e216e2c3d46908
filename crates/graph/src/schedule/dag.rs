//! The nodes of one function, and which of them each reads.

use crate::graph::Graph;
use crate::ids::IdMap;
use crate::node::{Node, NodeId, Type};

/// Nodes by position, each after the nodes that it reads.
pub(super) struct Dag {
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

impl Dag {
    pub(super) fn new(
        graph: &Graph,
        roots: &[NodeId],
        members: &[NodeId],
        operands: impl Fn(NodeId) -> Vec<NodeId>,
    ) -> Self {
        let positions: IdMap<usize> = members.iter().copied().zip(0..).collect();
        let mut dag =
            Self { nodes: members.to_vec(), arguments: vec![], roots: vec![], lanes: vec![] };
        for (position, &id) in members.iter().enumerate() {
            // Operands that are no members are looked through.
            let mut arguments: Vec<usize> = Vec::new();
            let mut pending = operands(id);
            while let Some(operand) = pending.pop() {
                match positions.get(operand) {
                    Some(argument) if argument < position => arguments.push(argument),
                    Some(_) => {}
                    None => pending.extend(operands(operand)),
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
        let width = graph.ty(id).width();
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
            Node::Point(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..)
            | Node::Sample(..)
            | Node::MaterialAt(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Transform(..) => {
                let is_input = matches!(graph.node(id), Node::Point(..) | Node::Variable(..));
                if graph.ty(id) != Type::Bool && (is_input || !reads_nothing) {
                    for (lane, index) in lanes.iter_mut().zip(0..).take(width) {
                        *lane = Some((position, index));
                    }
                }
            }
        }
        lanes
    }
}
