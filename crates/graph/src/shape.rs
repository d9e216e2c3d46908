//! Shape instances: the upper level of the arena.

use crate::{Dim, NodeId, ShapeId};

/// Where a ray ends that does not end, in place of infinity, which shaders need not know.
pub const FAR: f64 = 1e30;

/// What a shape instance was made from; equal arguments make the same instance.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Arg {
    /// A number, vector, truth value.
    Node(NodeId),
    /// A shape.
    Shape(ShapeId),
    /// A list, range or material.
    List(Vec<Arg>),
    /// A string.
    Text(String),
    /// A function value; the number is unique to the closure.
    Function(u32),
}

/// What a field promises on one side of its surface, conditions being truth-valued nodes of
/// stage `Const` or `Frame`. `None`: not stated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SidePromise {
    /// |f| is the distance.
    pub exact: Option<NodeId>,
    /// |f| never exceeds the distance.
    pub bound: Option<NodeId>,
}

/// What an instance's clauses state, given exact / bound / 1-Lipschitz children.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Contract {
    /// Where the field is positive.
    pub outside: SidePromise,
    /// Where it is negative.
    pub inside: SidePromise,
    /// The Lipschitz constant, to be multiplied by max(1, the largest child's).
    pub lipschitz: Option<NodeId>,
    /// Whether the constant is stated to hold beyond the bounds too.
    pub everywhere: bool,
    /// Whether the constant was found from bounds, so that it holds within those of the shape.
    pub is_local: bool,
    /// Whether the formula is continued beyond the bounds ([`crate::Graph::continued`]), so that the constant holds there too.
    pub is_continued: bool,
    /// Lowest and highest point; `lo > hi` nowhere, infinities allowed.
    pub bounds: Option<[NodeId; 2]>,
    /// Whether the formula is the least of samples, each by itself or cut by its own bounds, and of a value than which nothing that
    /// is not sampled there is nearer.
    pub copies: bool,
}

/// Where an instance's material comes from. Fields are in the order of `MaterialField::ALL`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MaterialRule {
    /// The shares ∂f/∂sample of this scalar (the formula itself unless stated otherwise).
    Shares(NodeId),
    /// Stated field by field, in terms of the instance's point and `MaterialAt` nodes.
    Stated([NodeId; 6]),
}

/// One shape instance.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Name of its definition.
    pub definition: String,
    /// Its dimension.
    pub dim: Dim,
    /// Level of the `Point` node that its formula is written in.
    pub level: u16,
    /// Its arguments.
    pub args: Vec<Arg>,
    /// A scalar in `Point(level, dim)`, constants, per-frame inputs and samples.
    pub formula: NodeId,
    /// What its clauses state.
    pub contract: Contract,
    /// Where it states that a ray is inside: pairs of scalars, enter and exit, in `Point(level)` for the ray's origin and
    /// `Point(level + 1)` for its direction, of unit length; ends that lie nowhere are at -[`FAR`] and [`FAR`]. The
    /// ray is inside nowhere else, and nowhere in a pair whose first is above its second. Empty: not stated.
    pub hits: Vec<[NodeId; 2]>,
    /// Its material.
    pub material: MaterialRule,
    /// The shapes that its formula samples, in order of first use.
    pub children: Vec<ShapeId>,
    /// Longest chain of children, itself included.
    pub depth: u32,
    /// The name that the scene gave it by `let`, if one did.
    pub name: Option<String>,
}
