//! Near which values of a node a surface may lie.

use sdfc_graph::{
    Binary, Blends, Graph, IdMap, Node, NodeId, Stage, Ternary, Type, Unary, blend_at, reachable,
};

/// Blends' widths from which on an operand does not matter to a surface.
pub(super) const WIDTHS: f64 = 4.0;

/// What is between a node and the root.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Path {
    /// Hard minima alone.
    Hard,
    /// Minima and blends: where all that is joined is left out, nothing is seen that is not there.
    Joined,
    /// Something else.
    Other,
}

/// Where a node's value does not exceed `hi` after it was scaled, nor falls below `lo`, a surface may lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Near {
    /// What the value is multiplied by on its way to the root.
    pub(super) scale: f64,
    pub(super) lo: NodeId,
    pub(super) hi: NodeId,
    /// The widest of the blends that follow in the chain that the node is the start of.
    width: NodeId,
    pub(super) path: Path,
}

impl Near {
    /// The same of an operand of a chain of blends, the width of which is at least this.
    pub(super) fn of_chain(self, graph: &mut Graph, width: NodeId) -> Self {
        let widest = graph.max(self.width, width);
        let factor = graph.number(WIDTHS * self.scale);
        let more = graph.mul(widest, factor);
        let (lo, hi) = (graph.sub(self.lo, more), graph.add(self.hi, more));
        let is_joined = graph.as_number(more) != Some(0.0);
        let path = if is_joined { self.path.max(Path::Joined) } else { self.path };
        Self { lo, hi, width: graph.number(0.0), path, ..self }
    }

    /// Of what a chain was before a blend of this width.
    fn before(self, graph: &mut Graph, width: NodeId) -> Self {
        Self { width: graph.max(self.width, width), path: self.path.max(Path::Joined), ..self }
    }

    /// Of an argument that is taken as it is.
    fn inner(self, graph: &mut Graph) -> Self {
        let zero = graph.number(0.0);
        self.of_chain(graph, zero)
    }

    fn negated(self, graph: &mut Graph) -> Self {
        Self { lo: graph.neg(self.hi), hi: graph.neg(self.lo), path: Path::Other, ..self }
    }

    /// Of an argument to which a number is added.
    fn without(self, graph: &mut Graph, added: NodeId) -> Self {
        let scale = graph.number(self.scale);
        let added = graph.mul(added, scale);
        let (lo, hi) = (graph.sub(self.lo, added), graph.sub(self.hi, added));
        Self { lo, hi, path: Path::Other, ..self }
    }

    fn of_size(self, graph: &mut Graph) -> Self {
        Self { lo: graph.neg(self.hi), path: Path::Other, ..self }
    }

    fn scaled(self, factor: f64) -> Option<Self> {
        let scale = self.scale * factor;
        (factor > 0.0 && scale.is_finite()).then_some(Self { scale, path: Path::Other, ..self })
    }

    /// Of a node that is used in both ways.
    pub(super) fn joined(self, graph: &mut Graph, other: Self) -> Option<Self> {
        if self == other {
            return Some(self);
        }
        let lo = graph.min(self.lo, other.lo);
        let hi = graph.max(self.hi, other.hi);
        let (width, path) = (graph.max(self.width, other.width), self.path.max(other.path));
        (self.scale == other.scale).then_some(Self { lo, hi, width, path, ..self })
    }
}

/// What is known of the nodes that the roots are computed from: `Some(None)` of those that matter everywhere; nothing of
/// those that only what is a blend is computed from.
pub(super) fn near(graph: &mut Graph, roots: &[NodeId]) -> IdMap<Option<Near>> {
    let zero = graph.number(0.0);
    let at_root = Near { scale: 1.0, lo: zero, hi: zero, width: zero, path: Path::Hard };
    let (mut known, mut blends) = (IdMap::default(), Blends::default());
    for &root in roots {
        known.insert(root, Some(at_root));
    }
    // Uses before what they use.
    for id in reachable(graph, roots).into_iter().rev() {
        let Some(near) = known.get(id) else { continue };
        let arguments = near.and_then(|near| arguments(graph, &mut blends, id, near));
        let arguments = arguments
            .unwrap_or_else(|| graph.arguments(id).map(|argument| (argument, None)).collect());
        for (argument, near) in arguments {
            let near = match known.get(argument) {
                None => near,
                Some(other) => near.zip(other).and_then(|(a, b)| a.joined(graph, b)),
            };
            known.insert(argument, near);
        }
    }
    known
}

