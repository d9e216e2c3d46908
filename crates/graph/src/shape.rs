//! Shape instances: the upper level of the arena.

use crate::node::{Dim, NodeId, ShapeId};

/// The end of a ray that does not end: a stand-in for infinity, which shaders need not support.
pub const FAR: f64 = 1e30;

/// An argument of a shape instance; equal arguments make the same instance.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Arg {
    /// A number, vector or truth value.
    Node(NodeId),
    /// A shape.
    Shape(ShapeId),
    /// A list, range or material.
    List(Vec<Arg>),
    /// A string.
    Text(String),
    /// A function value; the number identifies the closure.
    Function(u32),
}

/// The promises of a field on one side of its surface. Conditions are truth values of stage `Const`
/// or `Frame`. `None`: nothing is promised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SidePromise {
    /// `|f|` equals the distance.
    pub exact: Option<NodeId>,
    /// `|f|` never exceeds the distance.
    pub bound: Option<NodeId>,
}

/// The promises that an instance's clauses make, assuming that its children are exact, bounds or
/// 1-Lipschitz.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Contract {
    /// Promises where the field is positive.
    pub outside: SidePromise,
    /// Promises where the field is negative.
    pub inside: SidePromise,
    /// The Lipschitz constant, to be multiplied by the maximum of 1 and the children's constants.
    pub lipschitz: Option<NodeId>,
    /// True if the constant is stated to hold beyond the bounds too.
    pub everywhere: bool,
    /// True if the constant was computed from bounds, so that it holds only within the bounds of
    /// the shape.
    pub is_local: bool,
    /// True if the formula is extended beyond the bounds ([`crate::Graph::lipschitz_extension`]),
    /// so that the constant holds there too.
    pub is_extended: bool,
    /// Lowest and highest corner of the bounds; `lo > hi` for an empty shape, infinities allowed.
    pub bounds: Option<[NodeId; 2]>,
    /// A box around the stated bounds for all outer points, if the stated ones depend on one.
    /// `bounds` is `None` then.
    pub outer_bounds: Option<[NodeId; 2]>,
    /// True if the formula is `min(sample..., limit)`: each sample may be intersected with its
    /// bounds, and `limit` bounds the distance to every copy that is not sampled from below.
    pub copies: bool,
}

impl Contract {
    /// The nodes of all clauses.
    pub(crate) fn nodes(&self) -> impl Iterator<Item = NodeId> {
        let sides = [self.outside, self.inside].map(|side| [side.exact, side.bound]);
        let corners = [self.bounds, self.outer_bounds];
        let single = sides.into_iter().flatten().chain([self.lipschitz]).flatten();
        single.chain(corners.into_iter().flatten().flatten())
    }

    /// The same clauses over other nodes.
    pub(crate) fn map(&self, map: impl Fn(NodeId) -> NodeId) -> Self {
        let side = |SidePromise { exact, bound }: SidePromise| SidePromise {
            exact: exact.map(&map),
            bound: bound.map(&map),
        };
        Self {
            outside: side(self.outside),
            inside: side(self.inside),
            lipschitz: self.lipschitz.map(&map),
            bounds: self.bounds.map(|corners| corners.map(&map)),
            outer_bounds: self.outer_bounds.map(|corners| corners.map(&map)),
            ..*self
        }
    }
}

/// The origin of an instance's material. Fields are in the order of `MaterialField::ALL`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MaterialRule {
    /// The samples' materials, weighted by ∂f/∂sample of this scalar (the formula itself unless
    /// stated otherwise).
    Weighted(NodeId),
    /// Stated field by field, over the instance's point and `MaterialAt` nodes.
    Explicit([NodeId; 6]),
}

/// One shape instance.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Name of its definition.
    pub definition: String,
    /// Dimension of its point.
    pub dim: Dim,
    /// Level of the `Point` node of its formula.
    pub level: u16,
    /// Its arguments.
    pub args: Vec<Arg>,
    /// A scalar in `Point(level, dim)`, constants, per-frame inputs and samples.
    pub formula: NodeId,
    /// Promises of its clauses.
    pub contract: Contract,
    /// The intervals along a ray that lie inside the shape, as its clause `intersect` states them:
    /// pairs of scalars, enter and exit.
    ///
    /// They are functions of the ray's origin `Point(level)` and its direction `Point(level + 1)`,
    /// of unit length. Open ends are -[`FAR`] and [`FAR`]. The ray is inside nowhere else, and a
    /// pair whose first is above its second is empty. No pairs at all: not stated.
    pub intersect: Vec<[NodeId; 2]>,
    /// Its material.
    pub material: MaterialRule,
    /// The shapes that its formula samples, in order of first use.
    pub children: Vec<ShapeId>,
    /// Length of the longest chain of nested shapes, itself included.
    pub depth: u32,
    /// The name that the scene gave it with `let`, if any.
    pub name: Option<String>,
}
