//! The typed scene: names resolved, types checked, coercions and defaults explicit.
//!
//! What the checker promises the elaborator: every expression has its type, no
//! `Type::Error` remains (unless errors were reported, and then nothing is elaborated), arguments
//! stand in parameter order, and every coercion is written out.

use sdfc_diagnostics::{FileId, Span};
use sdfc_graph::Dim;

/// The type of a value.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// A number; `length` is another word for it.
    Number,
    /// A number known to be whole.
    Int,
    /// A number of radians that came from a unit.
    Angle,
    /// A truth value.
    Bool,
    /// A string.
    Text,
    /// A vector of 2, 3 or 4 numbers.
    Vec(u8),
    /// Linear red, green, blue, and alpha.
    Color,
    /// A range of numbers, ints, angles or vectors.
    Range(Box<Type>),
    /// A list of one type.
    List(Box<Type>),
    /// A function.
    Fn(Vec<Type>, Box<Type>),
    /// A solid or a region.
    Shape(Dim),
    /// A material.
    Material,
    /// How a light's shadow is computed: `hard`, `soft(k)`.
    Shadow,
    /// Unknown because of an error that was reported.
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
    /// File-level `let`s, in an order in which each mentions only earlier ones.
    pub globals: Vec<Global>,
    /// The solids that stand alone at top level of the opened file, in order.
    pub drawn: Vec<Expr>,
    /// The settings of the opened file, in order.
    pub settings: Vec<Setting>,
    /// The library's `union` of solids, which joins what is drawn.
    pub union: Option<ShapeDefId>,
    /// How many locals any expression of a param, of `drawn` or of a setting needs at most;
    /// each of these expressions counts its own from 0.
    pub locals: u32,
    /// Files of the library: what goes wrong in one of them is reported at the scene's call.
    pub library: Vec<FileId>,
}

/// One parameter of a function or shape; its local is its position.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its type; a list for a variadic one.
    pub ty: Type,
    /// Whether it takes all remaining positional arguments.
    pub variadic: bool,
    /// Evaluated in the callee, where parameters to its left are known.
    pub default: Option<Expr>,
    /// `lo..hi`, evaluated in the callee; both ends included.
    pub range: Option<Expr>,
    /// Where it is declared.
    pub span: Span,
}

/// `require condition, "message"`
#[derive(Clone, Debug)]
pub struct Require {
    /// Must hold.
    pub condition: Expr,
    /// What to say where it does not.
    pub message: String,
    /// Where it is declared.
    pub span: Span,
}

/// A checked `fn`.
#[derive(Clone, Debug)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// The file that declares it.
    pub file: FileId,
    /// Its name's place.
    pub span: Span,
    /// Locals `0..parameters.len()`.
    pub parameters: Vec<Parameter>,
    /// How many locals the body needs, parameters included.
    pub locals: u32,
    /// Checked before the body is elaborated.
    pub requires: Vec<Require>,
    /// A stated constant.
    pub lipschitz: Option<Expr>,
    /// The body.
    pub body: Expr,
    /// Documentation lines.
    pub docs: Vec<String>,
}

/// A promise with the condition under which it holds; both sides are spelled out.
#[derive(Clone, Debug)]
pub struct Promise {
    /// `exact` or `bound`.
    pub exact: bool,
    /// Outside the surface.
    pub outside: bool,
    /// Inside the surface.
    pub inside: bool,
    /// `if` condition.
    pub condition: Option<Expr>,
    /// Where it is stated.
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
    /// Its name's place.
    pub span: Span,
    /// Locals `0..parameters.len()`; local `parameters.len()` is the point `p`.
    pub parameters: Vec<Parameter>,
    /// How many locals clauses and body need together, parameters and `p` included.
    pub locals: u32,
    /// Relations that the arguments must keep.
    pub requires: Vec<Require>,
    /// Stated promises.
    pub promises: Vec<Promise>,
    /// A stated Lipschitz constant.
    pub lipschitz: Option<Expr>,
    /// Whether it is stated to hold beyond the bounds too.
    pub everywhere: bool,
    /// Stated bounds: a range of points (a number is already a vector).
    pub bounds: Option<Expr>,
    /// `material e`: a material, or a number made of samples.
    pub material: Option<Expr>,
    /// `intersect e`.
    pub intersect: Option<Intersect>,
    /// Where `copies` stands.
    pub copies: Option<Span>,
    /// The formula: a number.
    pub body: Expr,
    /// Documentation lines.
    pub docs: Vec<String>,
}

/// Where a ray is inside a solid.
#[derive(Clone, Debug)]
pub struct Intersect {
    /// The ray's origin `o`, a point.
    pub origin: LocalId,
    /// Its direction `d`, of unit length.
    pub direction: LocalId,
    /// Where it enters and leaves: a vector of two numbers, or a list of such.
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
    /// Its name's place.
    pub span: Span,
    /// Documentation lines.
    pub docs: Vec<String>,
}

/// A file-level `let`.
#[derive(Clone, Debug)]
pub struct Global {
    /// Its name.
    pub name: String,
    /// Its value; needs `locals` variables.
    pub value: Expr,
    /// How many locals the value's blocks and comprehensions need.
    pub locals: u32,
    /// Its name's place.
    pub span: Span,
}

/// A setting with its arguments in the order of its table row; `None` is the default.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Which.
    pub kind: SettingKind,
    /// One per parameter of the row.
    pub args: Vec<Option<Expr>>,
    /// The whole call.
    pub span: Span,
}

