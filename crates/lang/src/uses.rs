//! Tables for editors: the targets of a scene's names, and the types of its expressions.
//!
//! The checker fills these tables while it checks the scene and its imports, if they are asked
//! for. The library's files are left out. If an expression is checked more than once, for example
//! in both dimensions of a `shape`, the last check counts.

use rustc_hash::FxHashMap;
use sdfc_diagnostics::Span;

use crate::hir::Type;

/// The item that a name refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// A declaration, variable, parameter or param: the span of its declared name.
    Declared(Span),
    /// The point `p` of a shape, or the ray's origin `o` or direction `d`, which nobody declares.
    Implicit,
    /// A name of the kernel.
    Kernel(&'static str),
    /// A setting.
    Setting(&'static str),
}

/// The arguments of one call.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CallUse {
    /// The names of the parameters, in order.
    pub parameters: Vec<String>,
    /// The arguments, in the order in which they are written.
    pub arguments: Vec<ArgumentUse>,
}

/// One argument of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArgumentUse {
    /// The span of the value.
    pub value: Span,
    /// The span of the name, if it is a named argument.
    pub name: Option<Span>,
    /// The index of the parameter.
    pub parameter: usize,
}

/// The names that the checker found in scope at the cursor.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Scope {
    /// Variables of the body, with their types; later ones hide earlier ones.
    pub variables: Vec<(String, Type)>,
    /// Names of the file and names that it imports, with the spans of their declarations.
    pub items: Vec<(String, Span)>,
    /// The type that is expected there, if one is.
    pub expected: Option<Type>,
}

/// The tables.
#[derive(Clone, Debug, Default)]
pub struct Uses {
    /// The name that marks the cursor.
    pub cursor: Option<String>,
    /// The target of each name that is used, by the span of the use.
    pub targets: FxHashMap<Span, Target>,
    /// The type of each expression.
    pub types: FxHashMap<Span, Type>,
    /// The type of each variable, parameter and param, by the span of its declared name.
    pub variables: FxHashMap<Span, Type>,
    /// The arguments of each call, by the span of the name that is called.
    pub calls: FxHashMap<Span, CallUse>,
    /// The scope at the cursor, if the checker came across it.
    pub scope: Option<Scope>,
}

impl Uses {
    /// Creates empty tables for a text in which the name `cursor` marks the cursor.
    pub fn new(cursor: &str) -> Self {
        Self { cursor: Some(cursor.to_owned()), ..Self::default() }
    }
}
