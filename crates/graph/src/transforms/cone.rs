//! Cones: which affine operations lead to which head.

use crate::graph::Graph;
use crate::ids::{IdMap, IdSet};
use crate::node::{Binary, Node, NodeId, Stage, Type, Unary};

/// Scalar operations of a 3x3 matrix times a vector, with fused additions.
pub(super) const TRANSFORM_COST: usize = 9;

/// The users of a node.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    /// Only the cone of this head uses it.
    By(NodeId),
    /// Several cones, or an operation that is not affine, use it.
    Shared,
}

/// The head of each node, and the costs of the heads' cones.
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
    /// Finds the cones. `order` is ascending and contains every node that the roots are computed
    /// from.
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
                let sum = cones.costs.entry(head).get_or_insert_default();
                sum.operations += 1;
                sum.numbers += numbers;
            }
            let used = if cost.is_some() { Use::By(head) } else { Use::Shared };
            for argument in graph.arguments(id) {
                // A node that a loop does not change is computed outside it.
                let outside = graph.loops_around(argument) != graph.loops_around(id);
                let used = if outside { Use::Shared } else { used };
                let known = uses.entry(argument).get_or_insert(used);
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

    /// True if the node's cone has more than one operation.
    pub(super) fn is_worth_folding(&self, id: NodeId) -> bool {
        let operations = |head| self.costs.get(head).map_or(0, |cost| cost.operations);
        self.heads.get(id).is_some_and(|head| operations(head) > 1)
    }

    /// Number of scalar operations in a head's cone.
    pub(super) fn cost(&self, head: NodeId) -> usize {
        self.costs.get(head).map_or(0, |cost| cost.numbers)
    }
}

/// The scalars that a node is an affine map of: components of a vector, or the node itself.
#[derive(Clone, Copy)]
struct Sources {
    list: [Option<(NodeId, u8)>; 3],
    /// True for a scalar that no affine operation computes.
    bare: bool,
}

impl Sources {
    fn own(graph: &Graph, id: NodeId) -> Self {
        let width = graph.ty(id).width();
        let list = [0, 1, 2].map(|lane| (usize::from(lane) < width).then_some((id, lane)));
        Self { list, bare: width == 1 }
    }

    /// Adds sources; false if they do not fit.
    fn include(&mut self, other: &Self) -> bool {
        other.list.iter().flatten().all(|&source| {
            let free = |known: &Option<_>| known.is_none_or(|known| known == source);
            let entry = self.list.iter_mut().find(|known| free(known));
            entry.map(|entry| *entry = Some(source)).is_some()
        })
    }
}

/// The operations that are affine maps of at most three scalars. An operation that would need more
/// starts a new cone, and so does the sum of two scalars that no affine operation computes: in a
/// twist, later maps start from the rotated components, not from the products in them.
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

/// Number of scalar operations; `None` if the operation is not affine in its point-dependent
/// arguments.
fn affine_cost(graph: &Graph, id: NodeId) -> Option<usize> {
    let width = graph.ty(id).width();
    let fixed = |id: NodeId| graph.stage(id) < Stage::Point;
    match graph.node(id) {
        _ if graph.ty(id) == Type::Vec4 => None,
        Node::Unary(Unary::Neg, _) | Node::Binary(Binary::Add | Binary::Sub, ..) => Some(width),
        Node::Binary(Binary::Mul, a, b) => (fixed(a) || fixed(b)).then_some(width),
        Node::Binary(Binary::Dot, a, b) => {
            (fixed(a) || fixed(b)).then(|| 2 * graph.ty(a).width() - 1)
        }
        Node::Transform(columns, _) => columns.into_iter().all(fixed).then_some(TRANSFORM_COST),
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
