//! Fixes of diagnostics that need the syntax tree.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_syntax::ast::{Import, Item};

use super::change::{Change, needs_parentheses};
use crate::analysis::Analysis;
use crate::tree::{Node, path};

/// Returns the fixes that need the syntax tree.
pub fn structural(analysis: &Analysis, it: &Diagnostic) -> Vec<Change> {
    match it.code {
        Code::UNUSED => remove(analysis, it.span),
        Code::REGION_FOR_SOLID => make_solid(analysis, it.span),
        _ => Vec::new(),
    }
}

/// Removes the `let`, the declaration or the import of an unused name.
fn remove(analysis: &Analysis, name: Span) -> Vec<Change> {
    let title = format!("remove `{}`", analysis.slice(name));
    let mut around = path(&analysis.tree, name.start as usize).into_iter().rev();
    let span = around.find_map(|node| match node {
        Node::Item(Item::Import(import)) => Some(import_part(import, name)),
        Node::Item(Item::Let(_) | Item::Param(_) | Item::Decl(_)) | Node::Let(_) => {
            Some(node.span())
        }
        Node::Item(Item::Expr(_))
        | Node::Signature(_)
        | Node::Parm(_)
        | Node::Clause(_)
        | Node::Type(_)
        | Node::Expr(_)
        | Node::Arg(_)
        | Node::For(_) => None,
    });
    let removal = span.map(|span| (title, vec![(with_line(analysis, span), String::new())]));
    let keep = ("keep it, with a leading `_`".to_owned(), vec![(name.before(), "_".to_owned())]);
    let mut imports = analysis.tree.items.iter().filter_map(Item::as_import);
    let is_local =
        !analysis.slice(name).starts_with('_') && !imports.any(|import| import.span.contains(name));
    removal.into_iter().chain(is_local.then_some(keep)).collect()
}

/// The part of an import that brings in one name: all of it if there are no others.
fn import_part(import: &Import, name: Span) -> Span {
    let span_of = |at: usize| {
        let (first, renamed) = &import.names[at];
        renamed.as_ref().map_or(first.span, |renamed| first.span.to(renamed.span))
    };
    let holds_name = |at: &usize| span_of(*at).contains(name);
    let Some(at) = (0..import.names.len()).find(holds_name) else { return import.span };
    match (at, import.names.len()) {
        (_, 0 | 1) => import.span,
        (0, _) => Span { end: span_of(1).start, ..span_of(0) },
        (at, _) => Span { start: span_of(at - 1).end, ..span_of(at) },
    }
}

/// A span with the rest of its line, if nothing else is on the line.
fn with_line(analysis: &Analysis, span: Span) -> Span {
    let text = analysis.text();
    let (Some(before), Some(behind)) =
        (text.get(..span.start as usize), text.get(span.end as usize..))
    else {
        return span;
    };
    let line = before.rfind('\n').map_or(0, |at| at + 1);
    let rest = behind.find('\n').map_or(behind.len(), |at| at + 1);
    let blank = |text: &str| text.trim_matches([' ', '\t', '\r', '\n', ';']).is_empty();
    if blank(&before[line..]) && blank(&behind[..rest]) {
        return Span { start: line as u32, end: span.end + rest as u32, ..span };
    }
    let gap = behind.len() - behind.trim_start_matches([' ', ';']).len();
    let gap = if before[line..].trim().is_empty() || before.ends_with(' ') { gap } else { 0 };
    Span { end: span.end + gap as u32, ..span }
}

/// Extrudes or revolves a region.
fn make_solid(analysis: &Analysis, region: Span) -> Vec<Change> {
    let nodes = path(&analysis.tree, region.start as usize);
    let written = nodes.into_iter().filter_map(Node::expr).find(|e| e.span == region);
    let needs_parentheses = written.is_some_and(needs_parentheses);
    let change = |title: &str, call: &str| {
        let edits = match needs_parentheses {
            true => vec![(region.before(), "(".to_owned()), (region.after(), format!("){call}"))],
            false => vec![(region.after(), call.to_owned())],
        };
        (title.to_owned(), edits)
    };
    vec![change("extrude it", ".extrude(0.2)"), change("revolve it", ".revolve()")]
}
