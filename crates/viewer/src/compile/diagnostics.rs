//! Errors and warnings of a scene as the window shows them: the command line's words, with source
//! positions to click.

use sdfc::{Diagnostic, Diagnostics, Sources};
use sdfc_diagnostics::{Fix, Span, locate};

use crate::scene::document::source_line;

/// The errors and warnings of one source.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneDiagnostics {
    /// In the order of their positions.
    pub all: Vec<ShownDiagnostic>,
}

/// One error or warning.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownDiagnostic {
    /// Its code, such as `E0201`.
    pub code: &'static str,
    /// True for an error, false for a warning.
    pub is_error: bool,
    /// The message.
    pub message: String,
    /// Name of the file, as the scene calls it.
    pub file: String,
    /// Line and column, from 1.
    pub position: [u32; 2],
    /// The marked range of the file, in bytes.
    pub range: std::ops::Range<usize>,
    /// Changes of the file that an editor can make.
    pub fixes: Vec<ShownFix>,
    /// The source line.
    pub line: String,
    /// The marked range of that line, in characters from 0.
    pub marked: std::ops::Range<usize>,
    /// The label at the marked range.
    pub label: String,
    /// Notes, then suggestions.
    pub help: Vec<String>,
}

/// A change of the file that a diagnostic proposes.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownFix {
    /// What the change does.
    pub title: String,
    /// Ranges of the file with the text that replaces each of them.
    pub edits: Vec<(Span, String)>,
}

impl SceneDiagnostics {
    /// The diagnostics of a compilation.
    pub fn new(diagnostics: &Diagnostics) -> Self {
        let shown =
            |diagnostic: &Diagnostic| ShownDiagnostic::new(diagnostics.sources(), diagnostic);
        Self { all: diagnostics.iter().map(shown).collect() }
    }

    /// The number of errors.
    pub fn errors(&self) -> usize {
        self.all.iter().filter(|found| found.is_error).count()
    }
}

impl ShownDiagnostic {
    fn new(sources: &Sources, found: &Diagnostic) -> Self {
        let located = locate(sources, found);
        let line = source_line(sources, found.span.file, located.start.line);
        let length = line.chars().count();
        let from = (located.start.column as usize - 1).min(length);
        let to = match located.end.line == located.start.line {
            true => (located.end.column as usize - 1).min(length),
            false => length,
        };
        let notes = found.notes.iter().map(|note| match note.span {
            Some(span) => {
                let at = sources.line_column(span.file, span.start);
                let file = sources.name(span.file);
                format!("{file}:{}:{}: {}", at.line, at.column, note.message)
            }
            None => note.message.clone(),
        });
        let help = found.suggestions().into_iter().map(|way| format!("help: {way}"));
        Self {
            code: located.code,
            is_error: found.is_error(),
            message: located.message,
            file: located.file,
            position: [located.start.line, located.start.column],
            range: found.span.start as usize..found.span.end as usize,
            fixes: found.fixes.iter().filter_map(|fix| ShownFix::new(fix, found)).collect(),
            line,
            marked: from..to.max(from),
            label: found.label.clone(),
            help: notes.chain(help).collect(),
        }
    }

    /// The position as `file:line:column`.
    pub fn location(&self) -> String {
        let [line, column] = self.position;
        format!("{}:{line}:{column}", self.file)
    }
}

impl ShownFix {
    /// `None` if the fix changes another file than that of the diagnostic.
    fn new(fix: &Fix, found: &Diagnostic) -> Option<Self> {
        let is_own = fix.edits.iter().all(|(span, _)| span.file == found.span.file);
        is_own.then(|| Self { title: fix.title.clone(), edits: fix.edits.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagnostic_has_its_source_line_and_suggestions() {
        let compiled = sdfc::Compiler::new().check("ball.sdf", "\u{feff}let a = 1\r\nspere(a)\r\n");
        let diagnostics = SceneDiagnostics::new(&compiled);
        assert_eq!(diagnostics.errors(), 1);
        let found = diagnostics.all.iter().find(|found| found.is_error).unwrap();
        assert_eq!((found.location().as_str(), found.line.as_str()), ("ball.sdf:2:1", "spere(a)"));
        assert_eq!(found.marked, 0..5);
        assert!(found.help.iter().any(|help| help.contains("`sphere`")), "{:?}", found.help);
    }
}
