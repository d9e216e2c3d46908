//! Which affine operations lead to which head.

use crate::ids::IdMap;
use crate::{Binary, Graph, Node, NodeId, Stage, Type, Unary};

/// Operations on single numbers of a 3x3 matrix times a vector, additions fused.
pub(super) const TRANSFORM_COST: usize = 9;

/// Who uses a node.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    /// Only the cone of this head.
    By(NodeId),
    /// Several cones, or something that is not affine.
    Shared,
}

/// The heads of all nodes and the costs of their cones.
pub(super) struct Cones {
    heads: IdMap<NodeId>,
    costs: IdMap<Cost>,
}

#[derive(Clone, Copy, Default)]
struct Cost {
    operations: usize,
    numbers: usize,
}

impl Cones {
    /// `order` is ascending and holds everything that the roots are computed from.
    pub(super) fn new(graph: &Graph, order: &[NodeId], roots: &[NodeId]) -> Self {
        let mut uses: IdMap<Use> = roots.iter().map(|&id| (id, Use::Shared)).collect();
        let mut cones = Self { heads: IdMap::default(), costs: IdMap::default() };
        for &id in order.iter().rev().filter(|&&id| graph.stage(id) == Stage::Point) {
            let cost = affine_cost(graph, id);
            let head = match (cost, uses.get(id)) {
                (Some(_), Some(Use::By(head))) => head,
                (Some(_), Some(Use::Shared) | None) | (None, _) => id,
            };
            cones.heads.insert(id, head);
            let numbers = cost.unwrap_or(0);
            if numbers > 0 {
                let sum = cones.costs.slot(head).get_or_insert_default();
                sum.operations += 1;
                sum.numbers += numbers;
            }
            let used = if cost.is_some() { Use::By(head) } else { Use::Shared };
            for argument in graph.node(id).arguments() {
                let known = uses.slot(argument).get_or_insert(used);
                if *known != used {
                    *known = Use::Shared;
                }
            }
        }
        cones
    }

    pub(super) fn is_head(&self, id: NodeId) -> bool {
        self.heads.get(id).is_none_or(|head| head == id)
    }

    /// Whether the node's cone has more than one operation.
    pub(super) fn is_worth_folding(&self, id: NodeId) -> bool {
        let operations = |head| self.costs.get(head).map_or(0, |cost| cost.operations);
        self.heads.get(id).is_some_and(|head| operations(head) > 1)
    }

    /// Operations on single numbers in a head's cone.
    pub(super) fn cost(&self, head: NodeId) -> usize {
        self.costs.get(head).map_or(0, |cost| cost.numbers)
    }
}

/// Operations on single numbers, where the operation is affine in what depends on the point.
fn affine_cost(graph: &Graph, id: NodeId) -> Option<usize> {
    let width = graph.ty(id).width();
    let low = |id: NodeId| graph.stage(id) < Stage::Point;
    match graph.node(id) {
        _ if graph.ty(id) == Type::Vec4 => None,
        Node::Unary(Unary::Neg, _) | Node::Binary(Binary::Add | Binary::Sub, ..) => Some(width),
        Node::Binary(Binary::Mul, a, b) => (low(a) || low(b)).then_some(width),
        Node::Binary(Binary::Dot, a, b) => (low(a) || low(b)).then(|| 2 * graph.ty(a).width() - 1),
        Node::Transform(columns, _) => columns.into_iter().all(low).then_some(TRANSFORM_COST),
        Node::Splat(..) | Node::Compose(..) | Node::Swizzle(..) => Some(0),
        Node::Const(_)
        | Node::Point(..)
        | Node::Frame(..)
        | Node::Unary(..)
        | Node::Binary(..)
        | Node::Ternary(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => None,
    }
}
