//! Types, clauses, imported names, and snippets.

use sdfc_syntax::ast::Item;

use super::item::{Completion, CompletionKind};
use super::values::own;
use crate::analysis::Analysis;
use crate::declaration::Declared;
use crate::library::library;

/// The label and the text to insert of a snippet. The reference describes the label's word.
type Snippet = (&'static str, &'static str);

const ITEMS: [Snippet; 7] = [
    ("let", "let ${1:name} = $0"),
    ("param", "param ${1:name} = ${2:1} in ${3:0..2}"),
    ("fn", "fn ${1:name}(${2:x}) = $0"),
    ("solid", "solid ${1:name}(${2:r: length = 1})\n  = ${3:length(p) - r}$0"),
    ("region", "region ${1:name}(${2:r: length = 1})\n  = ${3:length(p) - r}$0"),
    ("shape", "shape ${1:name}(${2:a: shape})\n  = ${3:a(p)}$0"),
    ("import", "import ${2:name} from \"${1:file.sdf}\""),
];

const EXPRESSIONS: [Snippet; 5] = [
    ("if", "if ${1:condition} { $2 } else { $0 }"),
    ("fn(...)", "fn(${1:q}) = $0"),
    ("for", "for ${1:i} in ${2:0..4}: $0"),
    ("true", "true"),
    ("false", "false"),
];

const CLAUSES: [Snippet; 8] = [
    ("exact", "exact"),
    ("bound", "bound"),
    ("lipschitz", "lipschitz ${1:1}"),
    ("bounds", "bounds ${1:[-1, -1, -1]} .. ${2:[1, 1, 1]}"),
    ("material", "material $0"),
    ("intersect", "intersect $0"),
    ("copies", "copies"),
    ("require", "require ${1:condition}, \"${2:message}\""),
];

fn snippets(rows: &[Snippet], kind: CompletionKind) -> Vec<Completion> {
    let item = |(label, insert): &Snippet| {
        let word = label.trim_end_matches("(...)");
        let about = library().entry("syntax", word).map(|entry| entry.summary.clone());
        Completion::new(kind, *label, 7).insert(*insert).docs(about.unwrap_or_default())
    };
    rows.iter().map(item).collect()
}

/// Returns the declarations that an item can begin with.
pub fn items() -> Vec<Completion> {
    snippets(&ITEMS, CompletionKind::Snippet)
}

/// Returns the words that an expression can begin with.
pub fn expressions() -> Vec<Completion> {
    snippets(&EXPRESSIONS, CompletionKind::Keyword)
}

/// Returns the clauses of declarations.
pub fn clauses() -> Vec<Completion> {
    snippets(&CLAUSES, CompletionKind::Keyword)
}

/// Returns all types.
pub fn types() -> Vec<Completion> {
    let types = library().entries.iter().filter(|entry| entry.kind == "type");
    let item = types.map(|entry| {
        Completion::new(CompletionKind::Type, entry.name.clone(), 1).docs(entry.summary.clone())
    });
    item.collect()
}

/// Returns the public names of an imported file.
pub fn imported(analysis: &Analysis, path: &str) -> Vec<Completion> {
    let Some(file) = analysis.imported_file(path) else { return Vec::new() };
    let named = file.tree.items.iter().filter_map(|item| match item {
        Item::Decl(it) => Some(Declared::Decl(it)),
        Item::Param(it) => Some(Declared::Param(it)),
        Item::Let(it) => Some(Declared::Let(it)),
        Item::Import(_) | Item::Expr(_) => None,
    });
    let names = named.filter_map(|declared| own(analysis, declared, |_| 1));
    let public = names.filter(|it| !it.label.starts_with('_'));
    public.map(|it| Completion { insert: it.label.clone(), ..it }).collect()
}
