//! Diagnostics as text for people, and as lines and columns for programs.

use std::borrow::Cow;

use codespan_reporting::diagnostic::{Diagnostic as Report, Label, LabelStyle};
use codespan_reporting::term::{self, termcolor};

use crate::excerpt::Excerpts;
use crate::{Diagnostic, FileId, Fix, LineColumn, Severity, Sources, Span};

/// The most characters of a message that are shown, since names in it may be of any length.
const MAX_MESSAGE: usize = 400;

/// Renders diagnostics with source lines and carets, in the given order.
///
/// Lines and messages that are too long to read are shortened.
pub fn render(sources: &Sources, diagnostics: &[Diagnostic], color: bool) -> String {
    let mut out = if color { termcolor::Buffer::ansi() } else { termcolor::Buffer::no_color() };
    let config = term::Config::default();
    for diagnostic in diagnostics {
        let excerpts = Excerpts::around(sources, &positions(diagnostic));
        let report = report(sources, diagnostic, &excerpts);
        // Writing to memory fails only for a span outside its file; the message still counts.
        if term::emit_to_write_style(&mut out, &config, &excerpts, &report).is_err() {
            let line = format!("{}: {}\n", diagnostic.code, shortened(&diagnostic.message));
            let _ = std::io::Write::write_all(&mut out, line.as_bytes());
        }
    }
    String::from_utf8_lossy(out.as_slice()).into_owned()
}

/// Returns the start and end of every span, those of the diagnostic itself first.
fn positions(diagnostic: &Diagnostic) -> Vec<(FileId, usize)> {
    let noted = diagnostic.notes.iter().filter_map(|note| note.span);
    let spans = std::iter::once(diagnostic.span).chain(noted);
    spans.flat_map(|s| [(s.file, s.start as usize), (s.file, s.end as usize)]).collect()
}

fn report(sources: &Sources, diagnostic: &Diagnostic, excerpts: &Excerpts<'_>) -> Report<FileId> {
    let mut report = match diagnostic.severity {
        Severity::Error => Report::error(),
        Severity::Warning => Report::warning(),
    };
    let mut add = |style, span: Option<Span>, message: &str| {
        let message = shortened(message);
        let shown = span.and_then(|s| excerpts.shown(s.file, s.start as usize..s.end as usize));
        match (span, shown) {
            (Some(span), Some(shown)) => {
                report.labels.push(Label::new(style, span.file, shown).with_message(message));
            }
            (Some(span), None) => {
                let LineColumn { line, column } = sources.line_column(span.file, span.start);
                let name = sources.name(span.file);
                report.notes.push(format!("note: {name}:{line}:{column}: {message}"));
            }
            (None, _) => report.notes.push(format!("note: {message}")),
        }
    };
    add(LabelStyle::Primary, Some(diagnostic.span), &diagnostic.label);
    for note in diagnostic.notes.iter() {
        add(LabelStyle::Secondary, note.span, &note.message);
    }
    let suggestions = diagnostic.suggestions();
    report.notes.extend(suggestions.iter().map(|help| format!("help: {}", shortened(help))));
    report.with_code(diagnostic.code.0).with_message(shortened(&diagnostic.message))
}

/// Returns a message without its middle if it is longer than [`MAX_MESSAGE`].
fn shortened(message: &str) -> Cow<'_, str> {
    let Some((cut, _)) = message.char_indices().nth(MAX_MESSAGE) else { return message.into() };
    let end = message.char_indices().rev().nth(MAX_MESSAGE / 4).map_or(cut, |(at, _)| at).max(cut);
    format!("{}…{}", &message[..cut], &message[end..]).into()
}

/// A diagnostic with its position, as `check --json` writes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Located {
    /// The code, `E0201`.
    pub code: &'static str,
    /// `error` or `warning`.
    pub severity: &'static str,
    /// What is wrong.
    pub message: String,
    /// The name of the file.
    pub file: String,
    /// The start of its source range.
    pub start: LineColumn,
    /// The end of its source range.
    pub end: LineColumn,
    /// Suggestions, one per line.
    pub help: String,
    /// Changes that fix it, best first.
    pub fixes: Vec<LocatedFix>,
}

/// A change of the source with its positions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LocatedFix {
    /// A few words that say what changes.
    pub title: String,
    /// The source ranges that are replaced.
    pub edits: Vec<LocatedEdit>,
}

/// A source range with the text that replaces it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LocatedEdit {
    /// The name of the file.
    pub file: String,
    /// The start of the source range.
    pub start: LineColumn,
    /// The end of the source range.
    pub end: LineColumn,
    /// The new text.
    pub text: String,
}

/// Converts a diagnostic's span to lines and columns.
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
        help: diagnostic.suggestions().join("\n"),
        fixes: diagnostic.fixes.iter().map(|fix| locate_fix(sources, fix)).collect(),
    }
}

fn locate_fix(sources: &Sources, fix: &Fix) -> LocatedFix {
    let edits = fix.edits.iter().map(|(span, text)| LocatedEdit {
        file: sources.name(span.file).to_owned(),
        start: sources.line_column(span.file, span.start),
        end: sources.line_column(span.file, span.end),
        text: text.clone(),
    });
    LocatedFix { title: fix.title.clone(), edits: edits.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Code;

    fn rendered(text: String, span: std::ops::Range<usize>) -> String {
        let mut sources = Sources::new();
        let file = sources.add("long.sdf", text);
        let span = Span::new(file, span.start as u32, span.end as u32);
        let found = Diagnostic::error(Code::UNKNOWN_NAME, span, "unknown");
        render(&sources, &[found], false)
    }

    #[test]
    fn a_long_line_is_shortened_around_the_span() {
        let text = format!("{}wrong{}", "é".repeat(5_000), "ü".repeat(5_000));
        let shown = rendered(text, 10_000..10_005);
        assert!(shown.contains("long.sdf:1:5001"), "{shown}");
        let line = shown.lines().find(|line| line.contains("wrong")).unwrap_or_default();
        assert!(line.contains("│ …") && line.trim_end().ends_with('…'), "{shown}");
        let caret = shown.lines().find(|line| line.contains("^^^^^")).unwrap_or_default();
        let column = |line: &str, what| line.find(what).map(|at| line[..at].chars().count());
        assert_eq!(column(line, "wrong"), column(caret, "^^^^^"), "{shown}");
        assert!(shown.len() < 1_000, "{} bytes", shown.len());
    }

    #[test]
    fn every_span_of_a_long_line_is_rendered() {
        let texts = ["x".repeat(700), "é".repeat(400), "😀".repeat(200)];
        for text in texts.into_iter().flat_map(|text| [format!("{text}\nb"), text + "x"]) {
            let ends: Vec<usize> =
                (0..=text.len()).filter(|&at| text.is_char_boundary(at)).collect();
            for (i, &start) in ends.iter().enumerate() {
                for &end in ends.iter().skip(i).step_by(7) {
                    let shown = rendered(text.clone(), start..end);
                    assert!(shown.contains("┌─ long.sdf:"), "{start}..{end}: {shown}");
                }
            }
        }
    }

    #[test]
    fn long_spans_and_messages_are_shortened() {
        let shown = rendered("x".repeat(100_000), 5..100_000);
        assert!(shown.len() < 1_000, "{} bytes", shown.len());
        let message = "x".repeat(100_000) + " is wrong";
        assert!(shortened(&message).chars().count() < 600);
        assert!(shortened(&message).ends_with(" is wrong"));
    }
}
