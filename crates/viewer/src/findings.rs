//! What is wrong with the scene, as the window shows it: the terminal's words, with places to click.

use sdfc::Compiled;
use sdfc::diagnostics::{Diagnostic, Sources, locate};

use crate::document;

/// All that was found in one text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// In order of place.
    pub all: Vec<Finding>,
}

/// One finding.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// `E0201`.
    pub code: &'static str,
    /// Whether it keeps the scene from compiling.
    pub is_error: bool,
    /// What is wrong.
    pub message: String,
    /// Name of the file.
    pub file: String,
    /// Line and column, from 1.
    pub place: [u32; 2],
    /// The line that it is about.
    pub line: String,
    /// The part of that line that it is about, in characters from 0.
    pub marked: std::ops::Range<usize>,
    /// What stands at the mark.
    pub label: String,
    /// Further facts, then ways to mend it.
    pub help: Vec<String>,
}

impl Findings {
    /// Of a compilation.
    pub fn of(compiled: &Compiled) -> Self {
        let finding = |found: &Diagnostic| Finding::of(&compiled.sources, found);
        Self { all: compiled.diagnostics.iter().map(finding).collect() }
    }

    /// How many keep the scene from compiling.
    pub fn errors(&self) -> usize {
        self.all.iter().filter(|found| found.is_error).count()
    }
}

impl Finding {
    fn of(sources: &Sources, found: &Diagnostic) -> Self {
        let located = locate(sources, found);
        let line = document::line(sources, found.span.file, located.start.line);
        let length = line.chars().count();
        let from = (located.start.column as usize - 1).min(length);
        let to = match located.end.line == located.start.line {
            true => (located.end.column as usize - 1).min(length),
            false => length,
        };
        let notes = found.notes.iter().map(|note| match note.span {
            Some(span) => {
                let place = sources.line_column(span.file, span.start);
                let file = sources.name(span.file);
                format!("{file}:{}:{}: {}", place.line, place.column, note.message)
            }
            None => note.message.clone(),
        });
        let help = found.suggestions().into_iter().map(|way| format!("help: {way}"));
        Self {
            code: located.code,
            is_error: found.is_error(),
            message: located.message,
            file: located.file,
            place: [located.start.line, located.start.column],
            line,
            marked: from..to.max(from),
            label: found.label.clone(),
            help: notes.chain(help).collect(),
        }
    }

    /// `file:line:column`.
    pub fn location(&self) -> String {
        let [line, column] = self.place;
        format!("{}:{line}:{column}", self.file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_knows_its_line_and_how_to_mend_it() {
        let compiled = sdfc::compile("ball.sdf", "\u{feff}let a = 1\r\nspere(a)\r\n");
        let findings = Findings::of(&compiled);
        assert_eq!(findings.errors(), 1);
        let found = findings.all.iter().find(|found| found.is_error).unwrap();
        assert_eq!((found.location().as_str(), found.line.as_str()), ("ball.sdf:2:1", "spere(a)"));
        assert_eq!(found.marked, 0..5);
        assert!(found.help.iter().any(|help| help.contains("`sphere`")), "{:?}", found.help);
    }
}
