//! The library: its source files in `std`, and their documentation.
//!
//! All shapes, blends and patterns are written in the language, in these files. A new shape is a
//! new entry in one of them; no Rust code names a shape.
//!
//! The first line of an entry's doc comment is its summary. A line `name: ...` describes a
//! parameter, `source: ...` and `example: ...` are keys too, and all other lines are details. A
//! line that is indented by two blanks continues the line before it.

use sdfc_diagnostics::{FileId, Sources, Span};
use sdfc_syntax::ast::{self, DeclKind, Item};

/// Name and source of each file. Diagnostics show the name.
pub const FILES: &[(&str, &str)] = &[
    ("std/bezier.sdf", include_str!("../std/bezier.sdf")),
    ("std/combine.sdf", include_str!("../std/combine.sdf")),
    ("std/curves.sdf", include_str!("../std/curves.sdf")),
    ("std/distance.sdf", include_str!("../std/distance.sdf")),
    ("std/domain.sdf", include_str!("../std/domain.sdf")),
    ("std/fractals.sdf", include_str!("../std/fractals.sdf")),
    ("std/lift.sdf", include_str!("../std/lift.sdf")),
    ("std/material.sdf", include_str!("../std/material.sdf")),
    ("std/noise.sdf", include_str!("../std/noise.sdf")),
    ("std/polyhedra.sdf", include_str!("../std/polyhedra.sdf")),
    ("std/regions.sdf", include_str!("../std/regions.sdf")),
    ("std/rounds.sdf", include_str!("../std/rounds.sdf")),
    ("std/solids.sdf", include_str!("../std/solids.sdf")),
    ("std/surfaces.sdf", include_str!("../std/surfaces.sdf")),
];

/// Name and source of the default look: the settings of a scene that does not light itself.
pub const LOOK: (&str, &str) = ("std/look.sdf", include_str!("../std/look.sdf"));

/// Adds the library's files and the default look to `sources`, unless they are already there.
/// Returns their ids, that of the look last.
pub(crate) fn add_to(sources: &mut Sources) -> Vec<FileId> {
    FILES.iter().chain([&LOOK]).map(|(name, text)| add(sources, name, text)).collect()
}

fn add(sources: &mut Sources, name: &str, text: &str) -> FileId {
    let known = (0..sources.len() as u32).map(FileId);
    let mut known = known.filter(|&id| sources.name(id) == name && sources.text(id) == text);
    known.next().unwrap_or_else(|| sources.add(name, text))
}

/// The reference's entry for one name: a public declaration of the library, or a name that the
/// compiler itself knows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Entry {
    /// The name. A shape that is declared for solids and for regions has two entries.
    pub name: String,
    /// `fn`, `solid`, `region` or `shape` for the library; else `kernel`, `setting` or `type`.
    pub kind: &'static str,
    /// Its section: for the library the name of its file, without folder and extension.
    pub topic: &'static str,
    /// Name, parameters and result as in the source, on one line.
    pub signature: String,
    /// The first line of the documentation.
    pub summary: String,
    /// The prose after the first line, joined to one line; often empty.
    pub details: String,
    /// Name and description of each documented parameter.
    pub parameters: Vec<(String, String)>,
    /// The clauses as in the source, each on one line.
    pub clauses: Vec<String>,
    /// The source of the formula: a publication, or a derivation.
    pub source: String,
    /// An expression that uses the entry.
    pub example: String,
    /// For the library: the name of the file that declares it, and the line, counted from 1.
    pub location: Option<(&'static str, u32)>,
}

impl Entry {
    /// The clauses, separated by `; `.
    pub fn contract(&self) -> String {
        self.clauses.join("; ")
    }
}

