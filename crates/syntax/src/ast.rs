//! The syntax tree: what was written, nothing inferred.

use sdfc_diagnostics::Span;

/// A name and its position.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    /// The name as written.
    pub text: String,
    /// The position in the source.
    pub span: Span,
}

/// Documentation: the `///` lines right before a declaration, without the slashes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Docs {
    /// One string a line, its leading space removed.
    pub lines: Vec<String>,
}

/// A parsed file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct File {
    /// The items in order. An item that could not be parsed is absent, its error reported.
    pub items: Vec<Item>,
}

/// An item at the top level.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// `import a, b as c from "path"`
    Import(Import),
    /// `param k = 0.4 in 0..1`
    Param(Param),
    /// `fn`, `solid`, `region`, `shape`
    Decl(Box<Decl>),
    /// `let a = ...`
    Let(Let),
    /// A solid to draw, or a setting.
    Expr(Expr),
}

impl Item {
    /// Returns the import, if it is one.
    pub fn as_import(&self) -> Option<&Import> {
        match self {
            Self::Import(import) => Some(import),
            Self::Param(_) | Self::Decl(_) | Self::Let(_) | Self::Expr(_) => None,
        }
    }

    /// Returns the declaration of a function or shape, if it is one.
    pub fn as_decl(&self) -> Option<&Decl> {
        match self {
            Self::Decl(decl) => Some(decl),
            Self::Import(_) | Self::Param(_) | Self::Let(_) | Self::Expr(_) => None,
        }
    }
}

/// `import a, b as c from "path"`
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// Each name with its new name.
    pub names: Vec<(Name, Option<Name>)>,
    /// The path, unescaped.
    pub path: Name,
    /// The whole item.
    pub span: Span,
}

/// `param NAME [: type] = default [in range]`
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// Documentation.
    pub docs: Docs,
    /// Its name.
    pub name: Name,
    /// Its type, if written.
    pub ty: Option<TypeExpr>,
    /// Its default.
    pub default: Expr,
    /// A range, or a list of choices.
    pub range: Option<Expr>,
    /// The whole item.
    pub span: Span,
}

/// `let NAME = value`
#[derive(Clone, Debug, PartialEq)]
pub struct Let {
    /// Its name.
    pub name: Name,
    /// Its value.
    pub value: Expr,
    /// The whole item.
    pub span: Span,
}

/// The word that a declaration starts with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DeclKind {
    /// `fn`
    Fn,
    /// `solid`: a function of a 3D point
    Solid,
    /// `region`: a function of a 2D point
    Region,
    /// `shape`: either
    Shape,
}

/// A declaration with a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Decl {
    /// Documentation.
    pub docs: Docs,
    /// `fn`, `solid`, `region` or `shape`.
    pub kind: DeclKind,
    /// Its name.
    pub name: Name,
    /// Parameters, result type, clauses.
    pub signature: Signature,
    /// The expression behind `=`.
    pub body: Expr,
    /// The whole item without its documentation.
    pub span: Span,
}

/// `(parameters) [-> type] clauses`
#[derive(Clone, Debug, PartialEq)]
pub struct Signature {
    /// The parameters in order.
    pub parms: Vec<Parm>,
    /// The result type, if written.
    pub result: Option<TypeExpr>,
    /// The clauses in order.
    pub clauses: Vec<Clause>,
    /// From `(` to the last clause.
    pub span: Span,
}

/// One parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parm {
    /// Its name.
    pub name: Name,
    /// Its type, if written.
    pub ty: Option<TypeExpr>,
    /// True if `...` follows the type.
    pub variadic: bool,
    /// Its default.
    pub default: Option<Expr>,
    /// The range of allowed values.
    pub range: Option<Expr>,
    /// The whole construct.
    pub span: Span,
}

/// The side of the surface that a clause applies to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// Where the field is positive.
    Outside,
    /// Where the field is negative.
    Inside,
}

/// One clause of a signature.
#[derive(Clone, Debug, PartialEq)]
pub struct Clause {
    /// The kind of the clause, with its arguments.
    pub kind: ClauseKind,
    /// The whole construct.
    pub span: Span,
}

/// The kinds of clauses.
#[derive(Clone, Debug, PartialEq)]
pub enum ClauseKind {
    /// `exact [side] [if condition]`
    Exact(Option<Side>, Option<Expr>),
    /// `bound [side] [if condition]`
    Bound(Option<Side>, Option<Expr>),
    /// `lipschitz number [everywhere]`
    Lipschitz(Expr, bool),
    /// `bounds lo..hi`
    Bounds(Expr),
    /// `material e`
    Material(Expr),
    /// `intersect e`
    Intersect(Expr),
    /// `copies`
    Copies,
    /// `require condition, "message"`; the message unescaped.
    Require(Expr, Name),
}

/// A type as written.
#[derive(Clone, Debug, PartialEq)]
pub struct TypeExpr {
    /// The kind.
    pub kind: TypeExprKind,
    /// The position in the source.
    pub span: Span,
}

