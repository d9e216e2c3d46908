//! Converts expressions to documents.

use super::brackets::{bracketed, stays_beside};
use super::doc::{Chain, Doc, NOTHING, chain, concat, group, hard, indent, line, text};
use super::signature::function;
use super::source::Source;
use crate::ast::{Arg, BinaryOp, Element, Expr, ExprKind, Field, Let, Signature, UnaryOp, deeper};
use crate::token::TokenKind;

pub(super) fn expr<'a>(source: &mut Source<'a>, tree: &Expr) -> Doc<'a> {
    // Comments before an expression do not make its own groups break.
    let comments = source.comments();
    let printed = deeper(|| bare_expr(source, tree));
    if comments.hard { concat(vec![comments, printed]) } else { printed }
}

fn bare_expr<'a>(source: &mut Source<'a>, tree: &Expr) -> Doc<'a> {
    match &tree.kind {
        ExprKind::Number { .. }
        | ExprKind::Color(_)
        | ExprKind::Text(_)
        | ExprKind::Bool(_)
        | ExprKind::Name(_)
        | ExprKind::Error => source.take(),
        ExprKind::Paren(inner) => {
            let open = source.take();
            let inner = expr(source, inner);
            let comments = source.comments();
            group(vec![open, indent(vec![line(""), inner, comments]), line(""), source.take()])
        }
        ExprKind::Block(lets, result) => block(source, lets, result),
        ExprKind::If(..) => condition(source, tree),
        ExprKind::Lambda(signature, body) => lambda(source, signature, body),
        ExprKind::List(elements) => {
            let hug = hugged(elements.iter());
            bracketed(source, elements, element, hug)
        }
        ExprKind::Record(fields) => {
            let hug = matches!(&fields[..], [only] if stays_beside(&only.value)).then_some(0);
            bracketed(source, fields, field, hug)
        }
        ExprKind::Call(..) | ExprKind::Field(..) | ExprKind::Index(..) => postfixes(source, tree),
        ExprKind::Unary(..) => prefixes(source, tree),
        ExprKind::Binary(..) => operators(source, tree),
    }
}

/// Converts the prefixes `-` and `!` in a loop.
fn prefixes<'a>(source: &mut Source<'a>, tree: &Expr) -> Doc<'a> {
    let (mut docs, mut operand) = (Vec::new(), tree);
    while let ExprKind::Unary(UnaryOp::Neg | UnaryOp::Not, inner) = &operand.kind {
        docs.push(source.take());
        operand = inner;
    }
    docs.push(expr(source, operand));
    concat(docs)
}

/// Returns the precedence of an operator. Operators with the same layout share a level.
fn level(op: BinaryOp) -> u8 {
    match op {
        BinaryOp::Or => 0,
        BinaryOp::And => 1,
        BinaryOp::Eq | BinaryOp::Ne | BinaryOp::Lt | BinaryOp::Le | BinaryOp::Gt | BinaryOp::Ge => {
            2
        }
        BinaryOp::Range => 3,
        BinaryOp::Add | BinaryOp::Sub | BinaryOp::Union | BinaryOp::Intersect => 4,
        BinaryOp::Mul | BinaryOp::Div | BinaryOp::Rem => 5,
    }
}

/// Converts operands of one level. A line may break before each operator.
fn operators<'a>(source: &mut Source<'a>, tree: &Expr) -> Doc<'a> {
    let (mut rights, mut first, mut chained) = (Vec::new(), tree, None);
    while let ExprKind::Binary(op, _, left, right) = &first.kind
        && chained.is_none_or(|level_of_chain| level_of_chain == level(*op))
    {
        chained = Some(level(*op));
        rights.push((*op, left, right));
        first = left;
    }
    let mut docs = vec![expr(source, first), source.trailing_comments()];
    let (mut rest, mut note) = (Vec::new(), NOTHING);
    for (op, left, right) in rights.into_iter().rev() {
        rest.push(note);
        let tight = op == BinaryOp::Range && is_atom(left) && is_atom(right);
        let space = if tight { "" } else { " " };
        rest.extend([line(space), source.take(), text(space), expr(source, right)]);
        note = source.trailing_comments();
    }
    docs.push(indent(rest));
    // A comment behind the whole expression does not break it.
    concat(vec![group(docs), note])
}

