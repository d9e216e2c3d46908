//! The ranges that an editor can fold.

use std::ops::Range;

use sdfc_syntax::ast::Item;
use sdfc_syntax::{Class, classes};

use crate::analysis::Analysis;
use crate::edit::range;

/// The kind of text that is folded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FoldKind {
    /// Code in brackets, or a declaration.
    Code,
    /// Comments on lines of their own.
    Comment,
    /// Imports.
    Imports,
}

/// A range of several lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fold {
    /// The range.
    pub range: Range<usize>,
    /// Its kind.
    pub kind: FoldKind,
}

/// Returns the ranges that can be folded, in the order of the text.
pub fn folds(analysis: &Analysis) -> Vec<Fold> {
    let text = analysis.text();
    let mut ranges = brackets(text);
    ranges.extend(comments(text));
    let declarations = analysis.tree.items.iter().filter_map(Item::as_decl);
    ranges.extend(declarations.map(|it| Fold { range: range(it.span), kind: FoldKind::Code }));
    ranges.extend(imports(analysis));
    ranges.retain(|it| text.get(it.range.clone()).is_some_and(|text| text.contains('\n')));
    ranges.sort_by_key(|it| (it.range.start, it.range.end));
    ranges
}

fn brackets(text: &str) -> Vec<Fold> {
    let (mut open, mut folds) = (Vec::new(), Vec::new());
    for (class, range) in classes(text) {
        if class == Class::Open {
            open.push(range.start);
        } else if class == Class::Close
            && let Some(start) = open.pop()
        {
            folds.push(Fold { range: start..range.end, kind: FoldKind::Code });
        }
    }
    folds
}

/// Runs of comments with nothing between them.
fn comments(text: &str) -> Vec<Fold> {
    let mut folds: Vec<Fold> = Vec::new();
    let mut last: Option<Range<usize>> = None;
    for (class, range) in classes(text) {
        if !matches!(class, Class::Comment | Class::Docs) {
            last = None;
            continue;
        }
        let joins = last.filter(|last| {
            let gap = &text[last.end..range.start];
            gap.trim().is_empty() && gap.matches('\n').count() == 1
        });
        match (joins, folds.last_mut()) {
            (Some(_), Some(fold)) => fold.range.end = range.end,
            (Some(_) | None, _) => {
                folds.push(Fold { range: range.clone(), kind: FoldKind::Comment });
            }
        }
        last = Some(range);
    }
    folds
}

fn imports(analysis: &Analysis) -> Option<Fold> {
    let mut spans = analysis.tree.items.iter().map_while(Item::as_import).map(|it| it.span);
    let first = spans.next()?;
    let last = spans.last()?;
    Some(Fold { range: range(first.to(last)), kind: FoldKind::Imports })
}