/// All public declarations of the library, in the order of files and lines.
pub fn entries() -> Vec<Entry> {
    let mut sources = Sources::new();
    let mut entries = Vec::new();
    for (name, text) in FILES {
        let id = sources.add(*name, *text);
        let (file, _) = sdfc_syntax::parse(&sources, id);
        let declarations = file.items.iter().filter_map(Item::as_decl);
        let declarations = declarations.filter(|decl| !decl.name.text.starts_with('_'));
        entries.extend(declarations.map(|decl| entry(&sources, name, decl)));
    }
    entries
}

fn entry(sources: &Sources, file: &'static str, decl: &ast::Decl) -> Entry {
    let line = sources.line_column(decl.span.file, decl.span.start).line;
    Entry {
        topic: topic(file),
        location: Some((file, line)),
        ..describe_declaration(sources, decl)
    }
}

/// Describes a declaration of a scene or of the library, without topic and location.
pub fn describe_declaration(sources: &Sources, decl: &ast::Decl) -> Entry {
    let mut entry = Entry {
        name: decl.name.text.clone(),
        kind: match decl.kind {
            DeclKind::Fn => "fn",
            DeclKind::Solid => "solid",
            DeclKind::Region => "region",
            DeclKind::Shape => "shape",
        },
        signature: signature(sources, decl),
        clauses: clauses(sources, decl),
        ..Entry::default()
    };
    let mut lines = unwrapped(&decl.docs.lines).into_iter();
    entry.summary = lines.next().unwrap_or_default();
    for line in lines {
        describe(&mut entry, decl, &line);
    }
    entry
}

/// Joins each line that is indented by two blanks to the line before it.
fn unwrapped(lines: &[String]) -> Vec<String> {
    let mut joined: Vec<String> = Vec::new();
    for line in lines {
        match (line.strip_prefix("  "), joined.last_mut()) {
            (Some(rest), Some(last)) => {
                last.push(' ');
                last.push_str(rest.trim());
            }
            (Some(_), None) | (None, _) => joined.push(line.clone()),
        }
    }
    joined
}

/// The topic of a file: `solids` for `std/solids.sdf`.
fn topic(file: &'static str) -> &'static str {
    let name = file.rsplit('/').next().unwrap_or(file);
    name.strip_suffix(".sdf").unwrap_or(name)
}

/// Adds one line of documentation to an entry. Its key, such as `source:` or a parameter's name,
/// says which part of the entry it is; a line without a key is prose.
fn describe(entry: &mut Entry, decl: &ast::Decl, line: &str) {
    let keyed = line.split_once(':').map(|(key, text)| (key.trim(), text.trim().to_owned()));
    match keyed {
        Some(("source", text)) => entry.source = text,
        Some(("example", text)) => entry.example = text,
        Some((key, text)) if decl.signature.parms.iter().any(|parm| parm.name.text == key) => {
            entry.parameters.push((key.to_owned(), text));
        }
        Some(_) | None => {
            let gap = if entry.details.is_empty() { "" } else { " " };
            entry.details.push_str(gap);
            entry.details.push_str(line.trim());
        }
    }
}

fn signature(sources: &Sources, decl: &ast::Decl) -> String {
    let clauses = decl.signature.clauses.first();
    let end = clauses.map_or(decl.signature.span.end, |clause| clause.span.start);
    one_line(sources, Span { end, ..decl.name.span })
}

fn clauses(sources: &Sources, decl: &ast::Decl) -> Vec<String> {
    let clauses = decl.signature.clauses.iter();
    clauses.map(|clause| one_line(sources, clause.span)).collect()
}

/// The source of a span on one line, without comments. Each run of white space becomes one blank;
/// the blanks and commas that come from breaking a list into lines are dropped.
fn one_line(sources: &Sources, span: Span) -> String {
    let code = sources.slice(span).lines().map(|line| line.split("//").next().unwrap_or(line));
    let words: Vec<&str> = code.flat_map(str::split_whitespace).collect();
    words.join(" ").replace("( ", "(").replace("[ ", "[").replace(", )", ")").replace(", ]", "]")
}
