//! The shapes of a scene at one frame, with numbers in place of params and of the clock.
//!
//! Questions about one frame, such as the box that a camera is fitted to, have tighter answers than
//! questions about all values that params can have.

use rustc_hash::FxHashMap;

use crate::eval::FrameValues;
use crate::graph::Graph;
use crate::node::{Node, NodeId, ShapeId};
use crate::scene::Scene;
use crate::shape::{Arg, Shape};

impl Scene {
    /// Returns the drawn shapes at a frame: a graph of their own and the root in it. It has no
    /// per-frame inputs. Intersections with rays are left out. `None` if nothing is drawn.
    pub fn shapes_at(&self, frame: &FrameValues) -> Option<(Graph, ShapeId)> {
        let root = self.root?;
        let extract = self.graph.extract(&[], &[root]);
        let root = extract.shape(root)?;
        let mut graph = extract.graph;
        let mut at_frame =
            AtFrame { graph: &mut graph, frame, nodes: Vec::new(), shapes: FxHashMap::default() };
        at_frame.all_nodes();
        let root = at_frame.shape(root);
        Some((graph, root))
    }
}

/// The replacement in progress.
struct AtFrame<'a> {
    graph: &'a mut Graph,
    frame: &'a FrameValues,
    /// The new node for each old one.
    nodes: Vec<NodeId>,
    /// The new shape for each old one that was needed.
    shapes: FxHashMap<ShapeId, ShapeId>,
}

impl AtFrame<'_> {
    /// Replaces all nodes in order. A sample comes after the formula of the shape that it samples.
    fn all_nodes(&mut self) {
        let old: Vec<NodeId> = self.graph.ids().collect();
        self.nodes.reserve(old.len());
        for id in old {
            let new = self.replaced(id);
            self.nodes.push(new);
        }
    }

    fn node(&self, old: NodeId) -> NodeId {
        self.nodes.get(old.index()).copied().unwrap_or(old)
    }

    fn replaced(&mut self, id: NodeId) -> NodeId {
        match self.graph.node(id) {
            Node::Frame(input, ty) => {
                let lanes = [0, 1, 2, 3].map(|lane| self.frame.lane(input, lane));
                self.graph.constant(ty, &lanes[..ty.width()])
            }
            Node::Sample(shape, point) => {
                let (shape, point) = (self.shape(shape), self.node(point));
                self.graph.sample(shape, point)
            }
            Node::MaterialAt(shape, point, field) => {
                let (shape, point) = (self.shape(shape), self.node(point));
                self.graph.material_at(shape, point, field)
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)
            | Node::Splat(..)
            | Node::Compose(..)
            | Node::Swizzle(..)
            | Node::Transform(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Element(..) => {
                let nodes = &self.nodes;
                self.graph.rebuild(id, |old| nodes.get(old.index()).copied().unwrap_or(old))
            }
        }
    }

    /// The new shape. The nodes of its formula have been replaced before.
    fn shape(&mut self, old: ShapeId) -> ShapeId {
        if let Some(&new) = self.shapes.get(&old) {
            return new;
        }
        let shape = self.graph.shape(old).clone();
        let formula = self.node(shape.formula);
        let contract = shape.contract.map(|node| self.node(node));
        let children = shape.children.iter().map(|&child| self.shape(child)).collect();
        // The old shape as an argument keeps different shapes apart.
        let args = vec![Arg::Shape(old)];
        let intersect = Vec::new();
        let new =
            self.graph.add_shape(Shape { formula, contract, children, args, intersect, ..shape });
        self.shapes.insert(old, new);
        new
    }
}
