//! Turns a call into a method call, and back.

use std::ops::Range;

use sdfc_diagnostics::Span;
use sdfc_syntax::ast::{Arg, Element, Expr, ExprKind, Name};

use super::change::{Change, needs_parentheses};
use crate::analysis::{Analysis, Referent};
use crate::edit::range;
use crate::tree::{Node, path};

/// Returns the change of the call whose name is selected: `f(a, b)` to `a.f(b)`, and back.
pub fn turned(analysis: &Analysis, selected: &Range<usize>) -> Option<Change> {
    let nodes = path(&analysis.tree, selected.start).into_iter().rev().filter_map(Node::expr);
    let holds = |name: Span| {
        let name = range(name);
        name.start <= selected.start && selected.end <= name.end
    };
    for e in nodes {
        let ExprKind::Call(callee, args) = &e.kind else { continue };
        if let ExprKind::Name(_) = &callee.kind {
            if holds(callee.span) {
                return to_method(analysis, e.span, callee.span, args);
            }
        } else if let ExprKind::Field(base, name) = &callee.kind
            && holds(name.span)
        {
            return to_function(analysis, e.span, (base, name), args);
        }
    }
    None
}

/// True if a name is that of a function or shape, so that it can be called in both ways.
fn is_function(analysis: &Analysis, name: Span) -> bool {
    let found = analysis.occurrence(name.start as usize).filter(|it| it.span == name);
    found.is_some_and(|it| match &it.referent {
        Referent::Declared(declared) => analysis.declaration(*declared).is_some(),
        Referent::Kernel(_) => true,
        Referent::Implicit | Referent::Setting(_) | Referent::Parameter(..) | Referent::Type(_) => {
            false
        }
    })
}

fn to_method(analysis: &Analysis, call: Span, name: Span, args: &[Arg]) -> Option<Change> {
    let [Arg { name: None, value: Element::Expr(first) }, rest @ ..] = args else { return None };
    if !is_function(analysis, name) {
        return None;
    }
    let next = rest.first().map(|arg| Node::Arg(arg).span());
    let behind = match next {
        Some(next) => Span { start: first.span.end, end: next.start, ..call },
        None => Span { start: first.span.end, ..call },
    };
    let head = Span { start: call.start, end: first.span.start, ..call };
    let (open, close) = if needs_parentheses(first) { ("(", ")") } else { ("", "") };
    let end = if next.is_some() { "" } else { ")" };
    let called = format!("{close}.{}({end}", analysis.slice(name));
    change(analysis, "call it as a method", vec![(head, open.to_owned()), (behind, called)])
}

fn to_function(
    analysis: &Analysis,
    call: Span,
    (base, name): (&Expr, &Name),
    args: &[Arg],
) -> Option<Change> {
    if !is_function(analysis, name.span) {
        return None;
    }
    let first = if let ExprKind::Paren(inner) = &base.kind { inner.span } else { base.span };
    let before = Span { end: first.start, ..call };
    let next = args.first().map(|arg| Node::Arg(arg).span());
    let (behind, rest) = match next {
        Some(next) => (Span { start: first.end, end: next.start, ..call }, ", "),
        None => (Span { start: first.end, ..call }, ")"),
    };
    let head = format!("{}(", name.text);
    change(analysis, "call it as a function", vec![(before, head), (behind, rest.to_owned())])
}

/// A change, unless it would delete a comment.
fn change(analysis: &Analysis, title: &str, edits: Vec<(Span, String)>) -> Option<Change> {
    let keeps_comments = edits.iter().all(|(span, _)| !analysis.slice(*span).contains("//"));
    keeps_comments.then(|| (title.to_owned(), edits))
}
