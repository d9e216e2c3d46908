//! Converts items, signatures and types to documents.

use super::doc::{Below, Doc, Equation, concat, equation, group, indent, line, text};
use super::expr::{bracketed, expr, let_, stays_beside};
use super::source::Source;
use crate::ast::{
    Clause, ClauseKind, Decl, DeclKind, Expr, ExprKind, Import, Item, Param, Parm, Side, Signature,
    TypeExpr, TypeExprKind, deeper,
};

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
    function(source, head, &tree.signature, &tree.body, open)
}

/// `fn(parameters) clauses = body`
pub(super) fn lambda<'a>(source: &mut Source<'a>, signature: &Signature, body: &Expr) -> Doc<'a> {
    let head = vec![source.take()];
    function(source, head, signature, body, false)
}

fn function<'a>(
    source: &mut Source<'a>,
    mut head: Vec<Doc<'a>>,
    signature: &Signature,
    body: &Expr,
    open: bool,
) -> Doc<'a> {
    head.push(bracketed(source, &signature.parms, parm, None));
    if let Some(result) = &signature.result {
        head.extend([text(" "), source.take_spaced(), type_expr(source, result)]);
    }
    let clauses = signature.clauses.iter().map(|tree| clause(source, tree)).collect();
    let equals = source.take();
    let below = if matches!(body.kind, ExprKind::If(..)) {
        Below::Always
    } else if matches!(body.kind, ExprKind::Lambda(..)) || stays_beside(body) {
        Below::Never
    } else {
        Below::IfItFits
    };
    let body = expr(source, body);
    equation(Equation { head: concat(head), clauses, open, equals, body, below })
}

fn parm<'a>(source: &mut Source<'a>, tree: &Parm) -> Doc<'a> {
    let mut docs = vec![source.take()];
    if let Some(ty) = &tree.ty {
        docs.extend([source.take_spaced(), type_expr(source, ty)]);
    }
    if tree.variadic {
        docs.push(source.take());
    }
    for value in [&tree.default, &tree.range].into_iter().flatten() {
        docs.extend([text(" "), source.take_spaced(), expr(source, value)]);
    }
    concat(docs)
}

fn clause<'a>(source: &mut Source<'a>, tree: &Clause) -> Doc<'a> {
    let mut docs = vec![source.take()];
    match &tree.kind {
        ClauseKind::Exact(side, condition) | ClauseKind::Bound(side, condition) => {
            if let Some(Side::Outside | Side::Inside) = side {
                docs.extend([text(" "), source.take()]);
            }
            if let Some(condition) = condition {
                docs.extend([text(" "), source.take_spaced(), expr(source, condition)]);
            }
        }
        ClauseKind::Lipschitz(value, everywhere) => {
            docs.extend([text(" "), expr(source, value)]);
            if *everywhere {
                docs.extend([text(" "), source.take()]);
            }
        }
        ClauseKind::Bounds(value) | ClauseKind::Material(value) | ClauseKind::Intersect(value) => {
            docs.extend([text(" "), expr(source, value)]);
        }
        ClauseKind::Copies => {}
        ClauseKind::Require(condition, _) => {
            docs.extend([text(" "), expr(source, condition), source.take()]);
            docs.push(indent(vec![line(" "), source.take()]));
        }
    }
    concat(vec![group(docs), source.trailing_comments()])
}

fn type_expr<'a>(source: &mut Source<'a>, tree: &TypeExpr) -> Doc<'a> {
    deeper(|| match &tree.kind {
        TypeExprKind::Named(_) => source.take(),
        TypeExprKind::List(of) => {
            let open = source.take();
            let of = type_expr(source, of);
            concat(vec![open, of, source.take()])
        }
        TypeExprKind::Fn(from, to) => {
            let word = source.take();
            let from = bracketed(source, from, type_expr, None);
            concat(vec![word, from, text(" "), source.take_spaced(), type_expr(source, to)])
        }
    })
}
