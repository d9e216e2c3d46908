//! Completions after a dot.

use sdfc_lang::hir::Type;
use sdfc_lang::library::describe_declaration;
use sdfc_lang::receivers::{kernel_takes, takes};
use sdfc_syntax::ast::Decl;

use super::item::{Completion, CompletionKind};
use crate::analysis::Analysis;
use crate::declaration::describe;
use crate::library::library;

/// Returns the components of a value, and what can be called with it as the first argument: the
/// file's declarations, those of the library, and the functions of the kernel.
pub fn members(analysis: &Analysis, ty: &Type) -> Vec<Completion> {
    let mut found: Vec<Completion> = components(ty)
        .iter()
        .map(|name| Completion::new(CompletionKind::Property, *name, 1).detail("number"))
        .collect();
    let takes = |decl: &&Decl| {
        decl.signature.parms.first().is_some_and(|parm| takes(parm, ty))
            && !decl.name.text.starts_with('_')
    };
    let scope = analysis.uses.scope.iter().flat_map(|scope| &scope.items);
    let own = scope.filter_map(|(name, span)| Some((name, analysis.declaration(*span)?)));
    found.extend(own.filter(|(_, decl)| takes(decl)).map(|(name, decl)| {
        let mut it = Completion::call(&describe(analysis, decl), true, 2);
        it.insert = it.insert.replacen(&it.label, name, 1);
        it.label = name.clone();
        it
    }));
    let sources = &library().sources;
    let of_library = library().declarations().filter(takes);
    found.extend(
        of_library.map(|decl| Completion::call(&describe_declaration(sources, decl), true, 3)),
    );
    let kernel = library().entries.iter().filter(|entry| entry.kind == "kernel");
    let kernel = kernel.filter(|entry| kernel_takes(&entry.name, ty));
    found.extend(kernel.map(|entry| Completion::call(entry, true, 4)));
    found
}

/// The components that a type has; of the many orders, the usual ones.
fn components(ty: &Type) -> &'static [&'static str] {
    match ty {
        Type::Vec(2) => &["x", "y", "yx"],
        Type::Vec(3) => &["x", "y", "z", "xy", "xz", "yz"],
        Type::Vec(_) => &["x", "y", "z", "w", "xy", "zw", "xyz"],
        Type::Color => &["r", "g", "b", "a", "rgb"],
        Type::Range(_) => &["lo", "hi"],
        Type::Number
        | Type::Int
        | Type::Angle
        | Type::Bool
        | Type::Text
        | Type::List(_)
        | Type::Fn(..)
        | Type::Shape(_)
        | Type::Material
        | Type::Shadow
        | Type::Error => &[],
    }
}
