//! Copies of parts of a graph.
//!
//! Some questions need new nodes: a Lipschitz constant of a box needs the gradient, a test of a
//! clause needs the expanded formula. [`Graph::extract`] copies what such a question is about into
//! a graph of its own, so that the original is only read.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::graph::{Graph, LipschitzClaim};
use crate::ids::{IdMap, IdSet};
use crate::node::{LoopId, Node, NodeId, ShapeId, TableId};
use crate::shape::{Arg, MaterialRule, Shape};

/// A copy of a part of a graph. Ids have the same order as in the original.
#[derive(Clone, Debug)]
pub struct Extract {
    /// The copy.
    pub graph: Graph,
    ids: Ids,
}

impl Extract {
    /// The copy of a node; `None` if the node is not a part of the extract.
    pub fn node(&self, id: NodeId) -> Option<NodeId> {
        self.ids.nodes.get(id)
    }

    /// The copy of a shape; `None` if the shape is not a part of the extract.
    pub fn shape(&self, id: ShapeId) -> Option<ShapeId> {
        self.ids.shapes.get(&id).copied()
    }
}

impl Graph {
    /// Copies the given nodes and shapes and all that they depend on: arguments, loops, tables,
    /// sampled shapes with their contracts and materials, and Lipschitz claims.
    pub fn extract(&self, nodes: &[NodeId], shapes: &[ShapeId]) -> Extract {
        let (nodes, shapes) = self.dependencies(nodes, shapes);
        let ids = self.new_ids(&nodes, &shapes);
        let mut graph = Self::new();
        for &id in &ids.old_loops {
            graph.intern_loop(self.loop_at(id).map(|node| ids.node(node)));
        }
        for &id in &ids.old_tables {
            graph.intern_table(self.shared_table(id));
        }
        for &id in &nodes {
            graph.adopt(ids.in_node(self.node(id)), self, id);
            if let Some(LipschitzClaim { lipschitz, arguments }) = self.lipschitz_claim(id) {
                let lipschitz = ids.node(*lipschitz);
                let arguments = arguments.iter().map(|&argument| ids.node(argument)).collect();
                graph.adopt_claim(ids.node(id), LipschitzClaim { lipschitz, arguments });
            }
        }
        for &id in &shapes {
            graph.add_shape(ids.in_shape(self.shape(id)));
        }
        Extract { graph, ids }
    }

    /// All nodes and shapes that the given ones depend on, in ascending order.
    fn dependencies(&self, nodes: &[NodeId], shapes: &[ShapeId]) -> (Vec<NodeId>, Vec<ShapeId>) {
        let (mut found, mut found_shapes) = (IdSet::default(), FxHashSet::default());
        let (mut pending, mut pending_shapes) = (nodes.to_vec(), shapes.to_vec());
        loop {
            if let Some(id) = pending.pop() {
                if found.insert(id) {
                    pending.extend(self.arguments(id));
                    pending_shapes.extend(sampled_shape(self.node(id)));
                    if let Some(claim) = self.lipschitz_claim(id) {
                        pending.push(claim.lipschitz);
                        pending.extend(&claim.arguments);
                    }
                }
            } else if let Some(id) = pending_shapes.pop() {
                if found_shapes.insert(id) {
                    shape_dependencies(self.shape(id), &mut pending, &mut pending_shapes);
                }
            } else {
                break;
            }
        }
        let mut shapes: Vec<ShapeId> = found_shapes.into_iter().collect();
        shapes.sort_unstable();
        (found.to_vec(), shapes)
    }

    /// Numbers nodes, shapes, loops and tables by their order in this graph.
    fn new_ids(&self, nodes: &[NodeId], shapes: &[ShapeId]) -> Ids {
        let (mut loops, mut tables) = (Vec::new(), Vec::new());
        for &id in nodes {
            if let Node::Loop(id, ..) = self.node(id) {
                loops.push(id);
            }
            if let Node::Element(id, ..) = self.node(id) {
                tables.push(id);
            }
        }
        loops.sort_unstable();
        loops.dedup();
        tables.sort_unstable();
        tables.dedup();
        Ids {
            nodes: (0..).zip(nodes).map(|(new, &old)| (old, NodeId(new))).collect(),
            shapes: (0..).zip(shapes).map(|(new, &old)| (old, ShapeId(new))).collect(),
            loops: (0..).zip(&loops).map(|(new, &old)| (old, LoopId(new))).collect(),
            tables: (0..).zip(&tables).map(|(new, &old)| (old, TableId(new))).collect(),
            old_loops: loops,
            old_tables: tables,
        }
    }
}

