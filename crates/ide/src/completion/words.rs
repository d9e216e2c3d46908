//! Types, clauses, imported names, and snippets.

use sdfc_syntax::ast::Item;

use super::item::{Completion, CompletionKind};
use super::values::own;
use crate::analysis::Analysis;
use crate::declaration::Declared;
use crate::library::library;

/// Label, text to insert, and description of a snippet.
type Snippet = (&'static str, &'static str, &'static str);

const ITEMS: [Snippet; 6] = [
    ("let", "let ${1:name} = $0", "A name for a value."),
    (
        "param",
        "param ${1:name} = ${2:1} in ${3:0..2}",
        "A value that can change without a recompile.",
    ),
    ("fn", "fn ${1:name}(${2:x}) = $0", "A function."),
    (
        "solid",
        "solid ${1:name}(${2:r: length = 1})\n  = ${3:length(p) - r}$0",
        "A 3D shape: its formula is a signed distance at `p`.",
    ),
    (
        "region",
        "region ${1:name}(${2:r: length = 1})\n  = ${3:length(p) - r}$0",
        "A 2D shape: its formula is a signed distance at `p`.",
    ),
    ("import", "import ${2:name} from \"${1:file.sdf}\"", "Names of another file."),
];

const EXPRESSIONS: [Snippet; 5] = [
    ("if", "if ${1:condition} { $2 } else { $0 }", "One of two values."),
    ("fn(...)", "fn(${1:q}) = $0", "A function without a name."),
    ("for", "for ${1:i} in ${2:0..4}: $0", "A value for each element of a sequence."),
    ("true", "true", "The bool that is true."),
    ("false", "false", "The bool that is false."),
];

const CLAUSES: [Snippet; 8] = [
    ("exact", "exact", "The field is the distance to the surface."),
    ("bound", "bound", "The field is at most the distance to the surface."),
    ("lipschitz", "lipschitz ${1:1}", "The most that the field changes per unit of length."),
    ("bounds", "bounds ${1:[-1, -1, -1]} .. ${2:[1, 1, 1]}", "A box around the shape."),
    ("material", "material $0", "The material of the surface."),
    ("intersect", "intersect $0", "The intervals of a ray that are inside."),
    ("copies", "copies", "Shapes that are not sampled are at least as far as the formula says."),
    (
        "require",
        "require ${1:condition}, \"${2:message}\"",
        "A condition that the arguments must fulfil.",
    ),
];

fn snippets(rows: &[Snippet], kind: CompletionKind) -> Vec<Completion> {
    let item = |(label, insert, docs): &Snippet| {
        Completion::new(kind, *label, 7).insert(*insert).docs(*docs)
    };
    rows.iter().map(item).collect()
}

/// Returns what an item can begin with.
pub fn items() -> Vec<Completion> {
    snippets(&ITEMS, CompletionKind::Snippet)
}

/// Returns what an expression can begin with, apart from names.
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
    let wanted = path.trim_start_matches("./");
    let Some(file) = analysis.imports.iter().find(|import| import.path == wanted) else {
        return Vec::new();
    };
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
