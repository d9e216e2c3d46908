//! Converts signatures and types to documents.
//!
//! Parameters and clauses contain expressions, and expressions contain the signatures of lambdas.
//! So the functions here take the conversion of expressions as an argument.

use super::brackets::{bracketed, stays_beside};
use super::doc::{Below, Doc, Equation, concat, equation, group, indent, line, text};
use super::source::Source;
use crate::ast::{
    Clause, ClauseKind, Expr, ExprKind, FieldType, Parm, Side, Signature, TypeExpr, TypeExprKind,
    deeper,
};

/// The function that converts an expression to a document.
pub(super) type ConvertExpr = for<'a> fn(&mut Source<'a>, &Expr) -> Doc<'a>;

/// Converts `head(parameters) clauses = body`. With `open`, clauses have lines of their own.
pub(super) fn function<'a>(
    source: &mut Source<'a>,
    mut head: Vec<Doc<'a>>,
    (signature, body): (&Signature, &Expr),
    open: bool,
    expr: ConvertExpr,
) -> Doc<'a> {
    head.push(bracketed(source, &signature.parms, |source, tree| parm(source, tree, expr), None));
    if let Some(result) = &signature.result {
        head.extend([text(" "), source.take_spaced(), type_expr(source, result)]);
    }
    let clauses = signature.clauses.iter().map(|tree| clause(source, tree, expr)).collect();
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

fn parm<'a>(source: &mut Source<'a>, tree: &Parm, expr: ConvertExpr) -> Doc<'a> {
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

fn clause<'a>(source: &mut Source<'a>, tree: &Clause, expr: ConvertExpr) -> Doc<'a> {
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

/// Converts a type.
pub(super) fn type_expr<'a>(source: &mut Source<'a>, tree: &TypeExpr) -> Doc<'a> {
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
        TypeExprKind::Record(fields) => bracketed(source, fields, field_type, None),
    })
}

fn field_type<'a>(source: &mut Source<'a>, tree: &FieldType) -> Doc<'a> {
    let name = source.take_joined(2);
    concat(vec![name, text(" "), type_expr(source, &tree.ty)])
}
