//! Paths and choices between quotes.

use std::ops::Range;

use sdfc_lang::Resolver;
use sdfc_lang::settings::RAY_METHODS;
use sdfc_syntax::ast::{Element, Expr, ExprKind, Item};
use sdfc_syntax::{Class, classes};

use super::item::{Completion, CompletionKind};
use crate::analysis::Analysis;
use crate::calls::open_call;
use crate::signature::{parameter_name, signature_help};

/// Returns what the string at the cursor can be: the path of an import, a choice of a param, or a
/// value that the description of a parameter names.
pub fn strings(
    name: &str,
    text: &str,
    (offset, string): (usize, Range<usize>),
    resolver: &dyn Resolver,
    files: &[String],
) -> Vec<Completion> {
    let mut before = classes(&text[..string.start]);
    before.retain(|(class, _)| !matches!(class, Class::Comment | Class::Docs));
    let word = |back: usize| {
        let at = before.len().checked_sub(back)?;
        before.get(at).map(|(_, range)| &text[range.clone()])
    };
    let is_closed = string.len() > 1 && text[string.clone()].ends_with('"');
    let replace = string.start + 1..if is_closed { string.end - 1 } else { string.end };
    let list = |kind, words: Vec<String>| -> Vec<Completion> {
        let item = |word: String| Completion {
            replace: replace.clone(),
            ..Completion::new(kind, word, 0)
        };
        words.into_iter().map(item).collect()
    };
    if word(1) == Some("from") {
        return list(CompletionKind::File, files.to_vec());
    }
    let analysis = Analysis::new(name, text, resolver);
    if matches!(word(1), Some("==" | "!="))
        && let Some(param) = word(2)
    {
        return list(CompletionKind::Choice, choices_of_param(&analysis, param));
    }
    list(CompletionKind::Choice, choices_of_parameter(&analysis, offset))
}

fn choices_of_param(analysis: &Analysis, param: &str) -> Vec<String> {
    let items = analysis.trees().flat_map(|tree| &tree.items);
    let range = items.filter_map(|item| match item {
        Item::Param(it) if it.name.text == param => it.range.as_ref(),
        Item::Param(_) | Item::Import(_) | Item::Decl(_) | Item::Let(_) | Item::Expr(_) => None,
    });
    range.flat_map(texts).collect()
}

/// The strings in a list.
fn texts(list: &Expr) -> Vec<String> {
    let ExprKind::List(elements) = &list.kind else { return Vec::new() };
    let text = |element: &Element| match element {
        Element::Expr(Expr { kind: ExprKind::Text(text), .. }) => Some(text.clone()),
        Element::Expr(_) | Element::For(_) => None,
    };
    elements.iter().filter_map(text).collect()
}

/// The values of the parameter at the cursor: the ray methods, or the words between quotes in its
/// description.
fn choices_of_parameter(analysis: &Analysis, offset: usize) -> Vec<String> {
    let Some(call) = open_call(analysis.text(), offset) else { return Vec::new() };
    let callee = &analysis.text()[call.name.clone()];
    let mut words = Vec::new();
    for signature in signature_help(analysis, offset) {
        let active = signature.active.and_then(|at| signature.parameters.get(at));
        let Some((written, about)) = active else { continue };
        if callee == "march" && parameter_name(written) == "method" {
            words.extend(RAY_METHODS.map(str::to_owned));
        } else {
            words.extend(about.split('"').skip(1).step_by(2).map(str::to_owned));
        }
    }
    words
}
