//! The body that is being checked: its variables, and what is visible beside them.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::Dim;

use super::{Checker, DeclIndex, order::Node};
use crate::hir::{Expr, ExprKind, LocalId, Type};

/// A variable of the innermost frame, by position.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalIndex(usize);

/// A variable in scope.
#[derive(Clone, Debug)]
pub(super) struct Variable<'a> {
    pub name: &'a str,
    pub id: LocalId,
    pub ty: Type,
    /// Where it was declared.
    pub span: Span,
    /// Whether something mentioned it.
    pub used: bool,
}

/// The variables of a function, shape or lambda. Inner ones hide outer ones by standing later.
#[derive(Debug, Default)]
pub(super) struct Frame<'a> {
    variables: Vec<Variable<'a>>,
    /// How many ids have been given out.
    pub locals: u32,
}

impl<'a> Frame<'a> {
    /// Takes a variable of the enclosing frame along, under the next id.
    pub(super) fn capture(&mut self, outer: &Variable<'a>) {
        let id = LocalId(self.locals);
        self.locals += 1;
        self.variables.push(Variable { id, used: false, ..outer.clone() });
    }

    /// Marks the variables as used that an inner frame took along and used.
    pub(super) fn use_captured(&mut self, captures: &[LocalId], inner: &Frame<'a>) {
        for (outer, _) in captures.iter().zip(&inner.variables).filter(|(_, inner)| inner.used) {
            self.variables.iter_mut().filter(|v| v.id == *outer).for_each(|v| v.used = true);
        }
    }
}

/// The state that belongs to one body; declarations checked on the way have their own.
#[derive(Debug, Default)]
pub(super) struct Body<'a> {
    /// The file it stands in.
    pub module: usize,
    /// Lets and params that end before this offset are visible.
    pub position: u32,
    /// What `shape` means in a type.
    pub either: Option<Dim>,
    /// Dimension of `p`; set in shapes only.
    pub point: Option<Dim>,
    /// The declaration that it belongs to.
    pub decl: Option<DeclIndex>,
    /// What it is to the order of evaluation.
    pub node: Option<Node>,
    /// The function or shape itself, then the lambdas around the expression at hand.
    pub frames: Vec<Frame<'a>>,
    /// Findings of readings that may yet be given up, innermost last.
    pub attempts: Vec<Vec<Diagnostic>>,
}

impl<'a> Body<'a> {
    /// A body in a file, in which what ends before `position` is visible.
    pub(super) fn new(module: usize, position: u32) -> Self {
        Self { module, position, frames: vec![Frame::default()], ..Self::default() }
    }

    /// The variable that a name means in the innermost frame.
    pub(super) fn find(&self, name: &str) -> Option<LocalIndex> {
        let variables = &self.frames.last()?.variables;
        variables.iter().rposition(|variable| variable.name == name).map(LocalIndex)
    }

    /// The names of all variables in scope.
    pub(super) fn names(&self) -> impl Iterator<Item = &'a str> {
        self.frames.last().into_iter().flat_map(|f| f.variables.iter().map(|v| v.name))
    }

    /// A fresh id in the innermost frame.
    pub(super) fn fresh(&mut self) -> LocalId {
        let Some(frame) = self.frames.last_mut() else {
            return LocalId(0);
        };
        frame.locals += 1;
        LocalId(frame.locals - 1)
    }

    /// Brings a variable into scope and gives its id.
    pub(super) fn declare(&mut self, name: &'a str, ty: Type, span: Span) -> LocalId {
        let id = self.fresh();
        self.declare_as(id, name, ty, span);
        id
    }

    /// Brings a variable into scope under an id that was set aside for it.
    pub(super) fn declare_as(&mut self, id: LocalId, name: &'a str, ty: Type, span: Span) {
        if let Some(frame) = self.frames.last_mut() {
            frame.variables.push(Variable { name, id, ty, span, used: false });
        }
    }

    /// How many variables are in scope; give it to `leave` to end a scope.
    pub(super) fn enter(&self) -> usize {
        self.frames.last().map_or(0, |frame| frame.variables.len())
    }

    /// Ends the scope that began at `mark`; gives the variables that nothing mentioned.
    pub(super) fn leave(&mut self, mark: usize) -> Vec<Variable<'a>> {
        let Some(frame) = self.frames.last_mut() else {
            return Vec::new();
        };
        frame.variables.drain(mark..).filter(|variable| !variable.used).collect()
    }

    /// The variable itself.
    pub(super) fn variable(&self, index: LocalIndex) -> Option<&Variable<'a>> {
        self.frames.last()?.variables.get(index.0)
    }

    /// The variable as an expression; it counts as used.
    pub(super) fn mention(&mut self, index: LocalIndex, span: Span) -> Option<Expr> {
        let variable = self.frames.last_mut()?.variables.get_mut(index.0)?;
        variable.used = true;
        Some(Expr { kind: ExprKind::Local(variable.id), ty: variable.ty.clone(), span })
    }
}

impl<'a> Checker<'a> {
    /// Ends a scope of a block; what it declared and nothing mentioned gets a warning.
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
