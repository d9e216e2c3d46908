//! The components of a formula's point that its nodes depend on.

use rustc_hash::FxHashMap;
use sdfc_graph::{Binary, Dim, Graph, Node, NodeId, Ternary, Unary};

use crate::certify::affine;

/// A bit mask of components of the point for each lane; 0 beyond a node's width.
type Mask = [u8; 4];

/// All components of the point.
const ANY: Mask = [7; 4];

/// The components of the point that each lane of each node of a formula depends on.
#[derive(Default)]
pub(crate) struct Components(FxHashMap<NodeId, Mask>);

impl Components {
    /// Records the components for a node of a formula in the point of `level`. Its arguments must
    /// have been visited.
    pub(crate) fn visit(&mut self, graph: &Graph, node: NodeId, level: u16) {
        self.0.insert(node, self.mask(graph, node, level));
    }

    /// True if no two of the nodes depend on the same component of the point. The squares of their
    /// changes then add up like the squares of the components' changes.
    pub(crate) fn are_disjoint(&self, nodes: &[NodeId]) -> bool {
        let mask =
            |node: &NodeId| self.0.get(node).unwrap_or(&ANY).iter().fold(0, |all, lane| all | lane);
        let counted: u32 = nodes.iter().map(|node| mask(node).count_ones()).sum();
        counted == nodes.iter().fold(0, |all, node| all | mask(node)).count_ones()
    }

    /// The components for each lane. Variables, loops, list elements and points of other levels
    /// count as depending on all of them.
    fn mask(&self, graph: &Graph, node: NodeId, level: u16) -> Mask {
        let of = |id: NodeId| match affine::is_fixed(graph, id, level) {
            true => [0; 4],
            false => self.0.get(&id).copied().unwrap_or(ANY),
        };
        let joined = |ids: &[NodeId]| {
            ids.iter()
                .map(|&id| of(id))
                .fold([0; 4], |all: Mask, mask| std::array::from_fn(|i| all[i] | mask[i]))
        };
        let all_lanes = |ids: &[NodeId]| [joined(ids).iter().fold(0, |x, y| x | y); 4];
        match graph.node(node) {
            Node::Const(_) | Node::Frame(..) => [0; 4],
            Node::Point(at, Dim::Three) if at == level => [1, 2, 4, 0],
            Node::Point(at, Dim::Two) if at == level => [1, 2, 0, 0],
            Node::Unary(Unary::Length | Unary::Normalize, a) => all_lanes(&[a]),
            Node::Unary(_, a) => of(a),
            Node::Binary(Binary::Dot | Binary::Cross, a, b) => all_lanes(&[a, b]),
            Node::Binary(_, a, b) => joined(&[a, b]),
            Node::Ternary(Ternary::Select, [condition, a, b]) => {
                joined(&[a, b]).map(|mask| mask | of(condition)[0])
            }
            Node::Ternary(_, arguments) => joined(&arguments),
            Node::Splat(_, a) => [of(a)[0]; 4],
            Node::Compose(ty, parts) => {
                std::array::from_fn(|i| if i < ty.width() { of(parts[i])[0] } else { 0 })
            }
            Node::Swizzle(ty, a, lanes) => {
                std::array::from_fn(
                    |i| {
                        if i < ty.width() { of(a)[usize::from(lanes[i])] } else { 0 }
                    },
                )
            }
            Node::Transform([a, b, c], v) => all_lanes(&[a, b, c, v]),
            Node::Sample(_, q) | Node::MaterialAt(_, q, _) => all_lanes(&[q]),
            Node::Point(..) | Node::Variable(..) | Node::Loop(..) | Node::Element(..) => ANY,
        }
    }
}
