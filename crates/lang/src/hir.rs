//! The typed scene: names are resolved, types checked, coercions and defaults explicit.
//!
//! The checker guarantees to the elaborator that every expression has its type, that arguments are
//! in the order of the parameters, and that every coercion is explicit. `Type::Error` occurs only
//! if errors were reported; such a scene is not elaborated.

use sdfc_diagnostics::{FileId, Span};
use sdfc_graph::Dim;

/// The type of a value.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// A number; `length` is another word for it.
    Number,
    /// A number known to be whole.
    Int,
    /// An angle in radians, written with a unit.
    Angle,
    /// A bool.
    Bool,
    /// A string.
    Text,
    /// A vector of 2, 3 or 4 numbers.
    Vec(u8),
    /// Linear red, green, blue, and alpha.
    Color,
    /// A range of numbers, ints, angles or vectors.
    Range(Box<Type>),
    /// A list whose elements have the same type.
    List(Box<Type>),
    /// A function.
    Fn(Vec<Type>, Box<Type>),
    /// A solid or a region.
    Shape(Dim),
    /// A material.
    Material,
    /// The shadow of a light: `hard` or `soft(k)`.
    Shadow,
    /// Unknown, because an error was reported.
    Error,
}

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(pub u32);
    )*};
}
ids! {
    /// A `fn` of [`Program::functions`].
    FnId
    /// A `solid` or `region` of [`Program::shapes`]; a `shape` declaration makes two.
    ShapeDefId
    /// A `param` of [`Program::params`].
    ParamId
    /// A file-level `let` of [`Program::globals`].
    GlobalId
    /// A variable of the innermost function, shape or lambda body, dense from 0.
    LocalId
}

/// A checked scene with the library and everything it imports.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// All functions.
    pub functions: Vec<Function>,
    /// All shapes.
    pub shapes: Vec<ShapeDef>,
    /// All params, in order of declaration.
    pub params: Vec<Param>,
    /// File-level `let`s, in an order in which each depends only on earlier ones.
    pub globals: Vec<Global>,
    /// The solids to draw: those on lines of their own at the top level of the scene, in order.
    pub drawn: Vec<Expr>,
    /// The settings of the opened file, in order.
    pub settings: Vec<Setting>,
    /// The library's `union` of solids, which joins the solids to draw.
    pub union: Option<ShapeDefId>,
    /// The largest number of locals of any expression of a param, a solid to draw or a setting.
    /// Each of these expressions numbers its own locals from 0.
    pub locals: u32,
    /// Files of the library. An error in one of them is reported at the scene's call.
    pub library: Vec<FileId>,
}

/// A parameter of a function or shape. Its index is also its local.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its type; a list for a variadic parameter.
    pub ty: Type,
    /// True if it takes all remaining positional arguments.
    pub variadic: bool,
    /// Its default, evaluated in the callee, where the parameters to its left are known.
    pub default: Option<Expr>,
    /// Its range `lo..hi`, evaluated in the callee; both ends are included.
    pub range: Option<Expr>,
    /// The span of its declaration.
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

/// A checked `fn`.
#[derive(Clone, Debug)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// The file that declares it.
    pub file: FileId,
    /// The span of its name.
    pub span: Span,
    /// The parameters, which are the locals `0..parameters.len()`.
    pub parameters: Vec<Parameter>,
    /// The number of locals of the body, including parameters.
    pub locals: u32,
    /// Requirements, which are checked before the body is elaborated.
    pub requires: Vec<Require>,
    /// The stated Lipschitz constant.
    pub lipschitz: Option<Expr>,
    /// The body.
    pub body: Expr,
    /// Documentation lines.
    pub docs: Vec<String>,
}

/// A clause `exact` or `bound`, and the condition under which it holds.
#[derive(Clone, Debug)]
pub struct Promise {
    /// True for `exact`, false for `bound`.
    pub exact: bool,
    /// True if it holds outside the surface.
    pub outside: bool,
    /// True if it holds inside the surface.
    pub inside: bool,
    /// The condition after `if`.
    pub condition: Option<Expr>,
    /// The span of the clause.
    pub span: Span,
}

/// A checked `solid`, `region`, or one dimension of a `shape`.
#[derive(Clone, Debug)]
pub struct ShapeDef {
    /// Its name.
    pub name: String,
    /// Its dimension.
    pub dim: Dim,
    /// The file that declares it.
    pub file: FileId,
    /// The span of its name.
    pub span: Span,
    /// The parameters, which are the locals `0..parameters.len()`. The next local is the point `p`.
    pub parameters: Vec<Parameter>,
    /// The number of locals of the clauses and the body, including parameters and `p`.
    pub locals: u32,
    /// Requirements on the arguments.
    pub requires: Vec<Require>,
    /// Stated promises.
    pub promises: Vec<Promise>,
    /// The stated Lipschitz constant.
    pub lipschitz: Option<Expr>,
    /// True if the constant is stated to hold outside the bounds too.
    pub everywhere: bool,
    /// Stated bounds: a range of points (a number is already a vector).
    pub bounds: Option<Expr>,
    /// `material e`: a material, or a number made of samples.
    pub material: Option<Expr>,
    /// `intersect e`: the intervals of a ray that are inside.
    pub intersect: Option<Intersect>,
    /// The span of the clause `copies`.
    pub copies: Option<Span>,
    /// The formula: a number.
    pub body: Expr,
    /// Documentation lines.
    pub docs: Vec<String>,
}

