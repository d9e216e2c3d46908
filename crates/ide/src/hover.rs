//! The description of the name under the mouse.

use std::ops::Range;

use sdfc_diagnostics::Span;
use sdfc_lang::library::{Entry, describe_declaration};
use sdfc_syntax::{Class, classes};

use crate::analysis::{Analysis, Referent};
use crate::declaration::{Declared, declared, describe, documentation, headline};
use crate::edit::range;
use crate::facts::{Facts, facts_at};
use crate::library::library;

/// A text about a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hover {
    /// The name.
    pub range: Range<usize>,
    /// The text, as Markdown.
    pub markdown: String,
    /// A scene that shows what the name stands for, if it is an entry of the library.
    pub example: Option<ExampleScene>,
}

/// The example of a library entry, a scene of one line.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ExampleScene {
    /// The name of the entry.
    pub name: String,
    /// The source.
    pub source: String,
}

/// Describes the name at a byte offset: its signature, documentation, units, defaults and source,
/// and the facts about the shape that it stands for. Describes words of the syntax too.
pub fn hover(analysis: &Analysis, offset: usize, facts: &mut Facts<'_>) -> Option<Hover> {
    let Some(at) = analysis.occurrence(offset) else { return of_word(analysis, offset) };
    let mut markdown = match &at.referent {
        Referent::Declared(name) => of_declared(analysis, *name),
        Referent::Implicit => of_implicit(analysis, at.span),
        Referent::Kernel(name) => library().entry("kernel", name).map(of_entry),
        Referent::Setting(name) => library().entry("setting", name).map(of_entry),
        Referent::Type(word) => library().entry("type", word).map(of_entry),
        Referent::Parameter(kind, of, name) => {
            let entry = library().entry(kind, of)?;
            let about = entry.parameters.iter().find(|(parameter, _)| parameter == name);
            let about = about.map(|(_, about)| about.as_str()).unwrap_or_default();
            Some(page(&format!("{}: {}", of, name), &[about.to_owned()]))
        }
    }?;
    if let Some(known) = facts_at(analysis, offset, facts) {
        markdown.push_str(&format!("\nHere: {}\n\n{}\n", known.quality, known.cost));
    }
    let example = match &at.referent {
        Referent::Declared(name) => example(*name),
        Referent::Implicit
        | Referent::Kernel(_)
        | Referent::Setting(_)
        | Referent::Parameter(..)
        | Referent::Type(_) => None,
    };
    Some(Hover { range: range(at.span), markdown, example })
}

/// The example of a library entry, by the span of its declared name.
fn example(name: Span) -> Option<ExampleScene> {
    let entry = describe_declaration(&library().sources, library().declaration(name)?);
    let is_drawn = matches!(entry.kind, "solid" | "region" | "shape") && !entry.example.is_empty();
    is_drawn.then_some(ExampleScene { name: entry.name, source: entry.example })
}

/// Describes a word of the syntax, such as `let` or `exact`.
fn of_word(analysis: &Analysis, offset: usize) -> Option<Hover> {
    let text = analysis.text();
    let mut tokens = classes(text).into_iter();
    let (class, range) = tokens.find(|(_, range)| range.start <= offset && offset < range.end)?;
    let is_member = text[..range.start].trim_end().ends_with('.');
    if !matches!(class, Class::Keyword | Class::Name) || is_member {
        return None;
    }
    let entry = library().entry("syntax", &text[range.clone()])?;
    Some(Hover { range, markdown: of_entry(entry), example: None })
}

fn of_declared(analysis: &Analysis, name: Span) -> Option<String> {
    let found = declared(analysis, name)?;
    Some(match found {
        Declared::Decl(decl) => of_entry(&describe(analysis, decl)),
        Declared::Param(_) | Declared::Let(_) | Declared::Parm(..) | Declared::For(_) => {
            page(&headline(analysis, found), &[documentation(analysis, found)])
        }
    })
}

fn of_implicit(analysis: &Analysis, used: Span) -> Option<String> {
    let name = analysis.slice(used);
    let about = match name {
        "p" => "The point at which the formula gives the signed distance.",
        "o" => "The origin of the ray.",
        "d" => "The direction of the ray, of length 1.",
        _ => return None,
    };
    let ty = analysis.uses.types.get(&used)?;
    Some(page(&format!("{name}: {ty}"), &[about.to_owned()]))
}

/// The page of an entry of the reference.
pub fn of_entry(entry: &Entry) -> String {
    let parameters = entry.parameters.iter().map(|(name, about)| format!("- `{name}`: {about}\n"));
    let labelled = |label: &str, text: &str, code: bool| match (text, code) {
        ("", _) => String::new(),
        (text, true) => format!("{label}: `{text}`"),
        (text, false) => format!("{label}: {text}"),
    };
    let head = match entry.kind {
        "kernel" | "setting" | "type" | "syntax" => entry.signature.clone(),
        kind => format!("{kind} {}", entry.signature),
    };
    page(
        &head,
        &[
            entry.summary.clone(),
            entry.details.clone(),
            parameters.collect(),
            labelled("Contract", &entry.contract(), true),
            labelled("Example", &entry.example, true),
            labelled("Source", &entry.source, false),
            match entry.location {
                Some((file, line)) => format!("Declared in {file}:{line}"),
                None => String::new(),
            },
        ],
    )
}

/// A line of code with paragraphs below it. Empty paragraphs are left out.
pub fn page(code: &str, paragraphs: &[String]) -> String {
    let mut page = format!("```sdf\n{code}\n```\n");
    for paragraph in paragraphs.iter().map(|it| it.trim_end()).filter(|it| !it.is_empty()) {
        page.push('\n');
        page.push_str(paragraph);
        page.push('\n');
    }
    page
}
