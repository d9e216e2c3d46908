//! Completions after a dot.

use sdfc_lang::hir::Type;
use sdfc_lang::library::describe_declaration;
use sdfc_lang::receivers::{kernel_takes, material_fields, takes};
use sdfc_syntax::ast::Decl;

use super::item::{Completion, CompletionKind};
use crate::analysis::Analysis;
use crate::declaration::describe;
use crate::library::library;

/// Returns the components of a value, and what can be called with it as the first argument: the
/// file's declarations, those of the library, and the functions of the kernel.
pub fn members(analysis: &Analysis, ty: &Type) -> Vec<Completion> {
    let mut found: Vec<Completion> = parts(ty)
        .into_iter()
        .map(|(name, ty)| Completion::new(CompletionKind::Property, name, 1).detail(ty))
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

/// The parts that a value of a type has, with their types; of the many orders of components, the
/// usual ones.
fn parts(ty: &Type) -> Vec<(String, String)> {
    let components = |names: &[&str]| {
        let of_width = |name: &str| match name.len() {
            1 => "number".to_owned(),
            width => format!("vec{width}"),
        };
        names.iter().map(|name| ((*name).to_owned(), of_width(name))).collect()
    };
    match ty {
        Type::Vec(2) => components(&["x", "y", "yx"]),
        Type::Vec(3) => components(&["x", "y", "z", "xy", "xz", "yz"]),
        Type::Vec(_) => components(&["x", "y", "z", "w", "xy", "zw", "xyz"]),
        Type::Color => components(&["r", "g", "b", "a", "rgb"]),
        Type::Range(of) => ["lo", "hi"].map(|end| (end.to_owned(), of.to_string())).to_vec(),
        Type::Record(fields) => {
            fields.iter().map(|(name, ty)| (name.clone(), ty.to_string())).collect()
        }
        Type::Material => {
            material_fields().map(|(name, ty)| (name.to_owned(), ty.to_string())).to_vec()
        }
        Type::Number
        | Type::Int
        | Type::Angle
        | Type::Bool
        | Type::Text
        | Type::List(_)
        | Type::Fn(..)
        | Type::Shape(_)
        | Type::Shadow
        | Type::Error => Vec::new(),
    }
}
