//! Shape keys: numbers that are equal for nodes that are equal up to constants.
//!
//! A per-frame value may count as a constant: lists hold its factors as a linear function. So may
//! the contents of a list, and the largest number of iterations of a loop.

use rustc_hash::FxHashMap;
use sdfc_graph::{Binary, Graph, IdMap, Node, NodeId, Stage, Ternary, Type, Unary, reachable};

use crate::reroll::linear::{Linear, Linears};

/// An operation without its arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Operation {
    Unary(Unary),
    Binary(Binary),
    Ternary(Ternary),
    Splat(Type),
    Compose(Type),
    Swizzle(Type, [u8; 4]),
    Transform,
    /// An element of a list. The list may differ.
    Element(Type),
    /// A part of the state after a loop. The arguments are the initial values, the steps and the
    /// condition.
    Loop(LoopForm, u16),
}

/// A loop without its nodes and its largest number of iterations, which may differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct LoopForm {
    pub(super) depth: u8,
    /// Number of parts of the state.
    pub(super) parts: usize,
    pub(super) count: Option<NodeId>,
    has_condition: bool,
}

/// The structure of a node without its constants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Structure {
    /// Any constant of a type, or any value that counts as one.
    Constant(Type),
    /// Exactly this node.
    Same(NodeId),
    /// An operation and the keys of its first arguments.
    Operation(u32, [u32; 4]),
    /// The key of an operation with its first arguments, and the keys of more.
    More(u32, [u32; 4]),
}

/// A node as an operation and its arguments. The arguments of sums and products are in an order
/// that does not depend on the order in which they were built.
pub(super) enum View {
    /// A constant, or a value that counts as one, which may differ between similar nodes.
    Constant,
    /// A node that must be the same in all similar nodes.
    Same,
    /// An operation with arguments.
    Operation(Operation, Vec<NodeId>),
}

/// The per-frame values in which similar nodes may differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum PerFrame {
    /// All that have a finite range.
    #[default]
    Any,
    /// Linear functions of params and time. Other values have the same structure.
    Linear,
    /// None.
    Same,
}

/// Shape keys: numbers that are equal for nodes that are equal up to constants.
#[derive(Debug, Default)]
pub(super) struct ShapeKeys {
    known: IdMap<u32>,
    keys: FxHashMap<Structure, u32>,
    operations: FxHashMap<Operation, u32>,
    linears: Linears,
    per_frame: PerFrame,
}

impl ShapeKeys {
    /// Keys of nodes that differ in fewer per-frame values; `None` if these differ in none.
    pub(super) fn stricter(&self) -> Option<Self> {
        let per_frame = match self.per_frame {
            PerFrame::Any => PerFrame::Linear,
            PerFrame::Linear => PerFrame::Same,
            PerFrame::Same => return None,
        };
        let mut stricter = Self { per_frame, ..Self::default() };
        stricter.linears.of_raw_inputs = true;
        Some(stricter)
    }

    /// Computes the keys of all nodes that the roots depend on.
    pub(super) fn compute(&mut self, graph: &mut Graph, roots: &[NodeId]) {
        for id in reachable(graph, roots) {
            self.compute_one(graph, id);
        }
    }

    /// The key of a node; `u32::MAX` if it was not computed.
    pub(super) fn of(&self, id: NodeId) -> u32 {
        self.known.get(id).unwrap_or(u32::MAX)
    }

    fn compute_one(&mut self, graph: &mut Graph, id: NodeId) {
        if self.known.get(id).is_some() {
            return;
        }
        let structure = match self.view(graph, id) {
            View::Constant => Structure::Constant(graph.ty(id)),
            View::Same => Structure::Same(id),
            View::Operation(operation, arguments) => {
                let next = self.operations.len() as u32;
                let operation = *self.operations.entry(operation).or_insert(next);
                let of_argument = |argument| {
                    // The view negates constants, so this one may be new.
                    if self.known.get(argument).is_none() {
                        self.compute_one(graph, argument);
                    }
                    self.of(argument)
                };
                let keys: Vec<u32> = arguments.into_iter().map(of_argument).collect();
                let four = |at: usize| [0, 1, 2, 3].map(|i| *keys.get(at + i).unwrap_or(&u32::MAX));
                let mut structure = Structure::Operation(operation, four(0));
                for at in (4..keys.len()).step_by(4) {
                    structure = Structure::More(self.key(structure), four(at));
                }
                structure
            }
        };
        let key = self.key(structure);
        self.known.insert(id, key);
    }

