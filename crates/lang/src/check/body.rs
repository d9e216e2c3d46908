//! The body that is being checked: its variables and its scope.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::Dim;

use super::{Checker, DeclIndex, order::Node};
use crate::hir::{Expr, ExprKind, LocalId, Type};

/// The index of a variable in the innermost frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalIndex(usize);

/// A variable in scope.
#[derive(Clone, Debug)]
pub(super) struct Variable<'a> {
    pub name: &'a str,
    pub id: LocalId,
    pub ty: Type,
    /// The span of its declaration.
    pub span: Span,
    /// True for `p`, `o` and `d`, which the language declares.
    pub implicit: bool,
    /// True if something uses it.
    pub used: bool,
    /// True for a parameter without a type, which is a number.
    pub untyped: bool,
}

/// The variables of a function, shape or lambda. Later ones hide earlier ones of the same name.
#[derive(Debug, Default)]
pub(super) struct Frame<'a> {
    variables: Vec<Variable<'a>>,
    /// The number of ids in use.
    pub locals: u32,
}

impl<'a> Frame<'a> {
    /// Captures a variable of the enclosing frame under the next id.
    pub(super) fn capture(&mut self, outer: &Variable<'a>) {
        let id = LocalId(self.locals);
        self.locals += 1;
        self.variables.push(Variable { id, used: false, ..outer.clone() });
    }

    /// Marks the variables as used that an inner frame captured and used.
    pub(super) fn use_captured(&mut self, captures: &[LocalId], inner: &Frame<'a>) {
        for (outer, _) in captures.iter().zip(&inner.variables).filter(|(_, inner)| inner.used) {
            self.variables.iter_mut().filter(|v| v.id == *outer).for_each(|v| v.used = true);
        }
    }
}

/// The state of checking one body. A declaration that is checked meanwhile has its own.
#[derive(Debug, Default)]
pub(super) struct Body<'a> {
    /// The index of its file.
    pub module: usize,
    /// Lets and params that end before this offset are visible.
    pub position: u32,
    /// The dimension of the type `shape`.
    pub either: Option<Dim>,
    /// The dimension of `p`; `None` outside shapes.
    pub point: Option<Dim>,
    /// The declaration that it belongs to.
    pub decl: Option<DeclIndex>,
    /// Its node in the dependency graph.
    pub node: Option<Node>,
    /// The frame of the function or shape, then those of the lambdas around the current expression.
    pub frames: Vec<Frame<'a>>,
    /// The diagnostics of attempts that may be discarded, innermost last.
    pub attempts: Vec<Vec<Diagnostic>>,
}

impl<'a> Body<'a> {
    /// A body in a file. Lets and params that end before `position` are visible in it.
    pub(super) fn new(module: usize, position: u32) -> Self {
        Self { module, position, frames: vec![Frame::default()], ..Self::default() }
    }

    /// The variable with a name in the innermost frame.
    pub(super) fn find(&self, name: &str) -> Option<LocalIndex> {
        let variables = &self.frames.last()?.variables;
        variables.iter().rposition(|variable| variable.name == name).map(LocalIndex)
    }

    /// All variables in scope.
    pub(super) fn variables(&self) -> impl Iterator<Item = &Variable<'a>> {
        self.frames.last().into_iter().flat_map(|frame| &frame.variables)
    }

    /// A fresh id in the innermost frame.
    pub(super) fn fresh(&mut self) -> LocalId {
        let Some(frame) = self.frames.last_mut() else {
            return LocalId(0);
        };
        frame.locals += 1;
        LocalId(frame.locals - 1)
    }

    /// Brings a variable into scope and returns its id.
    pub(super) fn declare(&mut self, name: &'a str, ty: Type, span: Span) -> LocalId {
        let id = self.fresh();
        self.declare_as(id, name, ty, span);
        id
    }

    /// Brings a variable into scope under a reserved id.
    pub(super) fn declare_as(&mut self, id: LocalId, name: &'a str, ty: Type, span: Span) {
        if let Some(frame) = self.frames.last_mut() {
            let (implicit, used, untyped) = (false, false, false);
            frame.variables.push(Variable { name, id, ty, span, implicit, used, untyped });
        }
    }

    /// Brings a parameter without a type into scope under a reserved id.
    pub(super) fn declare_untyped(&mut self, id: LocalId, name: &'a str, span: Span) {
        self.declare_as(id, name, Type::Number, span);
        if let Some(variable) = self.frames.last_mut().and_then(|it| it.variables.last_mut()) {
            variable.untyped = true;
        }
    }

    /// Brings a variable into scope that the language declares.
    pub(super) fn declare_implicit(&mut self, id: LocalId, name: &'a str, ty: Type, span: Span) {
        self.declare_as(id, name, ty, span);
        if let Some(variable) = self.frames.last_mut().and_then(|it| it.variables.last_mut()) {
            variable.implicit = true;
        }
    }

    /// Starts a scope: returns the number of variables, to be passed to `leave`.
    pub(super) fn enter(&self) -> usize {
        self.frames.last().map_or(0, |frame| frame.variables.len())
    }

    /// Ends the scope that began at `mark` and returns its unused variables.
    pub(super) fn leave(&mut self, mark: usize) -> Vec<Variable<'a>> {
        let Some(frame) = self.frames.last_mut() else {
            return Vec::new();
        };
        frame.variables.drain(mark..).filter(|variable| !variable.used).collect()
    }

    /// The variable at an index.
    pub(super) fn variable(&self, index: LocalIndex) -> Option<&Variable<'a>> {
        self.frames.last()?.variables.get(index.0)
    }

    /// The variable as an expression; marks it as used.
    pub(super) fn mention(&mut self, index: LocalIndex, span: Span) -> Option<Expr> {
        let variable = self.frames.last_mut()?.variables.get_mut(index.0)?;
        variable.used = true;
        Some(Expr { kind: ExprKind::Local(variable.id), ty: variable.ty.clone(), span })
    }
}

impl<'a> Checker<'a> {
    /// Ends the scope of a block and warns about unused variables.
    pub(super) fn leave_block(&mut self, mark: usize) {
        for variable in self.body.leave(mark) {
            if variable.name.starts_with('_') {
                continue;
            }
            let message = format!("`{}` is never used", variable.name);
            self.report(
                Diagnostic::warning(Code::UNUSED, variable.span, message).help("remove it"),
            );
        }
    }
}
