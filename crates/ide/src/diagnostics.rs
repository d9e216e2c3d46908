//! Errors and warnings as an editor shows them.

use std::ops::Range;

use sdfc_diagnostics::{Code, Diagnostic, Severity, has_errors};
use sdfc_lang::Resolver;
use sdfc_lang::inspect::elaborate;
use sdfc_syntax::ast::Item;

use crate::analysis::Analysis;
use crate::edit::{Location, range};
use crate::library::library_files;

/// A note about another position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Related {
    /// The position.
    pub at: Location,
    /// The note.
    pub message: String,
}

/// An error or a warning in the scene's own file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// The source range that is wrong; for an error in an imported file, the path of the import.
    pub range: Range<usize>,
    /// The severity.
    pub severity: Severity,
    /// The code, such as `E0201`.
    pub code: &'static str,
    /// The message with label, notes and suggestions, one per line.
    pub message: String,
    /// Notes about other positions.
    pub related: Vec<Related>,
    /// True if the range is code without use.
    pub unused: bool,
}

/// Returns the diagnostics of the scene that its analysis finds. Those of an imported file are
/// shown at the import. A file that another scene imports (`is_imported`) and a file of the library
/// need not draw anything.
pub fn diagnostics(analysis: &Analysis, is_imported: bool) -> Vec<Found> {
    let of_library = || library_files().iter().any(|(_, text)| *text == analysis.text());
    let shown = analysis
        .found
        .iter()
        .filter(|it| it.code != Code::NOTHING_DRAWN || !(is_imported || of_library()));
    shown.map(|it| found(analysis, it)).collect()
}

/// Elaborates the scene and returns the diagnostics that only this step finds, such as a failed
/// `require`. It takes longer than the analysis. A scene with other errors is not elaborated.
pub fn late_diagnostics(analysis: &Analysis, resolver: &dyn Resolver) -> Vec<Found> {
    if has_errors(&analysis.found) {
        return Vec::new();
    }
    elaborate(&analysis.program, resolver).iter().map(|it| found(analysis, it)).collect()
}

fn found(analysis: &Analysis, it: &Diagnostic) -> Found {
    let elsewhere = it.span.file != analysis.file;
    let at = Location::of(&analysis.sources, it.span);
    let mut related = Vec::new();
    let mut message = it.message.clone();
    if elsewhere {
        related.push(Related { at: at.clone(), message: it.message.clone() });
        message = format!("{}: {message}", at.file.rsplit('/').next().unwrap_or(&at.file));
    }
    let label = Some(it.label.as_str()).filter(|label| !label.is_empty());
    let notes = it.notes.iter().filter(|note| note.span.is_none());
    let lines = label.into_iter().chain(notes.map(|note| note.message.as_str()));
    for line in lines {
        message.push('\n');
        message.push_str(line);
    }
    for help in it.suggestions() {
        message.push_str("\nhelp: ");
        message.push_str(help);
    }
    for note in &it.notes {
        if let Some(span) = note.span {
            let at = Location::of(&analysis.sources, span);
            related.push(Related { at, message: note.message.clone() });
        }
    }
    Found {
        range: if elsewhere { import_of(analysis, it) } else { range(it.span) },
        severity: it.severity,
        code: it.code.0,
        message,
        related,
        unused: it.code == Code::UNUSED,
    }
}

/// The path of the import that leads to the file of a diagnostic; the start of the scene if it
/// leads there only through other files.
fn import_of(analysis: &Analysis, it: &Diagnostic) -> Range<usize> {
    let imports = analysis.tree.items.iter().filter_map(Item::as_import);
    let mut leading = imports.filter(|import| {
        let imported = analysis.imported_file(&import.path.text);
        imported.is_some_and(|imported| imported.file == it.span.file)
    });
    leading.next().map_or(0..0, |import| range(import.path.span))
}