    fn key(&mut self, structure: Structure) -> u32 {
        let next = self.keys.len() as u32;
        *self.keys.entry(structure).or_insert(next)
    }

    /// A per-frame value that counts as a constant, as a linear function.
    pub(super) fn linear(&mut self, graph: &mut Graph, id: NodeId) -> Option<Linear> {
        match self.per_frame {
            PerFrame::Any | PerFrame::Linear => self.linears.of(graph, id),
            PerFrame::Same => None,
        }
    }

    /// True for a constant, or a value that counts as one.
    fn is_constant(&mut self, graph: &mut Graph, id: NodeId) -> bool {
        graph.as_const(id).is_some() || self.linear(graph, id).is_some()
    }

    /// Takes a node apart.
    pub(super) fn view(&mut self, graph: &mut Graph, id: NodeId) -> View {
        if graph.stage(id) < Stage::Point && graph.ty(id) == Type::Bool {
            return View::Same;
        }
        if self.is_constant(graph, id) {
            return View::Constant;
        }
        if self.per_frame == PerFrame::Same && graph.stage(id) < Stage::Point {
            return View::Same;
        }
        let node = graph.node(id);
        let arguments: Vec<NodeId> = graph.arguments(id).collect();
        let operation = match node {
            Node::Unary(op, _) => Operation::Unary(op),
            Node::Binary(Binary::Sub, a, b) if self.is_constant(graph, b) => {
                let b = graph.neg(b);
                return View::Operation(Operation::Binary(Binary::Add), self.sorted(graph, a, b));
            }
            Node::Binary(op @ (Binary::Add | Binary::Mul), a, b) => {
                return View::Operation(Operation::Binary(op), self.sorted(graph, a, b));
            }
            Node::Binary(op, ..) => Operation::Binary(op),
            Node::Ternary(op, _) => Operation::Ternary(op),
            Node::Splat(ty, _) => Operation::Splat(ty),
            Node::Compose(ty, _) => Operation::Compose(ty),
            Node::Swizzle(ty, _, lanes) => Operation::Swizzle(ty, lanes),
            Node::Transform(..) => Operation::Transform,
            Node::Element(_, _, ty) => Operation::Element(ty),
            Node::Loop(id, part, _) if graph.loop_at(id).skip.is_none() => {
                let looped = graph.loop_at(id);
                let form = LoopForm {
                    depth: looped.depth,
                    parts: looped.init.len(),
                    count: looped.count,
                    has_condition: looped.condition.is_some(),
                };
                let nodes = looped.init.iter().chain(&looped.step).chain(&looped.condition);
                return View::Operation(Operation::Loop(form, part), nodes.copied().collect());
            }
            Node::Const(_)
            | Node::Point(..)
            | Node::Frame(..)
            | Node::Variable(..)
            | Node::Loop(..)
            | Node::Sample(..)
            | Node::MaterialAt(..) => return View::Same,
        };
        View::Operation(operation, arguments)
    }

    /// The operands of a sum or product in order of their rank.
    fn sorted(&mut self, graph: &mut Graph, a: NodeId, b: NodeId) -> Vec<NodeId> {
        if self.rank(graph, b) < self.rank(graph, a) { vec![b, a] } else { vec![a, b] }
    }

    /// The sort key of an operand. The steps of a blend have no shape key, so their kind of
    /// operation comes first.
    fn rank(&mut self, graph: &mut Graph, id: NodeId) -> (usize, u32) {
        let node = graph.node(id);
        let kinds = [
            self.is_constant(graph, id),
            matches!(node, Node::Binary(Binary::Min, ..)),
            matches!(node, Node::Binary(Binary::Mul, ..)),
        ];
        let kind = kinds.into_iter().position(|is| is).unwrap_or(kinds.len());
        (kind, self.of(id))
    }
}
