//! Errors and warnings of one compilation, located and rendered.

mod origins;
pub(crate) mod refutations;
mod uncertified;
pub(crate) mod warnings;

use std::sync::Arc;

use sdfc_diagnostics::{
    Diagnostic, Located, LocatedEdit, LocatedFix, Sources, has_errors, locate, render,
};
use serde::Serialize;

/// All errors and warnings of one compilation, in the order of the compiler's phases.
///
/// `Display` renders them for people, with the source lines they are about. [`Self::located`] and
/// [`Self::rows`] give them as data.
#[derive(Clone)]
pub struct Diagnostics {
    sources: Arc<Sources>,
    list: Vec<Diagnostic>,
}

impl Diagnostics {
    pub(crate) fn new(sources: Arc<Sources>, list: Vec<Diagnostic>) -> Self {
        Self { sources, list }
    }

    /// The sources that the diagnostics point into: the scene, the library and all imports.
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// The diagnostics.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.list.iter()
    }

    /// Number of diagnostics.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// True if there are no errors and no warnings.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// True if at least one diagnostic is an error.
    pub fn has_errors(&self) -> bool {
        has_errors(&self.list)
    }

    /// The errors alone.
    #[must_use]
    pub fn without_warnings(&self) -> Self {
        let errors = self.iter().filter(|diagnostic| diagnostic.is_error()).cloned().collect();
        Self::new(Arc::clone(&self.sources), errors)
    }

    /// Renders the diagnostics for people, with source lines, in colour if `color` is set.
    pub fn render(&self, color: bool) -> String {
        render(&self.sources, &self.list, color)
    }

    /// The diagnostics with file names, lines and columns.
    pub fn located(&self) -> Vec<Located> {
        self.iter().map(|diagnostic| locate(&self.sources, diagnostic)).collect()
    }

    /// The diagnostics in the layout of `sdfc check --json`.
    pub fn rows(&self) -> Vec<DiagnosticRow> {
        self.located().into_iter().map(DiagnosticRow::from).collect()
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl std::fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.render(false).trim_end())
    }
}

impl std::fmt::Debug for Diagnostics {
    /// The rendered text: the fields would print the whole library.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Diagnostics\n{self}")
    }
}

impl std::error::Error for Diagnostics {}

/// A diagnostic as `sdfc check --json` writes it. Lines and columns count from 1.
///
/// Other tools rely on the keys: new ones may be added, none is renamed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct DiagnosticRow {
    /// The code, such as `E0201`.
    pub code: &'static str,
    /// `error` or `warning`.
    pub severity: &'static str,
    /// The problem, in one sentence.
    pub message: String,
    /// Name of the file.
    pub file: String,
    /// Line of the first character.
    pub line: u32,
    /// Column of the first character.
    pub column: u32,
    /// Line of the end.
    pub end_line: u32,
    /// Column after the last character.
    pub end_column: u32,
    /// Suggestions, one per line.
    pub help: String,
    /// Changes of the source that fix the problem, best first.
    pub fixes: Vec<FixRow>,
}

/// A change of the source, as `sdfc check --json` writes it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct FixRow {
    /// A few words that say what changes.
    pub title: String,
    /// The parts of the source that are replaced. They do not overlap.
    pub edits: Vec<EditRow>,
}

/// A part of the source with the text that replaces it. Lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct EditRow {
    /// Name of the file.
    pub file: String,
    /// Line of the first character.
    pub line: u32,
    /// Column of the first character.
    pub column: u32,
    /// Line of the end.
    pub end_line: u32,
    /// Column after the last character.
    pub end_column: u32,
    /// The new text.
    pub text: String,
}

impl From<Located> for DiagnosticRow {
    fn from(located: Located) -> Self {
        Self {
            code: located.code,
            severity: located.severity,
            message: located.message,
            file: located.file,
            line: located.start.line,
            column: located.start.column,
            end_line: located.end.line,
            end_column: located.end.column,
            help: located.help,
            fixes: located.fixes.into_iter().map(FixRow::from).collect(),
        }
    }
}

impl From<LocatedFix> for FixRow {
    fn from(fix: LocatedFix) -> Self {
        let row = |edit: LocatedEdit| EditRow {
            file: edit.file,
            line: edit.start.line,
            column: edit.start.column,
            end_line: edit.end.line,
            end_column: edit.end.column,
            text: edit.text,
        };
        Self { title: fix.title, edits: fix.edits.into_iter().map(row).collect() }
    }
}