/// New ids by old ids.
#[derive(Clone, Debug)]
struct Ids {
    nodes: IdMap<NodeId>,
    shapes: FxHashMap<ShapeId, ShapeId>,
    loops: FxHashMap<LoopId, LoopId>,
    tables: FxHashMap<TableId, TableId>,
    /// The old ids of the loops, ascending.
    old_loops: Vec<LoopId>,
    /// The old ids of the tables, ascending.
    old_tables: Vec<TableId>,
}

impl Ids {
    /// The new id of a node. All nodes that are mapped are dependencies, so all have one.
    fn node(&self, id: NodeId) -> NodeId {
        self.nodes.get(id).unwrap_or(id)
    }

    /// The new id of a shape.
    fn shape(&self, id: ShapeId) -> ShapeId {
        self.shapes.get(&id).copied().unwrap_or(id)
    }

    /// The node with new ids.
    fn in_node(&self, node: Node) -> Node {
        let of = |id: NodeId| self.node(id);
        match node {
            Node::Const(_) | Node::Point(..) | Node::Frame(..) | Node::Variable(..) => node,
            Node::Unary(op, a) => Node::Unary(op, of(a)),
            Node::Binary(op, a, b) => Node::Binary(op, of(a), of(b)),
            Node::Ternary(op, arguments) => Node::Ternary(op, arguments.map(of)),
            Node::Splat(ty, a) => Node::Splat(ty, of(a)),
            Node::Compose(ty, parts) => Node::Compose(ty, parts.map(of)),
            Node::Swizzle(ty, a, lanes) => Node::Swizzle(ty, of(a), lanes),
            Node::Transform(columns, v) => Node::Transform(columns.map(of), of(v)),
            Node::Loop(id, position, ty) => {
                Node::Loop(self.loops.get(&id).copied().unwrap_or(id), position, ty)
            }
            Node::Element(id, at, ty) => {
                Node::Element(self.tables.get(&id).copied().unwrap_or(id), of(at), ty)
            }
            Node::Sample(shape, q) => Node::Sample(self.shape(shape), of(q)),
            Node::MaterialAt(shape, q, field) => Node::MaterialAt(self.shape(shape), of(q), field),
        }
    }

    /// The argument of a shape with new ids.
    fn in_arg(&self, arg: &Arg) -> Arg {
        match arg {
            Arg::Node(id) => Arg::Node(self.node(*id)),
            Arg::Shape(id) => Arg::Shape(self.shape(*id)),
            Arg::List(list) => Arg::List(list.iter().map(|arg| self.in_arg(arg)).collect()),
            Arg::Text(text) => Arg::Text(text.clone()),
            Arg::Function(number) => Arg::Function(*number),
        }
    }

    /// The shape with new ids.
    fn in_shape(&self, shape: &Shape) -> Shape {
        let of = |id: NodeId| self.node(id);
        let contract = shape.contract.map(of);
        Shape {
            definition: shape.definition.clone(),
            dim: shape.dim,
            level: shape.level,
            args: shape.args.iter().map(|arg| self.in_arg(arg)).collect(),
            formula: of(shape.formula),
            contract,
            intersect: shape.intersect.iter().map(|ends| ends.map(of)).collect(),
            material: match shape.material {
                MaterialRule::Weighted(node) => MaterialRule::Weighted(of(node)),
                MaterialRule::Explicit(fields) => MaterialRule::Explicit(fields.map(of)),
            },
            children: shape.children.iter().map(|&child| self.shape(child)).collect(),
            depth: shape.depth,
            name: shape.name.clone(),
        }
    }
}

/// The shape that a node samples.
fn sampled_shape(node: Node) -> Option<ShapeId> {
    match node {
        Node::Sample(shape, _) | Node::MaterialAt(shape, ..) => Some(shape),
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
        | Node::Element(..) => None,
    }
}