/// What a node makes of its arguments; `None`: of all, that they matter everywhere.
fn arguments(
    graph: &mut Graph,
    blends: &mut Blends,
    id: NodeId,
    near: Near,
) -> Option<Vec<(NodeId, Option<Near>)>> {
    if graph.ty(id) != Type::Scalar || graph.stage(id) < Stage::Point {
        return None;
    }
    if let Some(blend) = blend_at(graph, blends, id) {
        let [first, second] = blend.ordered_values(graph, blends);
        let before = near.before(graph, blend.width);
        let operand = near.of_chain(graph, blend.width);
        return Some(vec![(first, Some(before)), (second, Some(operand))]);
    }
    if let Node::Loop(repeated, ..) = graph.node(id) {
        let inert = graph.loop_at(repeated).skip?;
        let start = *graph.loop_at(repeated).init.first()?;
        let before = match graph.as_number(inert.margin) {
            Some(0.0) => near.inner(graph),
            _ => near.before(graph, inert.margin),
        };
        let rest = graph.arguments(id).filter(|&argument| argument != start);
        let mut all: Vec<_> = rest.map(|argument| (argument, None)).collect();
        all.push((start, Some(before)));
        return Some(all);
    }
    let near = near.inner(graph);
    Some(match graph.node(id) {
        Node::Binary(Binary::Min, a, b) => vec![(a, Some(near)), (b, Some(near))],
        Node::Binary(Binary::Max, a, b) => {
            let near = Near { path: Path::Other, ..near };
            vec![(a, Some(near)), (b, Some(near))]
        }
        Node::Unary(Unary::Neg, a) => vec![(a, Some(near.negated(graph)))],
        Node::Unary(Unary::Abs, a) => vec![(a, Some(near.of_size(graph)))],
        Node::Binary(Binary::Add, a, b) if graph.stage(b) < Stage::Point => {
            vec![(a, Some(near.without(graph, b)))]
        }
        Node::Binary(Binary::Add, a, b) if graph.stage(a) < Stage::Point => {
            vec![(b, Some(near.without(graph, a)))]
        }
        Node::Binary(Binary::Sub, a, b) if graph.stage(b) < Stage::Point => {
            let added = graph.neg(b);
            vec![(a, Some(near.without(graph, added)))]
        }
        Node::Binary(Binary::Sub, a, b) if graph.stage(a) < Stage::Point => {
            let added = graph.neg(a);
            let near = near.negated(graph).without(graph, added);
            vec![(b, Some(near))]
        }
        Node::Binary(Binary::Mul, a, b) => match (graph.as_number(a), graph.as_number(b)) {
            (None, Some(factor)) => vec![(a, near.scaled(factor))],
            (Some(factor), None) => vec![(b, near.scaled(factor))],
            _ => return None,
        },
        Node::Binary(Binary::Div, a, b) => {
            let factor = 1.0 / graph.as_number(b)?;
            vec![(a, near.scaled(factor))]
        }
        Node::Ternary(Ternary::Select, [condition, a, b])
            if graph.stage(condition) < Stage::Point =>
        {
            let near = Near { path: Path::Other, ..near };
            vec![(a, Some(near)), (b, Some(near))]
        }
        Node::Const(_)
        | Node::Point(..)
        | Node::Frame(..)
        | Node::Unary(..)
        | Node::Binary(..)
        | Node::Ternary(..)
        | Node::Splat(..)
        | Node::Compose(..)
        | Node::Swizzle(..)
        | Node::Transform(..)
        | Node::Variable(..)
        | Node::Loop(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => return None,
    })
}
