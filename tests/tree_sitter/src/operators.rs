//! Which operator joins which operands, in both trees.

use std::collections::BTreeSet;

use sdfc_syntax::ast::{Arg, Clause, ClauseKind, Element, Expr, ExprKind, File, Item, Signature};
use tree_sitter::{Node, Tree};

/// The first byte of the left operand and the last byte of the right one of an infix operator.
type Operator = (usize, usize);

/// The operators of the tree of the grammar.
pub fn of_grammar(tree: &Tree) -> BTreeSet<Operator> {
    let mut found = BTreeSet::new();
    let mut open: Vec<Node<'_>> = vec![tree.root_node()];
    while let Some(node) = open.pop() {
        if matches!(node.kind(), "binary_expression" | "range") {
            found.insert((node.start_byte(), node.end_byte()));
        }
        let mut cursor = node.walk();
        open.extend(node.children(&mut cursor));
    }
    found
}

/// The operators of the tree of the compiler.
pub fn of_compiler(file: &File) -> BTreeSet<Operator> {
    let mut found = BTreeSet::new();
    let mut open: Vec<&Expr> = Vec::new();
    for item in &file.items {
        match item {
            Item::Import(_) => {}
            Item::Param(it) => open.extend([&it.default].into_iter().chain(&it.range)),
            Item::Decl(it) => {
                signature(&it.signature, &mut open);
                open.push(&it.body);
            }
            Item::Let(it) => open.push(&it.value),
            Item::Expr(it) => open.push(it),
        }
    }
    while let Some(e) = open.pop() {
        if let ExprKind::Binary(..) = &e.kind {
            found.insert((e.span.start as usize, e.span.end as usize));
        }
        match &e.kind {
            ExprKind::Number { .. }
            | ExprKind::Color(_)
            | ExprKind::Text(_)
            | ExprKind::Bool(_)
            | ExprKind::Name(_)
            | ExprKind::Error => {}
            ExprKind::Paren(a) | ExprKind::Unary(_, a) | ExprKind::Field(a, _) => open.push(a),
            ExprKind::Block(lets, value) => {
                open.extend(lets.iter().map(|it| &it.value));
                open.push(value);
            }
            ExprKind::If(a, b, c) => open.extend([&**a, &**b, &**c]),
            ExprKind::Lambda(it, body) => {
                signature(it, &mut open);
                open.push(body);
            }
            ExprKind::List(elements) => elements.iter().for_each(|it| element(it, &mut open)),
            ExprKind::Record(fields) => open.extend(fields.iter().map(|it| &it.value)),
            ExprKind::Call(callee, args) => {
                open.push(callee);
                args.iter().for_each(|Arg { value, .. }| element(value, &mut open));
            }
            ExprKind::Index(a, b) | ExprKind::Binary(_, _, a, b) => open.extend([&**a, &**b]),
        }
    }
    found
}

fn signature<'a>(it: &'a Signature, open: &mut Vec<&'a Expr>) {
    for parm in &it.parms {
        open.extend(parm.default.iter().chain(&parm.range));
    }
    for Clause { kind, .. } in &it.clauses {
        match kind {
            ClauseKind::Exact(_, e) | ClauseKind::Bound(_, e) => open.extend(e),
            ClauseKind::Lipschitz(e, _)
            | ClauseKind::Bounds(e)
            | ClauseKind::Material(e)
            | ClauseKind::Intersect(e)
            | ClauseKind::Require(e, _) => open.push(e),
            ClauseKind::Copies => {}
        }
    }
}

fn element<'a>(mut it: &'a Element, open: &mut Vec<&'a Expr>) {
    loop {
        match it {
            Element::Expr(e) => return open.push(e),
            Element::For(inner) => {
                open.push(&inner.over);
                open.extend(&inner.condition);
                it = &inner.body;
            }
        }
    }
}
