//! Source spans, diagnostic codes and the renderer of diagnostics.
//!
//! # What
//!
//! A [`Diagnostic`] is plain data: a [`Code`], a severity, a message, a [`Span`] and
//! suggestions. [`Sources`] owns the text of every file that was read, so a span holds only a
//! file and two offsets and needs no lifetime.
//!
//! # How
//!
//! Phases collect diagnostics in a `Vec` and continue after the first. Only [`render`] turns them
//! into text for people, and only [`locate`] into lines and columns for programs.
//!
//! ```
//! use sdfc_diagnostics::{Code, Diagnostic, Sources, Span, render};
//!
//! let mut sources = Sources::new();
//! let file = sources.add("scene.sdf", "spere(1)\n");
//! let span = Span::new(file, 0, 5);
//! let unknown = Diagnostic::error(Code::UNKNOWN_NAME, span, "unknown name `spere`")
//!     .help("did you mean `sphere`?");
//! let text = render(&sources, &[unknown], false);
//! assert!(text.contains("E0201") && text.contains("scene.sdf:1:1"));
//! ```
//!
//! # Limits
//!
//! Files are at most 4 GiB, because offsets are `u32`. The parser has a far lower limit.

mod codes;
mod excerpt;
mod render;
mod source;

pub use codes::{ALL_CODES, Code, CodeInfo};
pub use render::{Located, LocatedEdit, LocatedFix, locate, render};
pub use source::{FileId, LineColumn, Sources, Span};

/// The severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The scene compiles, but may not mean what its author intended.
    Warning,
    /// The scene does not compile.
    Error,
}

/// A further fact that explains a diagnostic, with or without a position in the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// The position that the note refers to, if any.
    pub span: Option<Span>,
    /// The message: one line, without a final full stop.
    pub message: String,
}

/// A change of the source that follows a suggestion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// What the change does, in a few words.
    pub title: String,
    /// Source ranges with the text that replaces each of them.
    pub edits: Vec<(Span, String)>,
}

/// An error or a warning about a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The stable code, which has a page in the documentation.
    pub code: Code,
    /// The severity.
    pub severity: Severity,
    /// What is wrong: one line, without a final full stop.
    pub message: String,
    /// The source range that is wrong.
    pub span: Span,
    /// The text at the caret; empty if the message is enough.
    pub label: String,
    /// Further facts, in the order in which they should be read.
    pub notes: Vec<Note>,
    /// Suggestions for this case, best first; see [`Self::suggestions`].
    pub help: Vec<String>,
    /// Changes that an editor can make, best first.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// Creates an error without label, notes or help.
    pub fn error(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, span, message.into())
    }

    /// Creates a warning without label, notes or help.
    pub fn warning(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, span, message.into())
    }

    fn new(severity: Severity, code: Code, span: Span, message: String) -> Self {
        let (label, notes, help, fixes) = Default::default();
        Self { code, severity, message, span, label, notes, help, fixes }
    }

    /// Sets the text at the caret.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Adds a note without a position.
    pub fn note(mut self, message: impl Into<String>) -> Self {
        self.notes.push(Note { span: None, message: message.into() });
        self
    }

    /// Adds a note about another source range.
    pub fn note_at(mut self, span: Span, message: impl Into<String>) -> Self {
        self.notes.push(Note { span: Some(span), message: message.into() });
        self
    }

    /// Adds a suggestion.
    pub fn help(mut self, message: impl Into<String>) -> Self {
        self.help.push(message.into());
        self
    }

    /// Adds a change that replaces one source range.
    pub fn fix(self, title: impl Into<String>, span: Span, text: impl Into<String>) -> Self {
        self.fix_all(title, vec![(span, text.into())])
    }

    /// Adds a change that replaces source ranges, which do not overlap.
    pub fn fix_all(mut self, title: impl Into<String>, edits: Vec<(Span, String)>) -> Self {
        self.fixes.push(Fix { title: title.into(), edits });
        self
    }

    /// Returns its own suggestions, best first, or else the general suggestion of its code.
    pub fn suggestions(&self) -> Vec<&str> {
        if !self.help.is_empty() {
            return self.help.iter().map(String::as_str).collect();
        }
        let row = ALL_CODES.iter().find(|row| row.code == self.code);
        row.map(|row| row.suggestion).into_iter().collect()
    }

    /// Returns true if it keeps the scene from compiling.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Returns true if any of the diagnostics keeps the scene from compiling.
pub fn has_errors(diagnostics: &[Diagnostic]) -> bool {
    diagnostics.iter().any(Diagnostic::is_error)
}