/// The clause `intersect`: the intervals of a ray that are inside a solid.
#[derive(Clone, Debug)]
pub struct Intersect {
    /// The local of the ray's origin `o`, a point.
    pub origin: LocalId,
    /// The local of its direction `d`, of length 1.
    pub direction: LocalId,
    /// The interval `[enter, exit]`, or a list of intervals.
    pub value: Expr,
}

/// A checked `param`.
#[derive(Clone, Debug)]
pub struct Param {
    /// Its name; `file.name` for one of an imported file.
    pub name: String,
    /// Number, Int, Angle, Bool, Color, or Text with choices.
    pub ty: Type,
    /// A constant expression.
    pub default: Expr,
    /// Lowest and highest value, constant expressions.
    pub range: Option<Expr>,
    /// The choices of a text param.
    pub choices: Vec<String>,
    /// The span of its name.
    pub span: Span,
    /// Documentation lines.
    pub docs: Vec<String>,
}

/// A file-level `let`.
#[derive(Clone, Debug)]
pub struct Global {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: Expr,
    /// The number of locals of the value's blocks and comprehensions.
    pub locals: u32,
    /// The span of its name.
    pub span: Span,
}

/// A setting with its arguments in the order of its table row; `None` is the default.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The kind of setting.
    pub kind: SettingKind,
    /// One argument per parameter of the row.
    pub args: Vec<Option<Expr>>,
    /// The span of the whole call.
    pub span: Span,
}

/// The kinds of settings, one per row of [`settings::table`](crate::settings::table).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum SettingKind {
    Camera,
    Ambient,
    Sky,
    Fog,
    Background,
    AmbientOcclusion,
    Reflections,
    Antialias,
    March,
    Sun,
    PointLight,
    SpotLight,
}

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

/// A field of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MaterialField {
    /// Base colour; its alpha is the fraction that covers the colour beneath.
    Color,
    /// From 0 (mirror) to 1 (matt).
    Roughness,
    /// From 0 (dielectric) to 1 (metal).
    Metallic,
    /// Light that the surface gives off, linear.
    Emission,
    /// From 0 (no ambient light) to 1 (all of it).
    Occlusion,
}

/// The operations of the kernel. The arguments of a componentwise operation have the type of its
/// result, a number or vector, unless stated otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Kernel {
    // operators
    Neg,
    Add,
    Sub,
    Mul,
    Div,
    /// Floored: the result has the divisor's sign.
    Rem,
    /// For numbers, bools or strings; gives a bool.
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
    Not,
    And,
    Or,
    // componentwise, one argument
    Abs,
    Sign,
    Floor,
    Ceil,
    /// To the nearest whole number, halves to even, as in WGSL.
    Round,
    Trunc,
    Fract,
    Sqrt,
    InverseSqrt,
    Exp,
    Exp2,
    Log,
    Log2,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Saturate,
    // componentwise, more arguments
    /// Any number of arguments, or one list: the smallest of its elements.
    Min,
    Max,
    Pow,
    Atan2,
    Step,
    Mix,
    Clamp,
    Smoothstep,
    // vectors
    Length,
    Distance,
    Dot,
    Cross,
    Normalize,
    // the rest
    /// `[x, y]` to `[x, y, 0]`, `vec3` as it is.
    Lift,
    /// Arguments: numbers or vectors. Gives a number in 0..1.
    Hash,
    /// Like `Hash`, but gives a vec3.
    Hash3,
    /// Length of a list, range of ints or vector; an int.
    Len,
    /// Arguments: `over` (int, range or list), `start`, `step` (function of the state, or of the
    /// state and the item), `while` (function of the state; optional).
    Iterate,
    /// The bounds of a shape, a range of points. For a function that makes shapes: the bounds over
    /// all arguments.
    Bounds,
    /// Arguments: shape, point.
    Gradient,
    /// Arguments: colour, roughness, metallic, emission, occlusion, all present.
    Material,
    /// Arguments: shape, point.
    MaterialAt,
    /// Numbers to a colour.
    Rgb,
    Hsv,
    Oklch,
    /// A shadow without penumbra.
    Hard,
    /// Arguments: text, font, alignment, spacing, leading. Gives a list of arcs, each a list of four
    /// vectors.
    GlyphCurves,
    /// Argument: sharpness.
    Soft,
}
