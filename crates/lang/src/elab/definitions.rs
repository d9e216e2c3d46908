//! The definitions of a program: their names in the graph, and the spans of their clauses.

use rustc_hash::{FxHashMap, FxHashSet};
use sdfc_graph::Dim;

use super::output::{Declared, DeclaredPromise};
use crate::hir::{self, Promise};

/// The name of each definition in the graph: its own, with a number if the program has several of
/// that name and dimension (a scene's `sphere` beside the library's).
pub(super) fn definition_names(program: &hir::Program) -> Vec<String> {
    let mut count: FxHashMap<(&str, Dim), u32> = FxHashMap::default();
    let taken: FxHashSet<&str> = program.shapes.iter().map(|shape| shape.name.as_str()).collect();
    let mut names = Vec::with_capacity(program.shapes.len());
    for shape in &program.shapes {
        let times = count.entry((&shape.name, shape.dim)).or_insert(0);
        *times += 1;
        let mut name = shape.name.clone();
        while *times > 1 && taken.contains(name.as_str()) {
            name = format!("{}_{times}", shape.name);
            *times += 1;
        }
        names.push(name);
    }
    names
}

/// The shapes that the scene and its imports declare. `names` are the names of all definitions.
pub(super) fn declared(program: &hir::Program, names: &[String]) -> Vec<Declared> {
    let own = program.shapes.iter().zip(names).filter(|(s, _)| !program.library.contains(&s.file));
    let promise = |stated: &Promise| DeclaredPromise {
        exact: stated.exact,
        outside: stated.outside,
        inside: stated.inside,
        span: stated.span,
    };
    own.map(|(shape, name)| Declared {
        definition: name.clone(),
        promises: shape.promises.iter().map(promise).collect(),
        lipschitz: shape.lipschitz.as_ref().map(|stated| stated.span),
        bounds: shape.bounds.as_ref().map(|stated| stated.span),
        intersect: shape.intersect.as_ref().map(|stated| stated.value.span),
        copies: shape.copies,
    })
    .collect()
}

/// True if any shape of the program states a material. A shape that states only weights mixes the
/// materials of other shapes.
pub(super) fn has_materials(program: &hir::Program) -> bool {
    let mut stated = program.shapes.iter().filter_map(|shape| shape.material.as_ref());
    stated.any(|material| material.ty == hir::Type::Material)
}
