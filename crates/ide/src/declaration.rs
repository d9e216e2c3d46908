//! The declaration of a name, and its description.

use sdfc_diagnostics::Span;
use sdfc_lang::hir::Type;
use sdfc_lang::library::{Entry, describe_declaration};
use sdfc_syntax::ast::{Comprehension, Decl, Docs, Item, Let, Param, Parm};

use crate::analysis::Analysis;
use crate::tree::{Node, nodes};

/// A declaration of any kind.
#[derive(Clone, Copy, Debug)]
pub enum Declared<'a> {
    Decl(&'a Decl),
    Param(&'a Param),
    Let(&'a Let),
    /// A parameter, and the declaration that it belongs to unless that is a lambda.
    Parm(&'a Parm, Option<&'a Decl>),
    For(&'a Comprehension),
}

/// The declaration whose name has this span.
pub fn declared(analysis: &Analysis, name: Span) -> Option<Declared<'_>> {
    let tree = analysis.tree_of(name.file)?;
    let at = tree.items.partition_point(|item| Node::Item(item).span().end < name.end);
    let item = tree.items.get(at).filter(|item| Node::Item(item).span().contains(name))?;
    let mut owner = None;
    for node in nodes(std::slice::from_ref(item)) {
        let found = match node {
            Node::Item(Item::Decl(it)) => {
                owner = Some(&**it);
                (it.name.span == name).then_some(Declared::Decl(it))
            }
            Node::Item(Item::Param(it)) => (it.name.span == name).then_some(Declared::Param(it)),
            Node::Item(Item::Let(it)) => (it.name.span == name).then_some(Declared::Let(it)),
            Node::Item(Item::Import(_) | Item::Expr(_)) => None,
            Node::Parm(it) => {
                let owner = owner.filter(|decl| {
                    decl.signature.parms.iter().any(|parm| parm.name.span == it.name.span)
                });
                (it.name.span == name).then_some(Declared::Parm(it, owner))
            }
            Node::Let(it) => (it.name.span == name).then_some(Declared::Let(it)),
            Node::For(it) => (it.name.span == name).then_some(Declared::For(it)),
            Node::Signature(_) | Node::Clause(_) | Node::Type(_) | Node::Expr(_) | Node::Arg(_) => {
                None
            }
        };
        if found.is_some() {
            return found;
        }
    }
    None
}

/// Describes a declaration of a scene or the library as the reference does.
pub fn describe(analysis: &Analysis, decl: &Decl) -> Entry {
    describe_declaration(&analysis.sources, decl)
}

/// One line that declares something, with its type.
pub fn headline(analysis: &Analysis, declared: Declared<'_>) -> String {
    let ty = |name: Span| match analysis.uses.variables.get(&name) {
        Some(Type::Error) | None => String::new(),
        Some(ty) => format!(": {ty}"),
    };
    match declared {
        Declared::Decl(decl) => {
            let entry = describe(analysis, decl);
            format!("{} {}", entry.kind, entry.signature)
        }
        Declared::Param(it) => {
            let range = it.range.as_ref().map(|range| analysis.slice(range.span));
            let range = range.map(|range| format!(" in {range}")).unwrap_or_default();
            let default = analysis.slice(it.default.span);
            one_line(&format!("param {}{} = {default}{range}", it.name.text, ty(it.name.span)))
        }
        Declared::Let(it) => format!("let {}{}", it.name.text, ty(it.name.span)),
        Declared::Parm(it, _) if it.ty.is_some() || it.default.is_some() => {
            one_line(analysis.slice(it.span))
        }
        Declared::Parm(it, _) => format!("{}{}", it.name.text, ty(it.name.span)),
        Declared::For(it) => format!("for {}{}", it.name.text, ty(it.name.span)),
    }
}

/// The documentation of what was declared, as prose.
pub fn documentation(analysis: &Analysis, declared: Declared<'_>) -> String {
    let prose = |docs: &Docs| docs.lines.join("\n");
    match declared {
        Declared::Decl(decl) => prose(&decl.docs),
        Declared::Param(it) => prose(&it.docs),
        Declared::Parm(it, Some(decl)) => {
            let parameters = describe(analysis, decl).parameters.into_iter();
            let mut about = parameters.filter(|(name, _)| *name == it.name.text);
            about.next().map(|(_, about)| about).unwrap_or_default()
        }
        Declared::Parm(_, None) | Declared::Let(_) | Declared::For(_) => String::new(),
    }
}

/// The text on one line.
pub fn one_line(text: &str) -> String {
    let code = text.lines().map(|line| line.split("//").next().unwrap_or(line));
    code.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ")
}
