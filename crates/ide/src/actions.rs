//! Changes that an editor offers for diagnostics.

use std::ops::Range;

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_syntax::ast::{ExprKind, Import, Item};

use crate::analysis::Analysis;
use crate::edit::{Edit, Location};
use crate::tree::{Node, path};

/// A change with its title.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Action {
    /// What it does.
    pub title: String,
    /// The code of the diagnostic that it fixes.
    pub code: &'static str,
    /// The range of that diagnostic.
    pub range: Range<usize>,
    /// The changes.
    pub edits: Vec<Edit>,
    /// True for the best change for its diagnostic.
    pub preferred: bool,
}

/// Returns the changes that fix diagnostics which touch a byte range.
pub fn actions(analysis: &Analysis, range: Range<usize>) -> Vec<Action> {
    let touches = |it: &&Diagnostic| {
        it.span.file == analysis.file
            && it.span.start as usize <= range.end
            && range.start <= it.span.end as usize
    };
    let mut actions = Vec::new();
    for it in analysis.found.iter().filter(touches) {
        let written = it.fixes.iter().map(|fix| (fix.title.clone(), fix.edits.clone()));
        let fixes = written.chain(structural(analysis, it));
        for (at, (title, edits)) in fixes.enumerate() {
            let edits = edits
                .into_iter()
                .map(|(span, text)| Edit { at: Location::of(&analysis.sources, span), text });
            actions.push(Action {
                title,
                code: it.code.0,
                range: it.span.start as usize..it.span.end as usize,
                edits: edits.collect(),
                preferred: at == 0,
            });
        }
    }
    actions
}

/// Title and replacements of a change.
type Change = (String, Vec<(Span, String)>);

/// Changes that need the syntax tree.
fn structural(analysis: &Analysis, it: &Diagnostic) -> Vec<Change> {
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
    let underscore = Span { end: name.start, ..name };
    let keep = ("keep it, with a leading `_`".to_owned(), vec![(underscore, "_".to_owned())]);
    let is_local = !analysis.slice(name).starts_with('_')
        && !analysis.tree.items.iter().any(|item| match item {
            Item::Import(import) => import.span.start <= name.start && name.end <= import.span.end,
            Item::Param(_) | Item::Decl(_) | Item::Let(_) | Item::Expr(_) => false,
        });
    removal.into_iter().chain(is_local.then_some(keep)).collect()
}

/// The part of an import that brings in one name: all of it if there are no others.
fn import_part(import: &Import, name: Span) -> Span {
    let span_of = |at: usize| {
        let (first, renamed) = &import.names[at];
        renamed.as_ref().map_or(first.span, |renamed| first.span.to(renamed.span))
    };
    let holds = |at: &usize| span_of(*at).start <= name.start && name.end <= span_of(*at).end;
    let Some(at) = (0..import.names.len()).find(holds) else { return import.span };
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
    let needs_parentheses = nodes.iter().any(|node| match node {
        Node::Expr(e) if e.span == region => matches!(
            e.kind,
            ExprKind::Binary(..) | ExprKind::Unary(..) | ExprKind::If(..) | ExprKind::Lambda(..)
        ),
        Node::Item(_)
        | Node::Signature(_)
        | Node::Parm(_)
        | Node::Clause(_)
        | Node::Type(_)
        | Node::Let(_)
        | Node::Expr(_)
        | Node::Arg(_)
        | Node::For(_) => false,
    });
    let before = Span { end: region.start, ..region };
    let change = |title: &str, call: &str| {
        let edits = match needs_parentheses {
            true => vec![(before, "(".to_owned()), (region.after(), format!("){call}"))],
            false => vec![(region.after(), call.to_owned())],
        };
        (title.to_owned(), edits)
    };
    vec![change("extrude it", ".extrude(0.2)"), change("revolve it", ".revolve()")]
}
