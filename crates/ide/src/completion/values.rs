//! Names in scope.

use sdfc_lang::hir::Type;
use sdfc_lang::library::Entry;

use super::item::{CURSOR, Completion, CompletionKind};
use crate::analysis::Analysis;
use crate::declaration::{Declared, declared, describe, documentation, headline};
use crate::library::library;

/// Returns the names in scope: variables, then the file's, then those of the library, the kernel
/// and, where an item begins, the settings. Names of the expected type come first.
pub fn values(analysis: &Analysis, starts_item: bool) -> Vec<Completion> {
    let scope = analysis.uses.scope.clone().unwrap_or_default();
    let wanted = scope.expected.as_ref().map(ToString::to_string);
    let rank = |ty: &str, rank: u8| if wanted.as_deref() == Some(ty) { 0 } else { rank };
    let mut found: Vec<Completion> = Vec::new();
    for (name, ty) in scope.variables.iter().rev() {
        let ty = ty.to_string();
        let it = Completion::new(CompletionKind::Variable, name.clone(), rank(&ty, 2));
        found.push(it.detail(ty));
    }
    let items = scope.items.iter().filter(|(name, _)| name != CURSOR);
    found.extend(items.filter_map(|(name, span)| {
        let declared = declared(analysis, *span)?;
        let mut it = own(analysis, declared, |ty| rank(ty, 3))?;
        it.insert = it.insert.replacen(&it.label, name, 1);
        it.label = name.clone();
        Some(it)
    }));
    let shown = |entry: &&Entry| match entry.kind {
        "type" | "syntax" => false,
        "setting" => starts_item,
        _ => !entry.signature.starts_with("m."),
    };
    found.extend(library().entries.iter().filter(shown).map(|entry| {
        let fits = match (entry.kind, &scope.expected) {
            ("solid" | "region", Some(_)) => rank(entry.kind, 4),
            ("shape", Some(Type::Shape(_))) => 0,
            ("kernel", _) => 5,
            ("setting", _) => 6,
            (_, _) => 4,
        };
        Completion::call(entry, false, fits)
    }));
    found
}

/// A name that a file declares.
pub fn own(
    analysis: &Analysis,
    declared: Declared<'_>,
    rank: impl Fn(&str) -> u8,
) -> Option<Completion> {
    let ty = |name| analysis.uses.variables.get(&name).map(Type::to_string).unwrap_or_default();
    let docs = documentation(analysis, declared);
    let it = match declared {
        Declared::Decl(decl) => {
            let entry = describe(analysis, decl);
            return Some(Completion::call(&entry, false, rank(entry.kind)));
        }
        Declared::Param(it) => {
            let rank = rank(&ty(it.name.span));
            let item = Completion::new(CompletionKind::Param, it.name.text.clone(), rank);
            item.detail(headline(analysis, declared))
        }
        Declared::Let(it) => {
            let ty = ty(it.name.span);
            let item = Completion::new(CompletionKind::Variable, it.name.text.clone(), rank(&ty));
            item.detail(ty)
        }
        Declared::Parm(..) | Declared::For(_) => return None,
    };
    Some(it.docs(docs))
}
