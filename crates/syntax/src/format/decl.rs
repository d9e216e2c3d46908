//! Converts items to documents.

use super::doc::{Doc, concat, group, indent, line, text};
use super::expr::{expr, let_};
use super::signature::{function, type_expr};
use super::source::Source;
use crate::ast::{Decl, DeclKind, Import, Item, Param};

pub(super) fn item<'a>(source: &mut Source<'a>, tree: &Item) -> Doc<'a> {
    match tree {
        Item::Import(tree) => import(source, tree),
        Item::Param(tree) => param(source, tree),
        Item::Decl(tree) => decl(source, tree),
        Item::Let(tree) => let_(source, tree),
        Item::Expr(tree) => expr(source, tree),
    }
}

fn import<'a>(source: &mut Source<'a>, tree: &Import) -> Doc<'a> {
    let word = source.take();
    let mut names = Vec::new();
    for (at, (_, renamed)) in tree.names.iter().enumerate() {
        names.extend([line(" "), source.take()]);
        if renamed.is_some() {
            names.extend([text(" "), source.take_spaced(), source.take()]);
        }
        if at + 1 < tree.names.len() {
            names.push(source.take());
        }
    }
    names.extend([line(" "), source.take_spaced(), source.take()]);
    group(vec![word, indent(names)])
}

fn param<'a>(source: &mut Source<'a>, tree: &Param) -> Doc<'a> {
    let mut docs = vec![source.take_spaced(), source.take()];
    if let Some(ty) = &tree.ty {
        docs.extend([source.take_spaced(), type_expr(source, ty)]);
    }
    docs.extend([text(" "), source.take_spaced(), expr(source, &tree.default)]);
    if let Some(range) = &tree.range {
        docs.extend([text(" "), source.take_spaced(), expr(source, range)]);
    }
    concat(docs)
}

/// Converts a declaration. Each clause of a shape has its own line, so that clauses form a column.
fn decl<'a>(source: &mut Source<'a>, tree: &Decl) -> Doc<'a> {
    let head = vec![source.take_spaced(), source.take()];
    let open = tree.kind != DeclKind::Fn && !tree.signature.clauses.is_empty();
    function(source, head, (&tree.signature, &tree.body), open, expr)
}
