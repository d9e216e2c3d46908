//! The kind of text at the cursor.

use sdfc_lang::hir::Type;
use sdfc_syntax::ast::{ExprKind, Item, TypeExprKind};
use sdfc_syntax::{Class, classes};

use super::item::CURSOR;
use crate::analysis::Analysis;
use crate::tree::{Node, path};

/// The kind of text at the cursor.
pub enum Context {
    /// A name that is being declared, or nothing that is known.
    Nothing,
    /// A type.
    Type,
    /// A clause of a declaration.
    Clause,
    /// A name that is imported from this path.
    Imported(String),
    /// A method or a component of a value of this type.
    Member(Type),
    /// The name of a named argument.
    ArgumentName,
    /// A value.
    Value {
        /// True if an item begins here.
        starts_item: bool,
        /// True if it is an argument without a name.
        in_call: bool,
    },
}

/// The context of the cursor, which is at this offset of the text with the cursor's name.
pub fn context(analysis: &Analysis, offset: usize) -> Context {
    let inside = offset + CURSOR.len() / 2;
    let nodes = path(&analysis.tree, inside);
    let of_tree = match nodes.last() {
        Some(Node::Type(ty)) => {
            matches!(&ty.kind, TypeExprKind::Named(word) if word == CURSOR).then_some(Context::Type)
        }
        Some(Node::Expr(e)) => {
            if let ExprKind::Field(base, name) = &e.kind
                && name.text == CURSOR
            {
                let ty = analysis.uses.types.get(&base.span).cloned();
                Some(ty.map_or(Context::Nothing, Context::Member))
            } else {
                let is_cursor = matches!(&e.kind, ExprKind::Name(name) if name == CURSOR);
                is_cursor.then(|| value(&nodes))
            }
        }
        Some(Node::Arg(arg)) => {
            let named = arg.name.as_ref().is_some_and(|name| name.text == CURSOR);
            named.then_some(Context::ArgumentName)
        }
        Some(Node::Item(Item::Import(import))) => Some(match import.path.text.is_empty() {
            false => Context::Imported(import.path.text.clone()),
            true => Context::Nothing,
        }),
        Some(Node::Item(_) | Node::Let(_) | Node::Parm(_) | Node::For(_)) => Some(Context::Nothing),
        Some(Node::Signature(_) | Node::Clause(_)) | None => None,
    };
    of_tree.unwrap_or_else(|| by_tokens(analysis.text(), offset))
}

fn value(nodes: &[Node]) -> Context {
    let in_call = match nodes {
        [.., Node::Arg(arg), Node::Expr(_)] => arg.name.is_none(),
        _ => false,
    };
    let starts_item = match nodes {
        [Node::Item(Item::Expr(item)), rest @ ..] => {
            rest.iter().all(|node| node.span().start == item.span.start)
        }
        _ => false,
    };
    Context::Value { starts_item, in_call }
}

/// The context in text that does not parse, from the tokens before the cursor.
fn by_tokens(text: &str, offset: usize) -> Context {
    let mut before = classes(text);
    before.retain(|(class, range)| {
        range.end <= offset && !matches!(class, Class::Comment | Class::Docs)
    });
    let word = |at: usize| before.get(at).map(|(_, range)| &text[range.clone()]);
    let last = before.len().checked_sub(1);
    match last.and_then(word) {
        Some("let" | "param" | "fn" | "solid" | "region" | "shape" | "for" | ".") => {
            return Context::Nothing;
        }
        Some("->") => return Context::Type,
        Some(_) | None => {}
    }
    let head = before.iter().rposition(|(class, range)| {
        *class == Class::Keyword
            && matches!(&text[range.clone()], "solid" | "region" | "shape" | "fn")
            && (range.start == 0 || text[..range.start].ends_with('\n'))
    });
    if let Some(head) = head {
        let (mut depth, mut closed) = (0_i32, false);
        for (class, range) in &before[head..] {
            if *class == Class::Open {
                depth += 1;
            } else if *class == Class::Close {
                depth -= 1;
                closed |= depth == 0;
            } else if depth == 0 && *class == Class::Operator && &text[range.clone()] == "=" {
                return Context::Value { starts_item: false, in_call: false };
            }
        }
        let is_type = last.and_then(word) == Some(":");
        return match (closed && depth == 0, is_type) {
            (true, _) => Context::Clause,
            (false, true) => Context::Type,
            (false, false) => Context::Nothing,
        };
    }
    let starts_item = text[..offset].trim_end_matches([' ', '\t']).ends_with('\n')
        || text[..offset].trim().is_empty();
    Context::Value { starts_item, in_call: false }
}
