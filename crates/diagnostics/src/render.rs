//! From diagnostics to text for people, and to lines and columns for programs.

use codespan_reporting::diagnostic::{Diagnostic as Report, Label, LabelStyle};
use codespan_reporting::files::{Error, Files};
use codespan_reporting::term::{self, termcolor};

use crate::{Diagnostic, FileId, LineColumn, Severity, Sources, Span};

/// All of them as text with source lines and carets, in the order given.
pub fn render(sources: &Sources, diagnostics: &[Diagnostic], color: bool) -> String {
    let mut out = if color { termcolor::Buffer::ansi() } else { termcolor::Buffer::no_color() };
    let config = term::Config::default();
    for diagnostic in diagnostics {
        // Writing to memory fails only for a span outside its file; the message still counts.
        if term::emit_to_write_style(&mut out, &config, sources, &report(diagnostic)).is_err() {
            let line = format!("{}: {}\n", diagnostic.code, diagnostic.message);
            let _ = std::io::Write::write_all(&mut out, line.as_bytes());
        }
    }
    String::from_utf8_lossy(out.as_slice()).into_owned()
}

fn report(diagnostic: &Diagnostic) -> Report<FileId> {
    let label = |style, span: Span, message: &str| {
        Label::new(style, span.file, span.start as usize..span.end as usize).with_message(message)
    };
    let mut report = match diagnostic.severity {
        Severity::Error => Report::error(),
        Severity::Warning => Report::warning(),
    };
    report.labels.push(label(LabelStyle::Primary, diagnostic.span, &diagnostic.label));
    for note in &diagnostic.notes {
        match note.span {
            Some(span) => report.labels.push(label(LabelStyle::Secondary, span, &note.message)),
            None => report.notes.push(format!("note: {}", note.message)),
        }
    }
    let ways = diagnostic.ways_to_mend();
    report.notes.extend(ways.iter().map(|help| format!("help: {help}")));
    report.with_code(diagnostic.code.0).with_message(&diagnostic.message)
}

/// A diagnostic as `check --json` writes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Located {
    /// The code, `E0201`.
    pub code: &'static str,
    /// `error` or `warning`.
    pub severity: &'static str,
    /// What is wrong.
    pub message: String,
    /// Name of the file.
    pub file: String,
    /// Where it begins.
    pub start: LineColumn,
    /// Where it ends.
    pub end: LineColumn,
    /// Ways to mend it, one a line.
    pub help: String,
}

/// The diagnostic with its place as lines and columns.
pub fn locate(sources: &Sources, diagnostic: &Diagnostic) -> Located {
    let span = diagnostic.span;
    Located {
        code: diagnostic.code.0,
        severity: match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        },
        message: diagnostic.message.clone(),
        file: sources.name(span.file).to_owned(),
        start: sources.line_column(span.file, span.start),
        end: sources.line_column(span.file, span.end),
        help: diagnostic.ways_to_mend().join("\n"),
    }
}

impl<'a> Files<'a> for Sources {
    type FileId = FileId;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, file: FileId) -> Result<&'a str, Error> {
        Ok(self.name(file))
    }

    fn source(&'a self, file: FileId) -> Result<&'a str, Error> {
        Ok(self.text(file))
    }

    fn line_index(&'a self, file: FileId, offset: usize) -> Result<usize, Error> {
        Ok(self.line_column(file, offset as u32).line as usize - 1)
    }

    fn line_range(&'a self, file: FileId, line: usize) -> Result<std::ops::Range<usize>, Error> {
        self.line_bytes(file, line).ok_or(Error::LineTooLarge { given: line, max: 0 })
    }
}
