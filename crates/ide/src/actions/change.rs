//! A change of the source, and helpers to write one.

use rustc_hash::FxHashSet;
use sdfc_diagnostics::Span;
use sdfc_syntax::ast::{Expr, ExprKind};
use sdfc_syntax::{Class, classes};

use crate::analysis::Analysis;

/// Title and replacements of a change.
pub type Change = (String, Vec<(Span, String)>);

/// Returns true if `.name` behind an expression would belong to only a part of it.
pub fn needs_parentheses(e: &Expr) -> bool {
    match &e.kind {
        ExprKind::Number { .. }
        | ExprKind::Block(..)
        | ExprKind::If(..)
        | ExprKind::Lambda(..)
        | ExprKind::Unary(..)
        | ExprKind::Binary(..)
        | ExprKind::Error => true,
        ExprKind::Color(_)
        | ExprKind::Text(_)
        | ExprKind::Bool(_)
        | ExprKind::Name(_)
        | ExprKind::Paren(_)
        | ExprKind::List(_)
        | ExprKind::Record(_)
        | ExprKind::Call(..)
        | ExprKind::Field(..)
        | ExprKind::Index(..) => false,
    }
}

/// Returns a name that the scene does not use: the one that is wanted, or that with a number.
pub fn free_name(analysis: &Analysis, wanted: &str) -> String {
    let text = analysis.text();
    let names = classes(text).into_iter().filter(|(class, _)| *class == Class::Name);
    let used: FxHashSet<&str> = names.map(|(_, range)| &text[range]).collect();
    let numbered = (2..=used.len() + 2).map(|number| format!("{wanted}{number}"));
    let mut names = std::iter::once(wanted.to_owned()).chain(numbered);
    names.find(|name| !used.contains(&name[..])).unwrap_or_else(|| format!("{wanted}_"))
}

/// Returns the change that writes a declaration before a statement: on a line of its own, or, if
/// the statement does not begin its line, on the same line.
pub fn declare_before(analysis: &Analysis, statement: Span, declaration: &str) -> (Span, String) {
    let before = &analysis.text()[..statement.start as usize];
    let line = before.rfind('\n').map_or(0, |at| at + 1);
    let indent = &before[line..];
    match indent.trim().is_empty() {
        true => (statement.before(), format!("{declaration}\n{indent}")),
        false => (statement.before(), format!("{declaration}; ")),
    }
}
