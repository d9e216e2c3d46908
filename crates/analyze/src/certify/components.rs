//! Which components of a formula's point its nodes look at.

use rustc_hash::FxHashMap;
use sdfc_graph::{Binary, Dim, Graph, Node, NodeId, Ternary, Unary};

use crate::certify::affine;

/// Components of the point as bits, lane by lane; none beyond a node's width.
type Seen = [u8; 4];

/// All components of the point.
const ANY: Seen = [7; 4];

/// Of each node of a formula, the components of the point that each of its lanes looks at.
#[derive(Default)]
pub(crate) struct Components(FxHashMap<NodeId, Seen>);

impl Components {
    /// Notes what a node of a formula over the point of `level` looks at, its arguments known.
    pub(crate) fn visit(&mut self, graph: &Graph, node: NodeId, level: u16) {
        self.0.insert(node, self.seen(graph, node, level));
    }

    /// Whether no component of the point is looked at by two of the nodes: the squares of their changes then add up
    /// as those of the components do.
    pub(crate) fn are_apart(&self, nodes: &[NodeId]) -> bool {
        let seen =
            |node: &NodeId| self.0.get(node).unwrap_or(&ANY).iter().fold(0, |all, lane| all | lane);
        let counted: u32 = nodes.iter().map(|node| seen(node).count_ones()).sum();
        counted == nodes.iter().fold(0, |all, node| all | seen(node)).count_ones()
    }

    /// Lane by lane. What is no number of the point's own formula is taken to look at all of it.
    fn seen(&self, graph: &Graph, node: NodeId, level: u16) -> Seen {
        let of = |id: NodeId| match affine::is_fixed(graph, id, level) {
            true => [0; 4],
            false => self.0.get(&id).copied().unwrap_or(ANY),
        };
        let joined = |ids: &[NodeId]| {
            ids.iter()
                .map(|&id| of(id))
                .fold([0; 4], |all: Seen, seen| std::array::from_fn(|i| all[i] | seen[i]))
        };
        let mixed = |ids: &[NodeId]| [joined(ids).iter().fold(0, |x, y| x | y); 4];
        match graph.node(node) {
            Node::Const(_) | Node::Frame(..) => [0; 4],
            Node::Point(at, Dim::Three) if at == level => [1, 2, 4, 0],
            Node::Point(at, Dim::Two) if at == level => [1, 2, 0, 0],
            Node::Unary(Unary::Length | Unary::Normalize, a) => mixed(&[a]),
            Node::Unary(_, a) => of(a),
            Node::Binary(Binary::Dot | Binary::Cross, a, b) => mixed(&[a, b]),
            Node::Binary(_, a, b) => joined(&[a, b]),
            Node::Ternary(Ternary::Select, [condition, a, b]) => {
                joined(&[a, b]).map(|seen| seen | of(condition)[0])
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
            Node::Transform([a, b, c], v) => mixed(&[a, b, c, v]),
            Node::Sample(_, q) | Node::MaterialAt(_, q, _) => mixed(&[q]),
            Node::Point(..) | Node::Variable(..) | Node::Loop(..) | Node::Element(..) => ANY,
        }
    }
}
