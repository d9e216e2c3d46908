//! The values of elaboration.

use std::rc::Rc;

use sdfc_graph::{Arg, Graph, NodeId, Shadow, ShapeId, Stage, Type};

use crate::hir::{self, FnId, Lambda};

/// The value of an expression.
#[derive(Clone, Debug)]
pub(super) enum Value<'p> {
    /// A number, vector, colour (linear red, green, blue, alpha) or bool.
    Node(NodeId),
    /// A string param: the node of the choice's index, and the index of the param.
    Choice(NodeId, usize),
    Text(Rc<str>),
    Range(NodeId, NodeId),
    /// The elements of a list, or the fields of a record in the order of its type.
    List(Rc<[Value<'p>]>),
    Closure(Rc<Closure<'p>>),
    Shape(ShapeId),
    /// Fields in the order of `MaterialField::ALL`.
    Material([NodeId; 6]),
    Shadow(Shadow),
}

/// A function value.
#[derive(Debug)]
pub(super) struct Closure<'p> {
    /// The id; equal for closures with the same code and equal captures.
    pub id: u32,
    pub code: Code<'p>,
    /// The captured values; for a constant function, its value.
    pub captures: Vec<Value<'p>>,
    /// The highest level among the captures.
    pub levels: u16,
    /// True if a capture depends on a point, see [`Value::moves`].
    pub moves: bool,
}

/// The code of a closure.
#[derive(Clone, Copy, Debug)]
pub(super) enum Code<'p> {
    Lambda(&'p Lambda),
    Function(FnId),
    Constant,
}

/// Identifies equal closures: their code (by its address in the program, which outlives
/// elaboration; constant functions have none) and their captures.
pub(super) type ClosureKey = (Option<CodeKey>, Vec<Arg>);

/// Identifies the code of a closure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum CodeKey {
    Lambda(*const Lambda),
    Function(FnId),
}

impl Code<'_> {
    pub(super) fn key(&self) -> Option<CodeKey> {
        match *self {
            Self::Lambda(lambda) => Some(CodeKey::Lambda(lambda)),
            Self::Function(id) => Some(CodeKey::Function(id)),
            Self::Constant => None,
        }
    }
}

impl Value<'_> {
    /// One more than the highest level of a point that the value depends on; 0 if there is none.
    pub(super) fn levels(&self, graph: &Graph) -> u16 {
        match self {
            Self::Node(node) | Self::Choice(node, _) => graph.levels(*node),
            Self::Text(_) => 0,
            Self::Range(lo, hi) => graph.levels(*lo).max(graph.levels(*hi)),
            Self::List(items) => highest(items.iter().map(|item| item.levels(graph))),
            Self::Closure(closure) => closure.levels,
            Self::Shape(id) => graph.shape(*id).level,
            Self::Material(fields) => highest(fields.iter().map(|&field| graph.levels(field))),
            Self::Shadow(Shadow::Soft(node)) => graph.levels(*node),
            Self::Shadow(Shadow::Off | Shadow::Hard) => 0,
        }
    }

    /// True if the value depends on a point or on the iteration of a loop.
    pub(super) fn moves(&self, graph: &Graph) -> bool {
        let varies = |node: &NodeId| graph.stage(*node) == Stage::Point;
        match self {
            Self::Node(node) | Self::Choice(node, _) => varies(node),
            Self::Text(_) => false,
            Self::Range(lo, hi) => varies(lo) || varies(hi),
            Self::List(items) => items.iter().any(|item| item.moves(graph)),
            Self::Closure(closure) => closure.moves,
            Self::Shape(id) => {
                graph.shape(*id).level > 0 || graph.loops_around(graph.shape(*id).formula) > 0
            }
            Self::Material(fields) => fields.iter().any(varies),
            Self::Shadow(Shadow::Soft(node)) => varies(node),
            Self::Shadow(Shadow::Off | Shadow::Hard) => false,
        }
    }

    /// The value as an argument of a shape instance, which identifies the instance.
    pub(super) fn to_arg(&self) -> Arg {
        match self {
            Self::Node(node) | Self::Choice(node, _) => Arg::Node(*node),
            Self::Text(text) => Arg::Text(text.to_string()),
            Self::Range(lo, hi) => Arg::List(vec![Arg::Node(*lo), Arg::Node(*hi)]),
            Self::List(items) => Arg::List(items.iter().map(Self::to_arg).collect()),
            Self::Closure(closure) => Arg::Function(closure.id),
            Self::Shape(id) => Arg::Shape(*id),
            Self::Material(fields) => {
                Arg::List(fields.iter().map(|&field| Arg::Node(field)).collect())
            }
            Self::Shadow(Shadow::Soft(node)) => Arg::Node(*node),
            Self::Shadow(Shadow::Off) => Arg::Text("off".to_owned()),
            Self::Shadow(Shadow::Hard) => Arg::Text("hard".to_owned()),
        }
    }
}

/// The highest of some levels; 0 if there are none.
pub(super) fn highest(levels: impl Iterator<Item = u16>) -> u16 {
    levels.max().unwrap_or(0)
}

/// The graph's type of a numeric type of the language.
pub(super) fn node_type(ty: &hir::Type) -> Option<Type> {
    match ty {
        hir::Type::Number | hir::Type::Int | hir::Type::Angle => Some(Type::Scalar),
        hir::Type::Bool => Some(Type::Bool),
        hir::Type::Vec(width) => Type::of_width(usize::from(*width)),
        hir::Type::Color => Some(Type::Vec4),
        hir::Type::Text
        | hir::Type::Range(_)
        | hir::Type::List(_)
        | hir::Type::Record(_)
        | hir::Type::Fn(..)
        | hir::Type::Shape(_)
        | hir::Type::Material
        | hir::Type::Shadow
        | hir::Type::Error => None,
    }
}