/// Returns true if the expression is short enough for `..` without spaces.
fn is_atom(tree: &Expr) -> bool {
    let argument = |arg: &Arg| match &arg.value {
        Element::Expr(value) => arg.name.is_none() && is_atom(value),
        Element::For(_) => false,
    };
    deeper(|| match &tree.kind {
        ExprKind::Number { .. }
        | ExprKind::Color(_)
        | ExprKind::Text(_)
        | ExprKind::Bool(_)
        | ExprKind::Name(_)
        | ExprKind::Error => true,
        ExprKind::Unary(_, inner) | ExprKind::Field(inner, _) => is_atom(inner),
        ExprKind::Call(callee, args) => is_atom(callee) && args.iter().all(argument),
        ExprKind::Paren(_)
        | ExprKind::Block(..)
        | ExprKind::If(..)
        | ExprKind::Lambda(..)
        | ExprKind::List(_)
        | ExprKind::Record(_)
        | ExprKind::Index(..)
        | ExprKind::Binary(..) => false,
    })
}

/// A postfix without its base.
enum Postfix<'t> {
    Field,
    Index(&'t Expr),
    Call(&'t [Arg]),
}

/// Returns the outermost postfix of an expression and its base.
fn postfix(tree: &Expr) -> Option<(Postfix<'_>, &Expr)> {
    if let ExprKind::Field(base, _) = &tree.kind {
        Some((Postfix::Field, base))
    } else if let ExprKind::Index(base, index) = &tree.kind {
        Some((Postfix::Index(index), base))
    } else if let ExprKind::Call(callee, args) = &tree.kind {
        Some((Postfix::Call(args), callee))
    } else {
        None
    }
}

/// Converts calls, fields and indices: a head, and links that each begin with a point and have a
/// call.
fn postfixes<'a>(source: &mut Source<'a>, tree: &Expr) -> Doc<'a> {
    let (mut steps, mut head) = (Vec::new(), tree);
    while let Some((step, base)) = postfix(head) {
        steps.push(step);
        head = base;
    }
    steps.reverse();
    let mut parts = vec![vec![expr(source, head), source.trailing_comments()]];
    let mut calls = 0;
    for (at, step) in steps.iter().enumerate() {
        let called = matches!(steps.get(at + 1), Some(Postfix::Call(_)));
        if called && matches!(step, Postfix::Field) {
            parts.push(Vec::new());
        }
        let part = match step {
            Postfix::Field => source.take_joined(2),
            Postfix::Index(index) => {
                let open = source.take();
                let index = expr(source, index);
                concat(vec![open, index, source.take()])
            }
            Postfix::Call(args) => {
                calls += 1;
                let hug = hugged(args.iter().map(|arg| &arg.value));
                bracketed(source, args, argument, hug)
            }
        };
        if let Some(parts) = parts.last_mut() {
            parts.extend([part, source.trailing_comments()]);
        }
    }
    let mut parts = parts.into_iter().map(concat);
    let head = parts.next().unwrap_or(NOTHING);
    let links: Vec<_> = parts.collect();
    if links.is_empty() {
        return head;
    }
    let breaks = calls > 1 || head.hard;
    chain(Chain { head, links, breaks })
}

/// Returns the element that may take several lines while the others stay beside it: the only one
/// that is a function with a block or list, or a list that is the only element.
fn hugged<'t>(elements: impl Iterator<Item = &'t Element> + Clone) -> Option<usize> {
    let alone = elements.clone().count() == 1;
    let huggable = |element: &Element| match element {
        Element::Expr(value) => stays_beside(value) && (alone || !is_list(value)),
        Element::For(_) => false,
    };
    let mut found = elements.enumerate().filter(|(_, element)| huggable(element));
    found.next().map(|(at, _)| at).filter(|_| found.next().is_none())
}

