//! The values of each node around which a surface may lie.

use sdfc_graph::{
    Binary, Blends, Graph, IdMap, Node, NodeId, Stage, Ternary, Type, Unary, blend_at, reachable,
};

/// Distance from the surface, in widths of a blend, at which an operand no longer affects it.
pub(super) const WIDTHS: f64 = 4.0;

/// The operations between a node and the root.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum BlendContext {
    /// Only hard minima.
    Hard,
    /// Minima and blends: skipping all operands removes surface but never adds any.
    Joined,
    /// Other operations too.
    Other,
}

/// The range of a node's scaled value, from `lo` to `hi`, within which a surface may lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ActiveRange {
    /// The factor by which the value is multiplied on its way to the root.
    pub(super) scale: f64,
    pub(super) lo: NodeId,
    pub(super) hi: NodeId,
    /// The largest width of the blends that follow in the chain that starts with the node.
    width: NodeId,
    pub(super) context: BlendContext,
}

impl ActiveRange {
    /// The range of an operand that is blended with at least this width.
    pub(super) fn of_chain(self, graph: &mut Graph, width: NodeId) -> Self {
        let widest = graph.max(self.width, width);
        let factor = graph.number(WIDTHS * self.scale);
        let more = graph.mul(widest, factor);
        let (lo, hi) = (graph.sub(self.lo, more), graph.add(self.hi, more));
        let is_joined = graph.as_number(more) != Some(0.0);
        let context = if is_joined { self.context.max(BlendContext::Joined) } else { self.context };
        Self { lo, hi, width: graph.number(0.0), context, ..self }
    }

    /// The range of a chain's value before a blend of this width.
    fn before(self, graph: &mut Graph, width: NodeId) -> Self {
        Self {
            width: graph.max(self.width, width),
            context: self.context.max(BlendContext::Joined),
            ..self
        }
    }

    /// The range of an argument whose value is passed on unchanged.
    fn inner(self, graph: &mut Graph) -> Self {
        let zero = graph.number(0.0);
        self.of_chain(graph, zero)
    }

    /// The range of an argument that is negated.
    fn negated(self, graph: &mut Graph) -> Self {
        Self {
            lo: graph.neg(self.hi),
            hi: graph.neg(self.lo),
            context: BlendContext::Other,
            ..self
        }
    }

    /// The range of an argument to which `added` is added.
    fn without(self, graph: &mut Graph, added: NodeId) -> Self {
        let scale = graph.number(self.scale);
        let added = graph.mul(added, scale);
        let (lo, hi) = (graph.sub(self.lo, added), graph.sub(self.hi, added));
        Self { lo, hi, context: BlendContext::Other, ..self }
    }

    /// The range of an argument of which the absolute value is taken.
    fn of_abs(self, graph: &mut Graph) -> Self {
        Self { lo: graph.neg(self.hi), context: BlendContext::Other, ..self }
    }

    /// The range of an argument that is multiplied by a factor; `None` unless that is positive.
    fn scaled(self, factor: f64) -> Option<Self> {
        let scale = self.scale * factor;
        (factor > 0.0 && scale.is_finite()).then_some(Self {
            scale,
            context: BlendContext::Other,
            ..self
        })
    }

    /// The range of a node with two uses.
    pub(super) fn union(self, graph: &mut Graph, other: Self) -> Option<Self> {
        if self == other {
            return Some(self);
        }
        let lo = graph.min(self.lo, other.lo);
        let hi = graph.max(self.hi, other.hi);
        let (width, context) =
            (graph.max(self.width, other.width), self.context.max(other.context));
        (self.scale == other.scale).then_some(Self { lo, hi, width, context, ..self })
    }
}

