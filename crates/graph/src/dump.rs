//! Printing and counting nodes.

use std::fmt::Write;

use rustc_hash::FxHashMap;

use crate::graph::Graph;
use crate::ids::IdSet;
use crate::node::{Const, LoopVar, Node, NodeId, Stage, SurfaceVector, Type};
use crate::walk::reachable;

/// The nodes that the roots are computed from as text, one per line: `%3 = add %1 %2 : vec3`.
///
/// The numbers start at 0, and their order depends on the roots only. Constants are written where
/// they are used. Per-frame nodes are marked `frame`. The last lines name the roots.
///
/// ```
/// use sdfc_graph::{Dim, Graph, dump};
///
/// let mut graph = Graph::new();
/// let p = graph.point(0, Dim::Three);
/// let (length, radius) = (graph.length(p), graph.number(0.5));
/// let ball = graph.sub(length, radius);
/// assert_eq!(
///     dump(&graph, &[("distance", ball)]),
///     "%0 = point 0 : vec3\n\
///      %1 = length %0 : number\n\
///      %2 = sub %1 0.5 : number\n\
///      distance = %2\n"
/// );
/// ```
pub fn dump(graph: &Graph, roots: &[(&str, NodeId)]) -> String {
    let ids: Vec<NodeId> = roots.iter().map(|&(_, id)| id).collect();
    let mut numbers = FxHashMap::default();
    let mut text = String::new();
    for id in first_use_order(graph, &ids) {
        if matches!(graph.node(id), Node::Const(_)) {
            continue;
        }
        let number = numbers.len();
        numbers.insert(id, number);
        let frame = if graph.stage(id) == Stage::Frame { " frame" } else { "" };
        let ty = type_name(graph.ty(id));
        let operation = operation(graph, id, |argument| reference(graph, &numbers, argument));
        // Writing to a string cannot fail.
        let _ = writeln!(text, "%{number} = {operation} : {ty}{frame}");
    }
    for (name, id) in roots {
        let _ = writeln!(text, "{name} = {}", reference(graph, &numbers, *id));
    }
    text
}

/// Nodes with arguments before uses, from left to right, independent of the ids.
fn first_use_order(graph: &Graph, roots: &[NodeId]) -> Vec<NodeId> {
    let mut done = IdSet::default();
    let mut order = Vec::new();
    let mut stack: Vec<(NodeId, bool)> = roots.iter().rev().map(|&id| (id, false)).collect();
    while let Some((id, arguments_done)) = stack.pop() {
        if arguments_done {
            order.push(id);
        } else if done.insert(id) {
            stack.push((id, true));
            let arguments: Vec<NodeId> = graph.arguments(id).collect();
            stack.extend(arguments.into_iter().rev().map(|argument| (argument, false)));
        }
    }
    order
}

fn reference(graph: &Graph, numbers: &FxHashMap<NodeId, usize>, id: NodeId) -> String {
    match graph.node(id) {
        Node::Const(value) => constant(&value),
        Node::Point(..)
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
        | Node::MaterialAt(..) => match numbers.get(&id) {
            Some(number) => format!("%{number}"),
            None => format!("#{}", id.index()),
        },
    }
}

fn constant(value: &Const) -> String {
    let lanes = value.lanes();
    match value.ty() {
        Type::Bool => (lanes[0] != 0.0).to_string(),
        Type::Scalar => lanes[0].to_string(),
        Type::Vec2 | Type::Vec3 | Type::Vec4 => {
            let lanes: Vec<String> =
                lanes[..value.ty().width()].iter().map(f64::to_string).collect();
            format!("[{}]", lanes.join(", "))
        }
    }
}

fn operation(graph: &Graph, id: NodeId, reference: impl Fn(NodeId) -> String) -> String {
    let node = graph.node(id);
    let head = match node {
        Node::Const(value) => constant(&value),
        Node::Point(level, _) => match SurfaceVector::of_level(level) {
            Some(vector) => vector.name().to_owned(),
            None => format!("point {level}"),
        },
        Node::Frame(input, _) => format!("input {input:?}").to_lowercase(),
        Node::Unary(op, _) => format!("{op:?}").to_lowercase(),
        Node::Binary(op, ..) => format!("{op:?}").to_lowercase(),
        Node::Ternary(op, _) => format!("{op:?}").to_lowercase(),
        Node::Splat(..) => "splat".to_owned(),
        Node::Compose(..) => "compose".to_owned(),
        Node::Swizzle(ty, a, lanes) => {
            let letters: String = lanes[..ty.width()]
                .iter()
                .map(|&lane| ['x', 'y', 'z', 'w'][lane as usize])
                .collect();
            return format!("{}.{letters}", reference(a));
        }
        Node::Transform(..) => "transform".to_owned(),
        Node::Variable(depth, LoopVar::Index, _) => format!("iteration {depth}"),
        Node::Variable(depth, LoopVar::State(position), _) => format!("state {depth}.{position}"),
        Node::Loop(loop_, position, _) => {
            format!("loop {}.{position}", graph.loop_at(loop_).max_iterations)
        }
        Node::Element(table, ..) => format!("element {}", table.index()),
        Node::Sample(shape, _) => {
            format!("sample {}#{}", graph.shape(shape).definition, shape.index())
        }
        Node::MaterialAt(shape, _, field) => {
            format!("material {}#{} {field:?}", graph.shape(shape).definition, shape.index())
                .to_lowercase()
        }
    };
    graph.arguments(id).fold(head, |text, argument| text + " " + &reference(argument))
}

fn type_name(ty: Type) -> &'static str {
    match ty {
        Type::Bool => "bool",
        Type::Scalar => "number",
        Type::Vec2 => "vec2",
        Type::Vec3 => "vec3",
        Type::Vec4 => "vec4",
    }
}

/// Number of operations per point: nodes of stage `Point` that compute something. Points, swizzles,
/// splats and composed vectors are free; an operation on vectors counts once.
pub fn operation_count(graph: &Graph, roots: &[NodeId]) -> usize {
    let counts = |id: &NodeId| graph.stage(*id) == Stage::Point && is_operation(&graph.node(*id));
    reachable(graph, roots).iter().filter(|id| counts(id)).count()
}

fn is_operation(node: &Node) -> bool {
    match node {
        Node::Unary(..)
        | Node::Binary(..)
        | Node::Ternary(..)
        | Node::Transform(..)
        | Node::Element(..)
        | Node::Sample(..)
        | Node::MaterialAt(..) => true,
        Node::Const(_)
        | Node::Point(..)
        | Node::Frame(..)
        | Node::Variable(..)
        | Node::Loop(..)
        | Node::Splat(..)
        | Node::Compose(..)
        | Node::Swizzle(..) => false,
    }
}
