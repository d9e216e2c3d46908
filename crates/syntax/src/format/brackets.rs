//! Converts bracketed lists to documents.

use super::doc::{Brackets, Doc, brackets, concat};
use super::source::Source;
use crate::ast::{Expr, ExprKind};
use crate::token::TokenKind;

/// Converts bracketed elements, with an optional comma behind the last.
pub(super) fn bracketed<'a, T>(
    source: &mut Source<'a>,
    elements: &[T],
    one: impl Fn(&mut Source<'a>, &T) -> Doc<'a>,
    hug: Option<usize>,
) -> Doc<'a> {
    let open = concat(vec![source.take(), source.trailing_comments()]);
    let (mut docs, mut notes) = (Vec::new(), Vec::new());
    for element in elements {
        docs.push(one(source, element));
        let before = source.trailing_comments();
        source.skip(TokenKind::Comma);
        notes.push(concat(vec![before, source.trailing_comments()]));
    }
    let comments = source.comments();
    let close = source.take();
    brackets(Brackets { open, elements: docs, notes, comments, close, hug })
}

/// Returns true if the first line of an expression over several lines ends with an opening bracket.
pub(super) fn stays_beside(tree: &Expr) -> bool {
    let mut tree = tree;
    while let ExprKind::Lambda(_, body) = &tree.kind {
        tree = body;
    }
    matches!(tree.kind, ExprKind::Block(..) | ExprKind::List(_) | ExprKind::Record(_))
}
