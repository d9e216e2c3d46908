//! What one evaluation costs, counted on the graph.

use sdfc_graph::{Graph, Node, NodeId, Stage, reachable};

/// Counts of what a root needs at each point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Nodes of any kind and stage.
    pub nodes: usize,
    /// Arithmetic operations at each point; a vector operation counts once, moving lanes about not at all.
    pub operations: usize,
    /// Operations done once per frame.
    pub per_frame: usize,
}

/// The cost of evaluating `roots` together.
pub fn cost(graph: &Graph, roots: &[NodeId]) -> Cost {
    let mut cost = Cost::default();
    for node in reachable(graph, roots) {
        cost.nodes += 1;
        if !is_arithmetic(&graph.node(node)) {
            continue;
        }
        match graph.stage(node) {
            Stage::Const => {}
            Stage::Frame => cost.per_frame += 1,
            Stage::Point => cost.operations += 1,
        }
    }
    cost
}

fn is_arithmetic(node: &Node) -> bool {
    match node {
        Node::Unary(..) | Node::Binary(..) | Node::Ternary(..) | Node::Transform(..) => true,
        Node::Const(_)
        | Node::Point(..)
        | Node::Frame(..)
        | Node::Splat(..)
        | Node::Compose(..)
        | Node::Swizzle(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => false,
    }
}
