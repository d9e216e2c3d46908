//! Typed expressions.

use sdfc_diagnostics::Span;

use sdfc_graph::SurfaceVector;

use super::ids::{FnId, GlobalId, LocalId, ParamId, ShapeDefId};
use super::kernel::{Kernel, MaterialField};
use super::types::Type;

/// A typed expression.
#[derive(Clone, Debug)]
pub struct Expr {
    /// Its form.
    pub kind: ExprKind,
    /// Its type.
    pub ty: Type,
    /// Its span in the source.
    pub span: Span,
}

/// The forms of a typed expression.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// A literal number, angles in radians; also `pi`, `tau` and `inf`.
    Number(f64),
    /// Linear red, green, blue, and alpha.
    Color([f64; 4]),
    /// A string.
    Text(String),
    /// A bool.
    Bool(bool),
    /// A variable of the current body.
    Local(LocalId),
    /// `normal` or `view`: a direction at the surface.
    SurfaceVector(SurfaceVector),
    /// A param.
    Param(ParamId),
    /// A file-level `let`.
    Global(GlobalId),
    /// `time`, in seconds.
    Time,
    /// `frame`, a whole number.
    Frame,
    /// A list of elements of one type; also the argument of a variadic parameter.
    List(Vec<Element>),
    /// A record: the values of its fields, in the order of its type.
    Record(Vec<Expr>),
    /// A field of a record, by index.
    Field(Box<Expr>, usize),
    /// `lo..hi`
    Range(Box<Expr>, Box<Expr>),
    /// A vector or colour from 2 to 4 parts, numbers or vectors, joined in order.
    Vector(Vec<Expr>),
    /// Components by index: a number for one, a vector for several.
    Swizzle(Box<Expr>, Vec<u8>),
    /// `.lo` (true), `.hi` (false) of a range.
    RangeEnd(Box<Expr>, bool),
    /// An element of a list, or a component of a vector.
    Index(Box<Expr>, Box<Expr>),
    /// Part of a list: a half-open range.
    Slice(Box<Expr>, Box<Expr>),
    /// Variables with their values in order, and the result.
    Block(Vec<(LocalId, String, Expr)>, Box<Expr>),
    /// Condition and two branches, which have the type of the whole.
    If(Box<Expr>, Box<Expr>, Box<Expr>),
    /// A function value.
    Lambda(Box<Lambda>),
    /// A declared function as a value.
    FnValue(FnId),
    /// A call of a declared function; `None` is a default.
    Call(FnId, Vec<Option<Expr>>),
    /// A call of a shape's declaration, which builds an instance; `None` is a default.
    Build(ShapeDefId, Vec<Option<Expr>>),
    /// A shape's distance at a point.
    Sample(Box<Expr>, Box<Expr>),
    /// A call of a function value.
    Apply(Box<Expr>, Vec<Expr>),
    /// An operation of the kernel.
    Kernel(Kernel, Vec<Expr>),
    /// A field of a material.
    MaterialField(Box<Expr>, MaterialField),
    /// `m.with(field: value)`: a material with fields changed.
    With(Box<Expr>, Vec<(MaterialField, Expr)>),
    /// A number, int or angle as a vector with equal components.
    Splat(Box<Expr>),
    /// A value as a constant function.
    Constant(Box<Expr>),
    /// An expression with a reported error.
    Error,
}

/// `fn(a, b) = body` with its own locals: captures first, then parameters, then the others.
#[derive(Clone, Debug)]
pub struct Lambda {
    /// Variables of the enclosing body, copied to locals `0..captures.len()`.
    pub captures: Vec<LocalId>,
    /// Types of the parameters, locals `captures.len()..`.
    pub parameters: Vec<Type>,
    /// Names of the parameters.
    pub names: Vec<String>,
    /// The number of locals of the body.
    pub locals: u32,
    /// The stated Lipschitz constant, in terms of the lambda's locals.
    pub lipschitz: Option<Expr>,
    /// Requirements, which are checked at each call.
    pub requires: Vec<Require>,
    /// The body.
    pub body: Expr,
}

/// An element of a list.
#[derive(Clone, Debug)]
pub enum Element {
    /// One value.
    One(Expr),
    /// All values of a list, in order: a list that is passed to a variadic parameter.
    Spread(Expr),
    /// `for local in over [if condition]: body`; `over` is a range, a list or a vector.
    For(Box<Comprehension>),
}

/// `for local in over [if condition]: body`
#[derive(Clone, Debug)]
pub struct Comprehension {
    /// The variable.
    pub local: LocalId,
    /// The sequence: a list, a vector or a half-open range. Elaboration checks that the ends of a
    /// range are known and whole.
    pub over: Expr,
    /// The condition for values to keep.
    pub condition: Option<Expr>,
    /// The element made from each value.
    pub body: Element,
    /// The span of the whole.
    pub span: Span,
}

/// `require condition, "message"`
#[derive(Clone, Debug)]
pub struct Require {
    /// The condition that must be true.
    pub condition: Expr,
    /// The message if it is false.
    pub message: String,
    /// The span of its declaration.
    pub span: Span,
}
