//! The items of a program.

use sdfc_diagnostics::{FileId, Span};
use sdfc_graph::Dim;

use super::expr::{Expr, Require};
use super::ids::{LocalId, ShapeDefId};
use super::types::Type;

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
    /// The shapes to draw: those on lines of their own at the top level of the scene, in order. All
    /// are solids, or all are regions.
    pub drawn: Vec<Expr>,
    /// The settings of the opened file, in order.
    pub settings: Vec<Setting>,
    /// The library's `union` of shapes of that dimension, which joins the shapes to draw.
    pub union: Option<ShapeDefId>,
    /// The largest number of locals of any expression of a param, a solid to draw or a setting.
    /// Each of these expressions numbers its own locals from 0.
    pub locals: u32,
    /// Files of the library. An error in one of them is reported at the scene's call.
    pub library: Vec<FileId>,
}

impl Program {
    /// True if the scene draws regions: a planar picture.
    pub fn is_planar(&self) -> bool {
        self.drawn.first().is_some_and(|drawn| drawn.ty == Type::Shape(Dim::Two))
    }
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
    /// Its name; `file.name` for one of an imported file, `folder/file.name` if several imported
    /// files have the same name.
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
    Exposure,
    Antialias,
    Isolines,
    March,
    Sun,
    PointLight,
    SpotLight,
}

impl SettingKind {
    /// True for a setting that lights the scene. A scene with one gets nothing of the default look.
    pub fn is_light(self) -> bool {
        match self {
            Self::Ambient | Self::Sun | Self::PointLight | Self::SpotLight => true,
            Self::Camera
            | Self::Sky
            | Self::Fog
            | Self::Background
            | Self::AmbientOcclusion
            | Self::Reflections
            | Self::Exposure
            | Self::Antialias
            | Self::Isolines
            | Self::March => false,
        }
    }

    /// True for a setting that changes pictures of regions.
    pub fn is_for_regions(self) -> bool {
        match self {
            Self::Camera | Self::Background | Self::Antialias | Self::Isolines => true,
            Self::Ambient
            | Self::Sun
            | Self::PointLight
            | Self::SpotLight
            | Self::Sky
            | Self::Fog
            | Self::AmbientOcclusion
            | Self::Reflections
            | Self::Exposure
            | Self::March => false,
        }
    }

    /// True for a setting that changes pictures of solids.
    pub fn is_for_solids(self) -> bool {
        self != Self::Isolines
    }
}