/// Adds the nodes and shapes that a shape mentions.
fn shape_dependencies(shape: &Shape, nodes: &mut Vec<NodeId>, shapes: &mut Vec<ShapeId>) {
    nodes.push(shape.formula);
    nodes.extend(shape.contract.nodes());
    nodes.extend(shape.intersect.as_flattened());
    match shape.material {
        MaterialRule::Weighted(node) => nodes.push(node),
        MaterialRule::Explicit(fields) => nodes.extend(fields),
    }
    shapes.extend(&shape.children);
    let mut args: Vec<&Arg> = shape.args.iter().collect();
    while let Some(arg) = args.pop() {
        match arg {
            Arg::Node(id) => nodes.push(*id),
            Arg::Shape(id) => shapes.push(*id),
            Arg::List(list) => args.extend(list),
            Arg::Text(_) | Arg::Function(_) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::dump::dump;
    use crate::expand::Expander;
    use crate::graph::Graph;
    use crate::loops::{Loop, Table};
    use crate::node::{Const, Dim, LoopVar, NodeId, Type};
    use crate::shape::{Arg, Contract, MaterialRule, Shape};

    fn shape(definition: &str, formula: NodeId, args: Vec<Arg>) -> Shape {
        Shape {
            definition: definition.to_owned(),
            dim: Dim::Three,
            level: 0,
            args,
            formula,
            contract: Contract::default(),
            intersect: Vec::new(),
            material: MaterialRule::Weighted(formula),
            children: Vec::new(),
            depth: 1,
            name: None,
        }
    }

    /// The least of a table's elements, minus the length of the point.
    fn looped(graph: &mut Graph) -> NodeId {
        let index = graph.variable(0, LoopVar::Index, Type::Scalar);
        let state = graph.variable(0, LoopVar::State(0), Type::Scalar);
        let elements = [3.0, 2.0, 5.0].map(|number| Const::new(Type::Scalar, &[number])).to_vec();
        let element = graph.element(Table { ty: Type::Scalar, elements }, index);
        let (init, step) = (graph.number(9.0), graph.min(state, element));
        let body = Loop {
            depth: 0,
            max_iterations: 3,
            count: None,
            condition: None,
            init: vec![init],
            step: vec![step],
            skip: None,
        };
        let least = graph.add_loop(body)[0];
        let point = graph.point(0, Dim::Three);
        let length = graph.length(point);
        graph.sub(least, length)
    }

    #[test]
    fn an_extract_holds_the_same_formulas_and_nothing_else() {
        let mut graph = Graph::new();
        let unused = graph.point(7, Dim::Two);
        let field = looped(&mut graph);
        let extract = graph.extract(&[field], &[]);
        let copy = extract.node(field).expect("the field was extracted");
        assert_eq!(dump(&extract.graph, &[("field", copy)]), dump(&graph, &[("field", field)]));
        assert_eq!(extract.node(unused), None);
        assert!(extract.graph.len() < graph.len());
    }

    #[test]
    fn an_extracted_shape_expands_like_the_original() {
        let mut graph = Graph::new();
        graph.point(7, Dim::Two);
        let point = graph.point(0, Dim::Three);
        let formula = looped(&mut graph);
        let inner = graph.add_shape(shape("inner", formula, Vec::new()));
        let twice = graph.add(point, point);
        let sample = graph.sample(inner, twice);
        let args = vec![Arg::List(vec![Arg::Shape(inner)])];
        let outer = Shape { children: vec![inner], ..shape("outer", sample, args) };
        let outer = graph.add_shape(outer);

        let mut extract = graph.extract(&[], &[outer]);
        let copy = extract.shape(outer).expect("the shape was extracted");
        let own = extract.graph.point(0, Dim::Three);
        let copied = Expander::new().field(&mut extract.graph, copy, own).expect("few nodes");
        let field = Expander::new().field(&mut graph, outer, point).expect("few nodes");
        assert_eq!(dump(&extract.graph, &[("field", copied)]), dump(&graph, &[("field", field)]));
    }
}
