//! A document whose line breaks are not decided yet.

use std::borrow::Cow;

/// A piece of layout.
#[derive(Debug)]
pub(super) struct Doc<'a> {
    pub kind: Kind<'a>,
    /// True if the document has a mandatory line break or a comment.
    pub hard: bool,
}

/// The kinds of documents. *Flat* means all on one line; otherwise each kind says where it breaks.
#[derive(Debug)]
pub(super) enum Kind<'a> {
    /// Text without line breaks.
    Text(Cow<'a, str>),
    /// A line break, or this text if flat.
    Line(&'static str),
    /// A mandatory line break, with a blank line if `blank`.
    Hard { blank: bool },
    /// A comment and the end of its line. A comment with `own_line` also begins a line.
    Comment { text: &'a str, own_line: bool, blank_after: bool },
    /// Documents one after the other.
    Concat(Vec<Doc<'a>>),
    /// Documents one after the other, indented by one step.
    Indent(Vec<Doc<'a>>),
    /// Flat if it fits.
    Group(Vec<Doc<'a>>),
    /// Brackets around elements.
    Brackets(Box<Brackets<'a>>),
    /// Method calls.
    Chain(Box<Chain<'a>>),
    /// A head, `=` and a body.
    Equation(Box<Equation<'a>>),
}

/// `(a, b)`: flat; or one element per line, each with a comma; or only `hug` over several lines,
/// everything else beside its first and last line.
#[derive(Debug)]
pub(super) struct Brackets<'a> {
    pub open: Doc<'a>,
    pub elements: Vec<Doc<'a>>,
    /// The comments behind each element's comma.
    pub notes: Vec<Doc<'a>>,
    /// Comments behind the last element.
    pub comments: Doc<'a>,
    pub close: Doc<'a>,
    /// The index of the element that may take several lines alone.
    pub hug: Option<usize>,
}

/// `a.f(x).g(y)`: flat; or with a line break before each link; or inline, the last link over
/// several lines.
#[derive(Debug)]
pub(super) struct Chain<'a> {
    pub head: Doc<'a>,
    pub links: Vec<Doc<'a>>,
    /// True if there are enough calls to break before links.
    pub breaks: bool,
}

/// `head clauses = body`: flat; or clauses and `=` on lines of their own; or the body on the
/// line below `=`; or the body beside `=`, over several lines.
#[derive(Debug)]
pub(super) struct Equation<'a> {
    pub head: Doc<'a>,
    pub clauses: Vec<Doc<'a>>,
    /// True if each clause gets its own line even if all fit on one.
    pub open: bool,
    pub equals: Doc<'a>,
    pub body: Doc<'a>,
    pub below: Below,
}

/// Says when a body that does not fit beside its `=` goes to the line below.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Below {
    /// Never, because it begins with a bracket that stays beside the `=`.
    Never,
    /// If it fits there on one line.
    IfItFits,
    /// Always, because it takes several lines that begin alike.
    Always,
}

pub(super) const NOTHING: Doc<'static> = Doc { kind: Kind::Text(Cow::Borrowed("")), hard: false };

fn any_hard(docs: &[Doc<'_>]) -> bool {
    docs.iter().any(|doc| doc.hard)
}

pub(super) fn text<'a>(text: impl Into<Cow<'a, str>>) -> Doc<'a> {
    Doc { kind: Kind::Text(text.into()), hard: false }
}

pub(super) fn line<'a>(flat: &'static str) -> Doc<'a> {
    Doc { kind: Kind::Line(flat), hard: false }
}

pub(super) fn hard<'a>(blank: bool) -> Doc<'a> {
    Doc { kind: Kind::Hard { blank }, hard: true }
}

pub(super) fn comment(text: &str, own_line: bool, blank_after: bool) -> Doc<'_> {
    Doc { kind: Kind::Comment { text, own_line, blank_after }, hard: true }
}

pub(super) fn concat(docs: Vec<Doc<'_>>) -> Doc<'_> {
    Doc { hard: any_hard(&docs), kind: Kind::Concat(docs) }
}

pub(super) fn indent(docs: Vec<Doc<'_>>) -> Doc<'_> {
    Doc { hard: any_hard(&docs), kind: Kind::Indent(docs) }
}

pub(super) fn group(docs: Vec<Doc<'_>>) -> Doc<'_> {
    Doc { hard: any_hard(&docs), kind: Kind::Group(docs) }
}

pub(super) fn brackets(parts: Brackets<'_>) -> Doc<'_> {
    let ends = parts.open.hard || parts.comments.hard || parts.close.hard;
    let hard = ends || any_hard(&parts.elements) || any_hard(&parts.notes);
    Doc { hard, kind: Kind::Brackets(Box::new(parts)) }
}

pub(super) fn chain(parts: Chain<'_>) -> Doc<'_> {
    let hard = parts.head.hard || any_hard(&parts.links);
    Doc { hard, kind: Kind::Chain(Box::new(parts)) }
}

pub(super) fn equation(parts: Equation<'_>) -> Doc<'_> {
    let body = parts.equals.hard || parts.body.hard;
    let hard = parts.open || parts.head.hard || any_hard(&parts.clauses) || body;
    Doc { hard, kind: Kind::Equation(Box::new(parts)) }
}
