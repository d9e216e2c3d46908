//! Which nodes a function needs, and how often each is written.

use rustc_hash::FxHashSet;
use sdfc_graph::{Binary, Graph, IdMap, IdSet, Node, NodeId, Type, Unary, schedule};

use super::inputs::Inputs;

/// The number of times that each node the roots need is written in the source.
#[derive(Debug)]
pub(crate) struct Uses {
    counts: IdMap<u32>,
    /// Nodes that loops read from outside. Without a name they would be computed in each iteration.
    named: FxHashSet<NodeId>,
    order: Vec<NodeId>,
}

impl Uses {
    /// Counts from the roots down. Nodes computed outside the shader need no operands.
    pub(crate) fn count(graph: &Graph, roots: &[NodeId], inputs: &Inputs) -> Self {
        let order = needed(graph, roots, inputs);
        let (mut counts, mut named) = (IdMap::default(), FxHashSet::default());
        let add = |counts: &mut IdMap<u32>, id, times| {
            *counts.entry(id).get_or_insert_default() += times;
        };
        for &root in roots {
            add(&mut counts, root, 1);
        }
        // Users have greater ids, so a node's count is complete when it is reached.
        for &id in order.iter().rev().filter(|&&id| !inputs.is_slot(id)) {
            let node = graph.node(id);
            // A component is repeated at each of its uses, and its vector with it.
            let times =
                if is_component(&node) { counts.get(id).unwrap_or(1) } else { repeats(&node) };
            for (position, operand) in operands(graph, id).enumerate() {
                let as_word =
                    position == 0 && reads_word(&node) && reads_word(&graph.node(operand));
                add(&mut counts, operand, if as_word { 0 } else { times });
                if graph.loops_around(id) & !graph.loops_around(operand) != 0 {
                    name(graph, operand, &mut named);
                }
            }
        }
        Self { counts, named, order }
    }

    /// The number of times that the node is written.
    pub(crate) fn of(&self, id: NodeId) -> u32 {
        self.counts.get(id).unwrap_or(0)
    }

    /// Returns true if the roots need the node.
    pub(crate) fn contains(&self, id: NodeId) -> bool {
        self.counts.get(id).is_some()
    }

    /// Returns true if the node needs a name even if it is written once.
    pub(crate) fn is_named(&self, id: NodeId) -> bool {
        self.named.contains(&id)
    }

    /// Takes the list of all nodes, operands before their uses. Call it once.
    pub(crate) fn take_order(&mut self) -> Vec<NodeId> {
        std::mem::take(&mut self.order)
    }
}

/// A component is as short as a name, so its vector gets the name.
fn name(graph: &Graph, id: NodeId, named: &mut FxHashSet<NodeId>) {
    if let Node::Swizzle(Type::Scalar, vector, _) = graph.node(id) {
        named.insert(vector);
    }
    named.insert(id);
}

/// The value in all lanes of a vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Uniform {
    /// The node.
    Node(NodeId),
    /// The number.
    Number(f64),
}

/// The two factors of a product. At most one, a scalar in all lanes, stands for a vector: `v * s`
/// needs no vector of `s`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Product {
    /// Both are read as they are.
    Plain,
    /// The left one is a scalar in all lanes.
    LeftUniform(Uniform),
    /// The right one is a scalar in all lanes.
    RightUniform(Uniform),
}

/// Returns the form in which the product of two nodes of one type is written.
pub(crate) fn product(graph: &Graph, left: NodeId, right: NodeId) -> Product {
    if graph.ty(left).width() == 1 {
        return Product::Plain;
    }
    match (uniform(graph, left), uniform(graph, right)) {
        (_, Some(right)) => Product::RightUniform(right),
        (Some(left), None) => Product::LeftUniform(left),
        (None, None) => Product::Plain,
    }
}

fn uniform(graph: &Graph, id: NodeId) -> Option<Uniform> {
    let node = graph.node(id);
    if let Node::Splat(_, scalar) = node {
        return Some(Uniform::Node(scalar));
    }
    let Node::Const(constant) = node else { return None };
    let lanes = &constant.lanes()[..constant.ty().width()];
    lanes.iter().all(|lane| *lane == lanes[0]).then_some(Uniform::Number(lanes[0]))
}

/// `members`, ascending, in an order in which few values are alive at once, operands first. `roots`
/// are read last.
pub(crate) fn scheduled(
    graph: &Graph,
    roots: &[NodeId],
    members: &[NodeId],
    inputs: &Inputs,
) -> Vec<NodeId> {
    schedule(graph, roots, members, |id| reads(graph, id, inputs))
}

/// The nodes that are computed before a node; for a loop those outside its body.
pub(crate) fn reads(graph: &Graph, id: NodeId, inputs: &Inputs) -> Vec<NodeId> {
    if inputs.is_slot(id) {
        Vec::new()
    } else if let Node::Loop(looped, ..) = graph.node(id) {
        graph.loop_inputs(looped)
    } else {
        operands(graph, id).collect()
    }
}

/// The nodes that the lowering of a node reads.
fn operands(graph: &Graph, id: NodeId) -> impl Iterator<Item = NodeId> {
    let (factors, arguments) = if let Node::Binary(Binary::Mul, left, right) = graph.node(id) {
        (factors(graph, left, right), None)
    } else {
        ([None; 2], Some(graph.arguments(id)))
    };
    factors.into_iter().flatten().chain(arguments.into_iter().flatten())
}

fn factors(graph: &Graph, left: NodeId, right: NodeId) -> [Option<NodeId>; 2] {
    match product(graph, left, right) {
        Product::Plain => [Some(left), Some(right)],
        Product::LeftUniform(uniform) => [uniform.node(), Some(right)],
        Product::RightUniform(uniform) => [Some(left), uniform.node()],
    }
}

impl Uniform {
    fn node(self) -> Option<NodeId> {
        match self {
            Self::Node(node) => Some(node),
            Self::Number(_) => None,
        }
    }
}

/// Returns true if the node is one component of a vector: `q.x` is as short as a name.
pub(crate) fn is_component(node: &Node) -> bool {
    matches!(node, Node::Swizzle(Type::Scalar, ..))
}

/// The number of times that the lowering of a node writes each operand.
fn repeats(node: &Node) -> u32 {
    match node {
        Node::Unary(Unary::Normalize, _) | Node::Binary(Binary::Rem, ..) => 2,
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
        | Node::MaterialAt(..) => 1,
    }
}

/// The nodes that the lowering of the roots reads, operands first.
fn needed(graph: &Graph, roots: &[NodeId], inputs: &Inputs) -> Vec<NodeId> {
    let mut seen = IdSet::default();
    let mut pending = roots.to_vec();
    while let Some(id) = pending.pop() {
        if seen.insert(id) && !inputs.is_slot(id) {
            pending.extend(operands(graph, id));
        }
    }
    seen.to_vec()
}

/// Returns true if a node reads its first argument as a word.
fn reads_word(node: &Node) -> bool {
    matches!(node, Node::Binary(Binary::Hash, ..))
}
