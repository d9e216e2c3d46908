//! Which affine operations lead to which head.

use crate::ids::{IdMap, IdSet};
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
        let affine = affine_nodes(graph, order);
        for &id in order.iter().rev().filter(|&&id| graph.stage(id) == Stage::Point) {
            let cost = affine_cost(graph, id).filter(|_| affine.contains(id));
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
            for argument in graph.arguments(id) {
                // What a loop does not change is computed outside it.
                let outside = graph.loops(argument) != graph.loops(id);
                let used = if outside { Use::Shared } else { used };
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

/// The numbers that a node is a map of: a vector's component, or a node itself.
#[derive(Clone, Copy)]
struct Sources {
    list: [Option<(NodeId, u8)>; 3],
    /// It is a number that no affine operation made.
    bare: bool,
}

impl Sources {
    fn own(graph: &Graph, id: NodeId) -> Self {
        let width = graph.ty(id).width();
        let list = [0, 1, 2].map(|lane| (usize::from(lane) < width).then_some((id, lane)));
        Self { list, bare: width == 1 }
    }

    /// False if there is no room.
    fn include(&mut self, other: &Self) -> bool {
        other.list.iter().flatten().all(|&source| {
            let free = |known: &Option<_>| known.is_none_or(|known| known == source);
            let place = self.list.iter_mut().find(|known| free(known));
            place.map(|place| *place = Some(source)).is_some()
        })
    }
}

/// The operations that are maps of at most three numbers. What would need more starts anew, as does the sum
/// of two numbers that no affine operation made: the turned components of a twist, not the products in them, are
/// what later maps start from.
fn affine_nodes(graph: &Graph, order: &[NodeId]) -> IdSet {
    let mut sources: IdMap<Sources> = IdMap::default();
    let mut affine = IdSet::default();
    for &id in order.iter().filter(|&&id| graph.stage(id) == Stage::Point) {
        let joined = affine_cost(graph, id).and_then(|_| joined_sources(graph, id, &sources));
        if joined.is_some() {
            affine.insert(id);
        }
        sources.insert(id, joined.unwrap_or_else(|| Sources::own(graph, id)));
    }
    affine
}

fn joined_sources(graph: &Graph, id: NodeId, sources: &IdMap<Sources>) -> Option<Sources> {
    let node = graph.node(id);
    if let Node::Swizzle(Type::Scalar, v, lanes) = node
        && sources.get(v)?.list[0] == Some((v, 0))
    {
        return Some(Sources { list: [Some((v, lanes[0])), None, None], bare: false });
    }
    let mut joined = Sources { list: [None; 3], bare: false };
    let mut bare = 0;
    for argument in graph.arguments(id).filter_map(|argument| sources.get(argument)) {
        bare += usize::from(argument.bare);
        if !joined.include(&argument) {
            return None;
        }
    }
    let sum = matches!(node, Node::Binary(Binary::Add | Binary::Sub, ..));
    (!sum || bare < 2).then_some(joined)
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
        | Node::Variable(..)
        | Node::Loop(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => None,
    }
}
