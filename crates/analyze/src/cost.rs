//! The cost of one evaluation, counted on the graph.

use sdfc_graph::{
    Expander, FormulaChoice, Graph, Loop, LoopId, Node, NodeId, ShapeId, Stage, fold_transforms,
    reachable_by,
};

/// Counts of operations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Nodes of any kind and evaluation rate.
    pub nodes: usize,
    /// Arithmetic operations at each point. A vector operation counts once, a swizzle not at all.
    /// The operations in a loop count as often as the loop may run.
    pub operations: usize,
    /// Operations that run once per frame.
    pub per_frame: usize,
}

/// The cost of evaluating `roots` together. Of values with two formulas, the one of shaders counts.
pub fn cost(graph: &Graph, roots: &[NodeId]) -> Cost {
    let mut cost = Cost::default();
    let nodes = reachable_by(graph, roots, FormulaChoice::Short);
    for &node in &nodes {
        cost.nodes += 1;
        if !is_arithmetic(&graph.node(node)) {
            continue;
        }
        match graph.stage(node) {
            Stage::Const => {}
            Stage::Frame => cost.per_frame += 1,
            Stage::Point if graph.loops_around(node) > 0 => {} // counted with its loop
            Stage::Point => cost.operations += 1,
        }
    }
    let outside = nodes.into_iter().filter(|&node| graph.loops_around(node) == 0);
    cost.operations += in_loops(graph, outside, |_| true);
    cost
}

/// The operations that run at every point: those of [`cost`] without the loops that may end early.
pub fn certain_operations(graph: &Graph, roots: &[NodeId]) -> usize {
    let outside = reachable_by(graph, roots, FormulaChoice::Short)
        .into_iter()
        .filter(|&node| graph.loops_around(node) == 0);
    let runs_to_its_end = |looped: &Loop| looped.condition.is_none();
    operations_outside_loops(graph, roots) + in_loops(graph, outside, runs_to_its_end)
}

/// The operations at each point that are in no loop.
pub(crate) fn operations_outside_loops(graph: &Graph, roots: &[NodeId]) -> usize {
    let is_counted = |&node: &NodeId| {
        graph.stage(node) == Stage::Point
            && graph.loops_around(node) == 0
            && is_arithmetic(&graph.node(node))
    };
    reachable_by(graph, roots, FormulaChoice::Short).into_iter().filter(is_counted).count()
}

/// The cost of evaluating shapes by themselves, each at its own point and without loops that stand
/// for similar operands. `None` if one is built inside the formula of another, or if the expansion
/// exceeds the node limit.
pub fn cost_of_shapes(graph: &Graph, shapes: &[ShapeId]) -> Option<Cost> {
    let mut extract = graph.extract(&[], shapes);
    let copies: Option<Vec<ShapeId>> = shapes.iter().map(|it| extract.shape(*it)).collect();
    let (graph, mut expander) = (&mut extract.graph, Expander::new());
    let mut roots = Vec::with_capacity(shapes.len());
    for shape in copies? {
        let point = graph.point(0, graph.shape(shape).dim);
        roots.push(expander.field(graph, shape, point).ok()?);
    }
    let folded = fold_transforms(graph, &roots);
    Some(cost(graph, &folded.roots))
}

/// The operations of those of the loops among some nodes that count.
fn in_loops(
    graph: &Graph,
    nodes: impl Iterator<Item = NodeId>,
    counts: fn(&Loop) -> bool,
) -> usize {
    let mut found: Vec<LoopId> = nodes
        .filter_map(|node| if let Node::Loop(id, ..) = graph.node(node) { Some(id) } else { None })
        .collect();
    found.sort_unstable();
    found.dedup();
    let counted = found.into_iter().filter(|&id| counts(graph.loop_at(id)));
    counted.map(|id| in_loop(graph, id, counts)).fold(0, usize::saturating_add)
}

/// The operations of all iterations of a loop.
fn in_loop(graph: &Graph, id: LoopId, counts: fn(&Loop) -> bool) -> usize {
    let body = graph.loop_body(id);
    let nodes: Vec<NodeId> = body.condition.into_iter().chain(body.step).collect();
    let own = nodes.iter().filter(|&&node| is_arithmetic(&graph.node(node))).count();
    let rest = in_loops(graph, nodes.into_iter(), counts);
    own.saturating_add(rest).saturating_mul(graph.loop_at(id).max_iterations as usize)
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
        | Node::Variable(..)
        | Node::Loop(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => false,
    }
}
