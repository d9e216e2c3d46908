//! Positions in files, and changes of them.

use std::ops::Range;

use sdfc_diagnostics::{Sources, Span};

/// A byte range of a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Location {
    /// The name of the file: as the scene was named, `std/solids.sdf` for the library.
    pub file: String,
    /// Offset of the first byte.
    pub start: usize,
    /// Offset after the last byte.
    pub end: usize,
}

impl Location {
    /// Converts a span.
    pub(crate) fn of(sources: &Sources, span: Span) -> Self {
        let file = sources.name(span.file).to_owned();
        Self { file, start: span.start as usize, end: span.end as usize }
    }

    /// The byte range.
    pub fn range(&self) -> Range<usize> {
        self.start..self.end
    }
}

/// A change: text that replaces a byte range.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Edit {
    /// The range that is replaced.
    pub at: Location,
    /// The new text.
    pub text: String,
}

/// Returns the byte range of a span.
pub(crate) fn range(span: Span) -> Range<usize> {
    span.start as usize..span.end as usize
}