/// The kinds of type expressions.
#[derive(Clone, Debug, PartialEq)]
pub enum TypeExprKind {
    /// `number`, `solid`, `vec3`: any one word, known or not.
    Named(String),
    /// `[T]`
    List(Box<TypeExpr>),
    /// `fn(A, B) -> R`
    Fn(Vec<TypeExpr>, Box<TypeExpr>),
    /// `(name: T, ...)`
    Record(Vec<FieldType>),
}

/// One field of the type of a record: `name: type`
#[derive(Clone, Debug, PartialEq)]
pub struct FieldType {
    /// Its name.
    pub name: Name,
    /// Its type.
    pub ty: TypeExpr,
}

/// An expression.
///
/// The parser makes expressions of at most [`MAX_HEIGHT`](crate::MAX_HEIGHT) nodes in height.
/// Cloning, comparing and printing extend the stack; dropping needs about 200 bytes of stack per
/// node.
pub struct Expr {
    /// The kind.
    pub kind: ExprKind,
    /// The position in the source.
    pub span: Span,
}

impl Clone for Expr {
    fn clone(&self) -> Self {
        deeper(|| Expr { kind: self.kind.clone(), span: self.span })
    }
}

impl PartialEq for Expr {
    fn eq(&self, other: &Self) -> bool {
        self.span == other.span && deeper(|| self.kind == other.kind)
    }
}

impl std::fmt::Debug for Expr {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut out = f.debug_struct("Expr");
        deeper(|| out.field("kind", &self.kind).field("span", &self.span).finish())
    }
}

/// Runs one step of a recursion over expressions, on a new stack segment if little stack is left.
pub(crate) fn deeper<T>(step: impl FnOnce() -> T) -> T {
    stacker::maybe_grow(64 << 10, 1 << 20, step)
}

/// The unit of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unit {
    /// Degrees.
    Deg,
    /// Full turns.
    Turn,
    /// Radians.
    Rad,
}

/// The kinds of expressions.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// A number as written, before its unit is applied.
    Number {
        /// The value of the digits.
        value: f64,
        /// The unit, if written.
        unit: Option<Unit>,
        /// True if written without point, exponent and unit.
        whole: bool,
    },
    /// Red, green, blue and alpha as written: sRGB, 0 to 255.
    Color([u8; 4]),
    /// A string, unescaped.
    Text(String),
    /// `true` or `false`.
    Bool(bool),
    /// A name.
    Name(String),
    /// `(e)`; kept for the formatter.
    Paren(Box<Expr>),
    /// `{ let a = ...; result }`
    Block(Vec<Let>, Box<Expr>),
    /// `if condition { a } else { b }`; the branches are blocks, or another `if` after `else`.
    If(Box<Expr>, Box<Expr>, Box<Expr>),
    /// `fn(parameters) = body`
    Lambda(Box<Signature>, Box<Expr>),
    /// `[a, b, for ...]`
    List(Vec<Element>),
    /// `(name: a, ...)`
    Record(Vec<Field>),
    /// `callee(arguments)`; `x.f(a)` is a call whose callee is `Field(x, f)`.
    Call(Box<Expr>, Vec<Arg>),
    /// `base.name`
    Field(Box<Expr>, Name),
    /// `base[index]`; a slice is an index by a range.
    Index(Box<Expr>, Box<Expr>),
    /// `-a`, `!a`
    Unary(UnaryOp, Box<Expr>),
    /// `a op b`; the span is that of the operator.
    Binary(BinaryOp, Span, Box<Expr>, Box<Expr>),
    /// An expression that failed to parse. Its error was reported, so later phases ignore it.
    Error,
}

/// An element of a list, or an argument.
#[derive(Clone, Debug, PartialEq)]
pub enum Element {
    /// One value.
    Expr(Expr),
    /// `for name in over [if condition]: body`
    For(Box<Comprehension>),
}

/// `for name in over [if condition]: body`
#[derive(Clone, Debug, PartialEq)]
pub struct Comprehension {
    /// The variable.
    pub name: Name,
    /// The sequence.
    pub over: Expr,
    /// The condition for the values to keep.
    pub condition: Option<Expr>,
    /// The element for each value.
    pub body: Element,
    /// The whole construct.
    pub span: Span,
}

/// One field of a record: `name: value`
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name.
    pub name: Name,
    /// Its value.
    pub value: Expr,
}

/// One argument of a call.
#[derive(Clone, Debug, PartialEq)]
pub struct Arg {
    /// The parameter it names; only on `Element::Expr`.
    pub name: Option<Name>,
    /// The value.
    pub value: Element,
}

/// Prefix operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnaryOp {
    /// `-`
    Neg,
    /// `!`
    Not,
}

/// Infix operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BinaryOp {
    /// `*`
    Mul,
    /// `/`
    Div,
    /// `%`
    Rem,
    /// `+`
    Add,
    /// `-`
    Sub,
    /// `|`: union
    Union,
    /// `&`: intersection
    Intersect,
    /// `lo..hi`
    Range,
    /// `==`
    Eq,
    /// `!=`
    Ne,
    /// `<`
    Lt,
    /// `<=`
    Le,
    /// `>`
    Gt,
    /// `>=`
    Ge,
    /// `&&`
    And,
    /// `||`
    Or,
}