fn is_list(tree: &Expr) -> bool {
    matches!(tree.kind, ExprKind::List(_) | ExprKind::Record(_))
}

/// Converts `fn(parameters) clauses = body`.
fn lambda<'a>(source: &mut Source<'a>, signature: &Signature, body: &Expr) -> Doc<'a> {
    let head = vec![source.take()];
    function(source, head, (signature, body), false, expr)
}

fn argument<'a>(source: &mut Source<'a>, arg: &Arg) -> Doc<'a> {
    if arg.name.is_none() {
        return element(source, &arg.value);
    }
    let name = source.take_joined(2);
    concat(vec![name, text(" "), element(source, &arg.value)])
}

fn field<'a>(source: &mut Source<'a>, tree: &Field) -> Doc<'a> {
    let name = source.take_joined(2);
    concat(vec![name, text(" "), expr(source, &tree.value)])
}

fn element<'a>(source: &mut Source<'a>, tree: &Element) -> Doc<'a> {
    let part = match tree {
        Element::Expr(value) => return expr(source, value),
        Element::For(part) => part,
    };
    let mut docs = vec![source.take_spaced(), source.take_spaced(), source.take_spaced()];
    docs.push(expr(source, &part.over));
    if let Some(condition) = &part.condition {
        docs.extend([text(" "), source.take_spaced(), expr(source, condition)]);
    }
    docs.push(source.take());
    let body = deeper(|| element(source, &part.body));
    docs.push(indent(vec![line(" "), body]));
    group(docs)
}

/// Converts `if c { a } else if d { b } else { e }`: one line, or a line break after every brace.
fn condition<'a>(source: &mut Source<'a>, tree: &Expr) -> Doc<'a> {
    let mut docs = Vec::new();
    let mut tree = tree;
    while let ExprKind::If(condition, then, other) = &tree.kind {
        docs.extend([source.take_spaced(), expr(source, condition), text(" ")]);
        docs.extend(braces(source, then));
        docs.extend([text(" "), source.take_spaced()]);
        tree = other;
    }
    docs.extend(braces(source, tree));
    group(docs)
}

/// Converts a block as a part of a group, so that both break together.
fn braces<'a>(source: &mut Source<'a>, tree: &Expr) -> Vec<Doc<'a>> {
    if let ExprKind::Block(lets, result) = &tree.kind {
        block_parts(source, lets, result)
    } else {
        vec![expr(source, tree)]
    }
}

fn block<'a>(source: &mut Source<'a>, lets: &[Let], result: &Expr) -> Doc<'a> {
    group(block_parts(source, lets, result))
}

/// Converts `{ let a = 1; a }`. A block with a `let` that had several lines keeps them.
fn block_parts<'a>(source: &mut Source<'a>, lets: &[Let], result: &Expr) -> Vec<Doc<'a>> {
    let opened = !lets.is_empty() && source.opens_lines();
    let edge = || if opened { hard(false) } else { line(" ") };
    let open = concat(vec![source.take(), source.trailing_comments()]);
    let mut inner = vec![edge()];
    for binding in lets {
        inner.push(let_(source, binding));
        source.skip(TokenKind::Semicolon);
        // Without the `;` the next line would continue with a subtraction.
        let needed = source.kind() == TokenKind::Minus;
        inner.extend(needed.then(|| text(";")));
        inner.push(source.trailing_comments());
        let flat = if needed { " " } else { "; " };
        inner.push(if opened { hard(source.blank_before()) } else { line(flat) });
    }
    inner.push(expr(source, result));
    source.skip(TokenKind::Semicolon);
    inner.push(source.trailing_comments());
    let comments = source.comments();
    if comments.hard {
        inner.extend([hard(false), comments]);
    }
    vec![open, indent(inner), edge(), source.take()]
}

pub(super) fn let_<'a>(source: &mut Source<'a>, binding: &Let) -> Doc<'a> {
    let head = vec![source.take_spaced(), source.take_spaced(), source.take_spaced()];
    let value = expr(source, &binding.value);
    concat(vec![concat(head), value])
}
