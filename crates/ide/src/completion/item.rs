//! One completion.

use std::ops::Range;

use sdfc_lang::library::Entry;

/// The name that marks the cursor in the text that is checked.
pub(super) const CURSOR: &str = "cursor_of_the_editor";

/// The kind of a completion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompletionKind {
    /// A variable, a parameter or a `let`.
    Variable,
    /// A `param`.
    Param,
    /// A function.
    Function,
    /// A solid, region or shape.
    Shape,
    /// A setting.
    Setting,
    /// A type.
    Type,
    /// A named argument.
    Argument,
    /// A component or an end, such as `.xy`.
    Property,
    /// A reserved word or a clause.
    Keyword,
    /// Code with gaps to fill in.
    Snippet,
    /// The path of a file.
    File,
    /// One of several strings that are allowed.
    Choice,
}

/// Something that can be written at the cursor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Completion {
    /// The text in the list.
    pub label: String,
    /// Its kind.
    pub kind: CompletionKind,
    /// Its signature or type.
    pub detail: String,
    /// Its description.
    pub docs: String,
    /// The text to insert. `$0` and `${1:name}` are gaps to fill in.
    pub insert: String,
    /// The range that it replaces.
    pub replace: Range<usize>,
    /// Its rank: completions that fit better have smaller ranks and come first.
    pub rank: u8,
}

impl Completion {
    /// A completion that inserts its label.
    pub(super) fn new(kind: CompletionKind, label: impl Into<String>, rank: u8) -> Self {
        let label = label.into();
        let insert = label.clone();
        let (detail, docs) = Default::default();
        Self { label, kind, detail, docs, insert, replace: 0..0, rank }
    }

    /// A call of an entry of the reference. As a method, its first argument is already there.
    pub(super) fn call(entry: &Entry, is_method: bool, rank: u8) -> Self {
        let kind = match entry.kind {
            "solid" | "region" | "shape" => CompletionKind::Shape,
            "setting" => CompletionKind::Setting,
            _ => CompletionKind::Function,
        };
        let mut it = Self::new(kind, entry.name.clone(), rank);
        it.detail = entry.signature.clone();
        it.docs = entry.summary.clone();
        let parameters = crate::signature::written_parameters(&entry.signature);
        let remaining = parameters.len().saturating_sub(usize::from(is_method));
        it.insert = match (parameters.is_empty(), remaining) {
            (true, _) if !entry.signature.contains('(') => it.insert,
            (_, 0) => format!("{}()", entry.name),
            (_, _) => format!("{}($0)", entry.name),
        };
        it
    }

    pub(super) fn detail(mut self, detail: impl Into<String>) -> Self {
        self.detail = detail.into();
        self
    }

    pub(super) fn docs(mut self, docs: impl Into<String>) -> Self {
        self.docs = docs.into();
        self
    }

    pub(super) fn insert(mut self, insert: impl Into<String>) -> Self {
        self.insert = insert.into();
        self
    }
}