/// The settings, one per row of `settings::TABLE`.
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
    /// What it is.
    pub kind: ExprKind,
    /// Its type.
    pub ty: Type,
    /// Where it was written.
    pub span: Span,
}

/// The forms of a typed expression.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// A literal number, its unit applied (radians); also `pi`, `tau`, `inf`.
    Number(f64),
    /// Linear red, green, blue, and alpha.
    Color([f64; 4]),
    /// A string.
    Text(String),
    /// A truth value.
    Bool(bool),
    /// A variable of the body at hand.
    Local(LocalId),
    /// A param.
    Param(ParamId),
    /// A file-level `let`.
    Global(GlobalId),
    /// `time`, in seconds.
    Time,
    /// `frame`, a whole number.
    Frame,
    /// Elements of one type; also what a variadic parameter gets.
    List(Vec<Element>),
    /// `lo..hi`
    Range(Box<Expr>, Box<Expr>),
    /// A vector or colour from 2 to 4 parts, numbers or vectors, joined in order.
    Vector(Vec<Expr>),
    /// Components by index; a number for one, else a vector.
    Swizzle(Box<Expr>, Vec<u8>),
    /// `.lo` (true), `.hi` (false) of a range.
    RangeEnd(Box<Expr>, bool),
    /// An element of a list, or a component of a vector.
    Index(Box<Expr>, Box<Expr>),
    /// Part of a list: a half-open range.
    Slice(Box<Expr>, Box<Expr>),
    /// Each local gets its value in order, then the result.
    Block(Vec<(LocalId, String, Expr)>, Box<Expr>),
    /// Both branches have the type of the whole.
    If(Box<Expr>, Box<Expr>, Box<Expr>),
    /// A function value.
    Lambda(Box<Lambda>),
    /// A declared function as a value.
    FnValue(FnId),
    /// A declared function called; `None` takes the default.
    Call(FnId, Vec<Option<Expr>>),
    /// A shape built; `None` takes the default.
    Build(ShapeDefId, Vec<Option<Expr>>),
    /// A shape's distance at a point.
    Sample(Box<Expr>, Box<Expr>),
    /// A function value called.
    Apply(Box<Expr>, Vec<Expr>),
    /// An operation of the kernel.
    Kernel(Kernel, Vec<Expr>),
    /// `m.with(field: value)`: a material with fields changed.
    With(Box<Expr>, Vec<(MaterialField, Expr)>),
    /// Number, int or angle to a vector of equal parts (the expression's type).
    Splat(Box<Expr>),
    /// A value to the constant function of the expression's type.
    Constant(Box<Expr>),
    /// Something with an error that was reported.
    Error,
}

/// `fn(a, b) = body` with its own variables: captures first, then parameters, then the rest.
#[derive(Clone, Debug)]
pub struct Lambda {
    /// Variables of the enclosing body, copied to locals `0..captures.len()`.
    pub captures: Vec<LocalId>,
    /// Types of the parameters, locals `captures.len()..`.
    pub parameters: Vec<Type>,
    /// Names of the parameters.
    pub names: Vec<String>,
    /// How many locals the body needs in all.
    pub locals: u32,
    /// A stated constant (sees captures and locals of the lambda).
    pub lipschitz: Option<Expr>,
    /// Relations checked at each call.
    pub requires: Vec<Require>,
    /// The body.
    pub body: Expr,
}

/// An element of a list.
#[derive(Clone, Debug)]
pub enum Element {
    /// One value.
    One(Expr),
    /// All values of a list, in order (a list given for a variadic parameter).
    Spread(Expr),
    /// `for local in over [if condition]: body`; `over` is a range, a list or a vector.
    For(Box<Comprehension>),
}

/// `for local in over [if condition]: body`
#[derive(Clone, Debug)]
pub struct Comprehension {
    /// The variable.
    pub local: LocalId,
    /// The sequence: a list, a vector, or a half-open range. The ends of a range of `Number`
    /// are whole where elaboration knows them, else the sequence is not known.
    pub over: Expr,
    /// Which values to keep.
    pub condition: Option<Expr>,
    /// What each gives.
    pub body: Element,
    /// All of it.
    pub span: Span,
}

/// A field of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MaterialField {
    /// Base colour with alpha: what of it covers what was there.
    Color,
    /// 0 mirror to 1 matt.
    Roughness,
    /// 0 dielectric to 1 metal.
    Metallic,
    /// Light given off, linear.
    Emission,
    /// 0 dark to 1 open.
    Occlusion,
}

/// What the Rust kernel knows. Componentwise operations have arguments of one type
/// (number or vector), all equal to the result's unless stated.
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
    /// On numbers, bools or texts; gives a bool.
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
    /// Any number of arguments; a list argument (one, alone) gives the least of its elements.
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
    /// Arguments: the seeded values (numbers or vectors); gives a number in 0..1.
    Hash,
    /// As `Hash`, gives a vec3.
    Hash3,
    /// Length of a list, range of ints or vector; an int.
    Len,
    /// Arguments: over (int, range or list), start, step (function of the state, or of state and item), while (a function of the state, or absent).
    Iterate,
    /// Bounds of a shape: a range of points. Of a function to shapes: the hull over all arguments.
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
    /// Text, font, alignment, spacing, leading: a list of curves, each a list of three points.
    GlyphCurves,
    /// Argument: sharpness.
    Soft,
}
