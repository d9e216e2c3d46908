//! Changes that an editor offers: fixes of diagnostics, and refactorings.
//!
//! - `fixes`: fixes that need the syntax tree;
//! - `extract`: a number becomes a param, an expression a `let`;
//! - `chain`: a call becomes a method call, and back;
//! - `change`: helpers to write a change.

mod chain;
mod change;
mod extract;
mod fixes;

use std::ops::Range;

use sdfc_diagnostics::Diagnostic;

use crate::analysis::Analysis;
use crate::edit::{Edit, Location};
use change::Change;

/// The kind of an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActionKind {
    /// It fixes a diagnostic.
    Fix,
    /// It gives a part of the code a name.
    Extract,
    /// It writes the same in another way.
    Rewrite,
}

/// A change with its title.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Action {
    /// A few words that say what changes.
    pub title: String,
    /// Its kind.
    pub kind: ActionKind,
    /// The changes.
    pub edits: Vec<Edit>,
    /// True for the best fix of its diagnostic.
    pub preferred: bool,
}

/// Returns the fixes of the diagnostics that touch a byte range, and the refactorings of the code
/// there.
pub fn actions(analysis: &Analysis, selected: Range<usize>) -> Vec<Action> {
    let action = |(title, edits): Change, kind, preferred| {
        let edits = edits
            .into_iter()
            .map(|(span, text)| Edit { at: Location::of(&analysis.sources, span), text });
        Action { title, kind, edits: edits.collect(), preferred }
    };
    let touches = |it: &&Diagnostic| {
        it.span.file == analysis.file
            && it.span.start as usize <= selected.end
            && selected.start <= it.span.end as usize
    };
    let mut actions = Vec::new();
    for it in analysis.found.iter().filter(touches) {
        let written = it.fixes.iter().map(|fix| (fix.title.clone(), fix.edits.clone()));
        let fixes = written.chain(fixes::structural(analysis, it)).enumerate();
        actions.extend(fixes.map(|(at, change)| action(change, ActionKind::Fix, at == 0)));
    }
    let param = extract::to_param(analysis, &selected);
    let name = extract::to_let(analysis, &selected);
    let extracted = param.into_iter().chain(name);
    actions.extend(extracted.map(|change| action(change, ActionKind::Extract, false)));
    let call = chain::turned(analysis, &selected);
    actions.extend(call.map(|change| action(change, ActionKind::Rewrite, false)));
    actions
}
