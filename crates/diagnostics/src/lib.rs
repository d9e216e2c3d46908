//! Spans, codes and the one renderer of sdfc's diagnostics.
//!
//! # What
//!
//! A [`Diagnostic`] is plain data: a [`Code`], a severity, a message, a [`Span`] and the
//! ways to mend it. [`Sources`] owns the text of every file that was read, so that spans
//! are eight bytes and need no lifetime.
//!
//! # How
//!
//! Phases collect diagnostics in a `Vec` and go on; nothing stops at the first. [`render`]
//! is the only code that turns them into text for people, [`Located`] the only
//! one that turns them into lines and columns for programs.
//!
//! ```
//! use sdfc_diagnostics::{Code, Diagnostic, Sources, Span, render};
//!
//! let mut sources = Sources::new();
//! let file = sources.add("scene.sdf", "spere(1)\n");
//! let found = Diagnostic::error(Code::UNKNOWN_NAME, Span::new(file, 0, 5), "unknown name `spere`")
//!     .help("did you mean `sphere`?");
//! let text = render(&sources, &[found], false);
//! assert!(text.contains("E0201") && text.contains("scene.sdf:1:1"));
//! ```
//!
//! # Limits
//!
//! Files are at most 4 GiB (offsets are `u32`); the parser refuses far smaller ones.

mod codes;
mod excerpt;
mod render;
mod source;

pub use codes::{ALL_CODES, Code, CodeInfo};
pub use render::{Located, locate, render};
pub use source::{FileId, LineColumn, Sources, Span};

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The scene means something else than its author may think; it still compiles.
    Warning,
    /// The scene does not compile.
    Error,
}

/// A further place, or a further fact, that explains a diagnostic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// Where, if it has a place.
    pub span: Option<Span>,
    /// What, in one line, without a final stop.
    pub message: String,
}

/// One finding about a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Stable identity; has a page in the documentation.
    pub code: Code,
    /// Error or warning.
    pub severity: Severity,
    /// What is wrong, in one line, without a final stop.
    pub message: String,
    /// Where.
    pub span: Span,
    /// Text at the caret; empty when the message says it all.
    pub label: String,
    /// Other places that matter, in the order they should be read.
    pub notes: Vec<Note>,
    /// Ways to mend it in this case, best first; see [`Self::ways_to_mend`].
    pub help: Vec<String>,
}

impl Diagnostic {
    /// An error without label, notes or help.
    pub fn error(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, span, message.into())
    }

    /// A warning without label, notes or help.
    pub fn warning(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, span, message.into())
    }

    fn new(severity: Severity, code: Code, span: Span, message: String) -> Self {
        let (label, notes, help) = (String::new(), Vec::new(), Vec::new());
        Self { code, severity, message, span, label, notes, help }
    }

    /// With `label` at the caret.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// With a note that has no place.
    pub fn note(mut self, message: impl Into<String>) -> Self {
        self.notes.push(Note { span: None, message: message.into() });
        self
    }

    /// With a note at another place.
    pub fn note_at(mut self, span: Span, message: impl Into<String>) -> Self {
        self.notes.push(Note { span: Some(span), message: message.into() });
        self
    }

    /// With one more way to mend it.
    pub fn help(mut self, message: impl Into<String>) -> Self {
        self.help.push(message.into());
        self
    }

    /// Ways to mend it, best first: its own, or what its code has for all findings.
    pub fn ways_to_mend(&self) -> Vec<&str> {
        if !self.help.is_empty() {
            return self.help.iter().map(String::as_str).collect();
        }
        let row = ALL_CODES.iter().find(|row| row.code == self.code);
        row.map(|row| row.mend).into_iter().collect()
    }

    /// Whether it keeps the scene from compiling.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Whether any of them keeps the scene from compiling.
pub fn has_errors(diagnostics: &[Diagnostic]) -> bool {
    diagnostics.iter().any(Diagnostic::is_error)
}
