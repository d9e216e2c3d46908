//! The front end for editors: it keeps what the compiler drops, and does not stop at errors.

use sdfc_diagnostics::{Diagnostic, FileId, Sources, has_errors};
use sdfc_syntax::ast;

use crate::font::Fonts;
use crate::hir::Program;
use crate::import::{Imported, Resolver};
use crate::uses::Uses;
use crate::{check_scene, elab};

/// A scene with all that its check found out.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// The syntax tree of the scene.
    pub tree: ast::File,
    /// The imported files.
    pub imports: Vec<Imported>,
    /// Names, types and calls.
    pub uses: Uses,
    /// The diagnostics of all phases that ran.
    pub diagnostics: Vec<Diagnostic>,
}

/// Parses, checks and, if there are no errors, elaborates a scene. Arguments as for
/// [`front_with_imports`](crate::front_with_imports).
pub fn inspect(sources: &mut Sources, file: FileId, resolver: &dyn Resolver) -> Inspection {
    let (mut inspection, program) = inspect_with(sources, file, resolver, Uses::default());
    if !has_errors(&inspection.diagnostics) {
        let (_, found) =
            elab::elaborate(&program, &Fonts::new(resolver), &elab::CompileValues::new());
        inspection.diagnostics.extend(found);
    }
    inspection
}

/// Parses and checks a scene in which the name `cursor` marks the position of the cursor. So
/// [`Uses::scope`] says which names are in scope there.
pub fn inspect_at(
    sources: &mut Sources,
    file: FileId,
    resolver: &dyn Resolver,
    cursor: &str,
) -> Inspection {
    inspect_with(sources, file, resolver, Uses::new(cursor)).0
}

fn inspect_with(
    sources: &mut Sources,
    file: FileId,
    resolver: &dyn Resolver,
    uses: Uses,
) -> (Inspection, Program) {
    let checked = check_scene(sources, file, resolver, Some(uses));
    let inspection = Inspection {
        tree: checked.tree,
        imports: checked.imports,
        uses: checked.uses.unwrap_or_default(),
        diagnostics: checked.found,
    };
    (inspection, checked.program)
}
