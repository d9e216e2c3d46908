//! The front end for editors: it keeps what the compiler drops, and does not stop at errors.
//!
//! Elaboration takes longer than parsing and checking, and finds few errors. So it is a separate
//! step.

use sdfc_diagnostics::{Diagnostic, FileId, Sources};
use sdfc_syntax::ast;

use crate::assets::Assets;
use crate::hir::Program;
use crate::import::{Imported, Resolver};
use crate::uses::Uses;
use crate::{check_scene, elab};

/// A scene with all that its check found out.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// The checked program; it is complete if there are no errors.
    pub program: Program,
    /// The syntax tree of the scene.
    pub tree: ast::File,
    /// The imported files.
    pub imports: Vec<Imported>,
    /// Names, types and calls.
    pub uses: Uses,
    /// The diagnostics of the parser, the imports and the checker.
    pub diagnostics: Vec<Diagnostic>,
}

/// Parses and checks a scene. Arguments as for
/// [`front_with_imports`](crate::front_with_imports).
pub fn inspect(sources: &mut Sources, file: FileId, resolver: &dyn Resolver) -> Inspection {
    inspect_with(sources, file, resolver, Uses::default())
}

/// Elaborates a scene without errors. Returns the diagnostics that only elaboration finds.
pub fn elaborate(program: &Program, resolver: &dyn Resolver) -> Vec<Diagnostic> {
    elab::elaborate(program, &Assets::new(resolver), &elab::CompileValues::new(), false).1
}

/// Parses and checks a scene in which the name `cursor` marks the position of the cursor. So
/// [`Uses::scope`] says which names are in scope there.
pub fn inspect_at(
    sources: &mut Sources,
    file: FileId,
    resolver: &dyn Resolver,
    cursor: &str,
) -> Inspection {
    inspect_with(sources, file, resolver, Uses::new(cursor))
}

fn inspect_with(
    sources: &mut Sources,
    file: FileId,
    resolver: &dyn Resolver,
    mut uses: Uses,
) -> Inspection {
    // About as many expressions as a scene has. A table that grows moves its entries.
    uses.types.reserve(sources.text(file).len() / 8);
    let checked = check_scene(sources, file, resolver, None, Some(uses));
    Inspection {
        program: checked.program,
        tree: checked.tree,
        imports: checked.imports,
        uses: checked.uses.unwrap_or_default(),
        diagnostics: checked.found,
    }
}
