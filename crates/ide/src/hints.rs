//! Text that an editor shows between the code: names of parameters, inferred types, and which
//! shapes are uncertified.

use std::ops::Range;

use sdfc_diagnostics::Span;
use sdfc_lang::hir::Type;
use sdfc_syntax::ast::Item;

use crate::analysis::Analysis;
use crate::tree::{Node, nodes};

/// The kind of a hint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HintKind {
    /// The name of the parameter of the argument behind it, `r:`.
    Parameter,
    /// The type of the name before it, `: solid`.
    Type,
    /// The call before it makes a shape whose field is uncertified.
    Uncertified,
}

/// A hint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hint {
    /// The byte offset at which it is shown.
    pub at: usize,
    /// Its text.
    pub label: String,
    /// More about it; empty if there is nothing to say.
    pub about: String,
    /// Its kind.
    pub kind: HintKind,
}

/// Returns the hints in a byte range, in the order of the text. `uncertified` are the calls that
/// make uncertified shapes, with the reasons; the compiler knows them.
pub fn hints(
    analysis: &Analysis,
    range: Range<usize>,
    uncertified: &[(Range<usize>, String)],
) -> Vec<Hint> {
    let mut hints = parameters(analysis);
    hints.extend(types(analysis));
    hints.extend(uncertified.iter().map(|(call, reason)| Hint {
        at: call.end,
        label: "uncertified".to_owned(),
        about: format!("A ray may step through this shape: {reason}"),
        kind: HintKind::Uncertified,
    }));
    hints.retain(|hint| range.start <= hint.at && hint.at <= range.end);
    hints.sort_by_key(|hint| hint.at);
    hints
}

/// Names for positional arguments of calls with several arguments, unless the argument itself says
/// the name.
fn parameters(analysis: &Analysis) -> Vec<Hint> {
    let mut hints = Vec::new();
    for (callee, call) in &analysis.uses.calls {
        if callee.file != analysis.file || call.parameters.len() < 2 {
            continue;
        }
        let written = call.arguments.iter().filter(|it| it.value.start > callee.end);
        if written.count() < 2 {
            continue;
        }
        for argument in &call.arguments {
            let same = call.arguments.iter().filter(|it| it.parameter == argument.parameter);
            let is_plain = argument.name.is_none()
                && argument.value.file == analysis.file
                && argument.value.start > callee.end
                && same.count() == 1;
            let Some(name) = call.parameters.get(argument.parameter).filter(|_| is_plain) else {
                continue;
            };
            let written = analysis.slice(argument.value);
            if written.rsplit('.').next() == Some(name) {
                continue;
            }
            let at = argument.value.start as usize;
            let (label, about) = (format!("{name}:"), String::new());
            hints.push(Hint { at, label, about, kind: HintKind::Parameter });
        }
    }
    hints
}

/// Types of `let`s, of parameters of lambdas and of variables of `for`.
fn types(analysis: &Analysis) -> Vec<Hint> {
    let names = nodes(&analysis.tree.items).filter_map(|node| match node {
        Node::Item(Item::Let(it)) => Some(it.name.span),
        Node::Let(it) => Some(it.name.span),
        Node::For(it) => Some(it.name.span),
        Node::Parm(it) if it.ty.is_none() && it.default.is_none() => Some(it.name.span),
        Node::Item(Item::Import(_) | Item::Param(_) | Item::Decl(_) | Item::Expr(_))
        | Node::Parm(_)
        | Node::Signature(_)
        | Node::Clause(_)
        | Node::Type(_)
        | Node::Expr(_)
        | Node::Arg(_) => None,
    });
    let hint = |name: Span| {
        let ty = analysis.uses.variables.get(&name).filter(|ty| **ty != Type::Error)?;
        let (at, label) = (name.end as usize, format!(": {ty}"));
        Some(Hint { at, label, about: String::new(), kind: HintKind::Type })
    };
    names.filter_map(hint).collect()
}