/// The active range of each node that the roots depend on. `Some(None)`: the node is relevant
/// everywhere. Nodes that are used only inside the formula of a blend are absent.
pub(super) fn active_ranges(graph: &mut Graph, roots: &[NodeId]) -> IdMap<Option<ActiveRange>> {
    let zero = graph.number(0.0);
    let at_root =
        ActiveRange { scale: 1.0, lo: zero, hi: zero, width: zero, context: BlendContext::Hard };
    let (mut known, mut blends) = (IdMap::default(), Blends::default());
    for &root in roots {
        known.insert(root, Some(at_root));
    }
    // Uses before their arguments.
    for id in reachable(graph, roots).into_iter().rev() {
        let Some(range) = known.get(id) else { continue };
        let arguments = range.and_then(|range| arguments(graph, &mut blends, id, range));
        let arguments = arguments
            .unwrap_or_else(|| graph.arguments(id).map(|argument| (argument, None)).collect());
        for (argument, range) in arguments {
            let range = match known.get(argument) {
                None => range,
                Some(other) => range.zip(other).and_then(|(a, b)| a.union(graph, b)),
            };
            known.insert(argument, range);
        }
    }
    known
}

/// The active ranges of a node's arguments. Returns `None` if all of them are relevant everywhere.
fn arguments(
    graph: &mut Graph,
    blends: &mut Blends,
    id: NodeId,
    range: ActiveRange,
) -> Option<Vec<(NodeId, Option<ActiveRange>)>> {
    if graph.ty(id) != Type::Scalar || graph.stage(id) < Stage::Point {
        return None;
    }
    if let Some(blend) = blend_at(graph, blends, id) {
        let [first, second] = blend.ordered_values(graph, blends);
        let before = range.before(graph, blend.width);
        let operand = range.of_chain(graph, blend.width);
        return Some(vec![(first, Some(before)), (second, Some(operand))]);
    }
    if let Node::Loop(body, ..) = graph.node(id) {
        let skip = graph.loop_at(body).skip?;
        let start = *graph.loop_at(body).init.first()?;
        let before = match graph.as_number(skip.margin) {
            Some(0.0) => range.inner(graph),
            _ => range.before(graph, skip.margin),
        };
        let rest = graph.arguments(id).filter(|&argument| argument != start);
        let mut all: Vec<_> = rest.map(|argument| (argument, None)).collect();
        all.push((start, Some(before)));
        return Some(all);
    }
    let range = range.inner(graph);
    Some(match graph.node(id) {
        Node::Binary(Binary::Min, a, b) => vec![(a, Some(range)), (b, Some(range))],
        Node::Binary(Binary::Max, a, b) => {
            let range = ActiveRange { context: BlendContext::Other, ..range };
            vec![(a, Some(range)), (b, Some(range))]
        }
        Node::Unary(Unary::Neg, a) => vec![(a, Some(range.negated(graph)))],
        Node::Unary(Unary::Abs, a) => vec![(a, Some(range.of_abs(graph)))],
        Node::Binary(Binary::Add, a, b) if graph.stage(b) < Stage::Point => {
            vec![(a, Some(range.without(graph, b)))]
        }
        Node::Binary(Binary::Add, a, b) if graph.stage(a) < Stage::Point => {
            vec![(b, Some(range.without(graph, a)))]
        }
        Node::Binary(Binary::Sub, a, b) if graph.stage(b) < Stage::Point => {
            let added = graph.neg(b);
            vec![(a, Some(range.without(graph, added)))]
        }
        Node::Binary(Binary::Sub, a, b) if graph.stage(a) < Stage::Point => {
            let added = graph.neg(a);
            let range = range.negated(graph).without(graph, added);
            vec![(b, Some(range))]
        }
        Node::Binary(Binary::Mul, a, b) => match (graph.as_number(a), graph.as_number(b)) {
            (None, Some(factor)) => vec![(a, range.scaled(factor))],
            (Some(factor), None) => vec![(b, range.scaled(factor))],
            _ => return None,
        },
        Node::Binary(Binary::Div, a, b) => {
            let factor = 1.0 / graph.as_number(b)?;
            vec![(a, range.scaled(factor))]
        }
        Node::Ternary(Ternary::Select, [condition, a, b])
            if graph.stage(condition) < Stage::Point =>
        {
            let range = ActiveRange { context: BlendContext::Other, ..range };
            vec![(a, Some(range)), (b, Some(range))]
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
