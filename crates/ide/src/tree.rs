//! Walks over syntax trees, without recursion.

use sdfc_diagnostics::Span;
use sdfc_syntax::ast::{
    Arg, Clause, ClauseKind, Comprehension, Element, Expr, ExprKind, File, Item, Let, Parm,
    Signature, TypeExpr, TypeExprKind,
};

/// A node of a syntax tree.
#[derive(Clone, Copy, Debug)]
pub enum Node<'a> {
    Item(&'a Item),
    Signature(&'a Signature),
    Parm(&'a Parm),
    Clause(&'a Clause),
    Type(&'a TypeExpr),
    Let(&'a Let),
    Expr(&'a Expr),
    Arg(&'a Arg),
    For(&'a Comprehension),
}

impl<'a> Node<'a> {
    /// The source range.
    pub fn span(self) -> Span {
        match self {
            Self::Item(Item::Import(it)) => it.span,
            Self::Item(Item::Param(it)) => it.span,
            Self::Item(Item::Decl(it)) => it.span,
            Self::Item(Item::Let(it)) => it.span,
            Self::Item(Item::Expr(it)) => it.span,
            Self::Signature(it) => it.span,
            Self::Parm(it) => it.span,
            Self::Clause(it) => it.span,
            Self::Type(it) => it.span,
            Self::Let(it) => it.span,
            Self::Expr(it) => it.span,
            Self::Arg(it) => {
                let value = element_span(&it.value);
                it.name.as_ref().map_or(value, |name| name.span.to(value))
            }
            Self::For(it) => it.span,
        }
    }

    /// The expression, if it is one.
    pub fn expr(self) -> Option<&'a Expr> {
        match self {
            Self::Expr(e) => Some(e),
            Self::Item(_)
            | Self::Signature(_)
            | Self::Parm(_)
            | Self::Clause(_)
            | Self::Type(_)
            | Self::Let(_)
            | Self::Arg(_)
            | Self::For(_) => None,
        }
    }

    /// Adds the nodes right below this one, in the order of the text.
    fn children(self, out: &mut Vec<Node<'a>>) {
        match self {
            Self::Item(item) => match item {
                Item::Import(_) => {}
                Item::Param(it) => {
                    out.extend(it.ty.as_ref().map(Node::Type));
                    out.push(Node::Expr(&it.default));
                    out.extend(it.range.as_ref().map(Node::Expr));
                }
                Item::Decl(it) => {
                    out.extend([Node::Signature(&it.signature), Node::Expr(&it.body)])
                }
                Item::Let(it) => out.push(Node::Expr(&it.value)),
                Item::Expr(it) => out.push(Node::Expr(it)),
            },
            Self::Signature(it) => {
                out.extend(it.parms.iter().map(Node::Parm));
                out.extend(it.result.as_ref().map(Node::Type));
                out.extend(it.clauses.iter().map(Node::Clause));
            }
            Self::Parm(it) => {
                out.extend(it.ty.as_ref().map(Node::Type));
                out.extend(it.default.as_ref().map(Node::Expr));
                out.extend(it.range.as_ref().map(Node::Expr));
            }
            Self::Clause(it) => match &it.kind {
                ClauseKind::Exact(_, e) | ClauseKind::Bound(_, e) => {
                    out.extend(e.as_ref().map(Node::Expr));
                }
                ClauseKind::Lipschitz(e, _)
                | ClauseKind::Bounds(e)
                | ClauseKind::Material(e)
                | ClauseKind::Intersect(e)
                | ClauseKind::Require(e, _) => out.push(Node::Expr(e)),
                ClauseKind::Copies => {}
            },
            Self::Type(it) => match &it.kind {
                TypeExprKind::Named(_) => {}
                TypeExprKind::List(of) => out.push(Node::Type(of)),
                TypeExprKind::Record(fields) => {
                    out.extend(fields.iter().map(|field| Node::Type(&field.ty)));
                }
                TypeExprKind::Fn(parameters, result) => {
                    out.extend(parameters.iter().map(Node::Type));
                    out.push(Node::Type(result));
                }
            },
            Self::Let(it) => out.push(Node::Expr(&it.value)),
            Self::Expr(it) => expr_children(it, out),
            Self::Arg(it) => out.push(element(&it.value)),
            Self::For(it) => {
                out.push(Node::Expr(&it.over));
                out.extend(it.condition.as_ref().map(Node::Expr));
                out.push(element(&it.body));
            }
        }
    }
}

fn expr_children<'a>(e: &'a Expr, out: &mut Vec<Node<'a>>) {
    match &e.kind {
        ExprKind::Number { .. }
        | ExprKind::Color(_)
        | ExprKind::Text(_)
        | ExprKind::Bool(_)
        | ExprKind::Name(_)
        | ExprKind::Error => {}
        ExprKind::Paren(inner) | ExprKind::Unary(_, inner) | ExprKind::Field(inner, _) => {
            out.push(Node::Expr(inner));
        }
        ExprKind::Block(lets, result) => {
            out.extend(lets.iter().map(Node::Let));
            out.push(Node::Expr(result));
        }
        ExprKind::If(a, b, c) => out.extend([a, b, c].map(|e| Node::Expr(e))),
        ExprKind::Lambda(signature, body) => {
            out.extend([Node::Signature(signature), Node::Expr(body)]);
        }
        ExprKind::List(elements) => out.extend(elements.iter().map(element)),
        ExprKind::Record(fields) => {
            out.extend(fields.iter().map(|field| Node::Expr(&field.value)));
        }
        ExprKind::Call(callee, args) => {
            out.push(Node::Expr(callee));
            out.extend(args.iter().map(Node::Arg));
        }
        ExprKind::Index(a, b) | ExprKind::Binary(_, _, a, b) => {
            out.extend([Node::Expr(a), Node::Expr(b)]);
        }
    }
}

fn element(element: &Element) -> Node<'_> {
    match element {
        Element::Expr(e) => Node::Expr(e),
        Element::For(each) => Node::For(each),
    }
}

/// The source range of an element.
pub fn element_span(element: &Element) -> Span {
    match element {
        Element::Expr(e) => e.span,
        Element::For(each) => each.span,
    }
}

/// All nodes of some items, each before the nodes below it, in the order of the text.
pub fn nodes(items: &[Item]) -> impl Iterator<Item = Node<'_>> {
    let mut waiting: Vec<Node> = items.iter().rev().map(Node::Item).collect();
    let mut children = Vec::new();
    std::iter::from_fn(move || {
        let node = waiting.pop()?;
        node.children(&mut children);
        waiting.extend(children.drain(..).rev());
        Some(node)
    })
}

/// The nodes around a byte offset, outermost first. The end of a node belongs to it.
pub fn path(tree: &File, offset: usize) -> Vec<Node<'_>> {
    let holds = |node: &Node| {
        let span = node.span();
        span.start as usize <= offset && offset <= span.end as usize
    };
    let mut path: Vec<Node> = Vec::new();
    let mut children: Vec<Node> = tree.items.iter().map(Node::Item).collect();
    while let Some(node) = children.iter().rev().find(|node| holds(node)).copied() {
        path.push(node);
        children.clear();
        node.children(&mut children);
    }
    path
}
