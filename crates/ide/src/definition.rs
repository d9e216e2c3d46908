//! Where a name is declared.

use crate::analysis::{Analysis, Referent};
use crate::edit::Location;
use crate::tree::{Node, path};
use sdfc_syntax::ast::Item;

/// Returns the declaration of the name at a byte offset. For the path of an import, that is the
/// start of the imported file. Names of the kernel, settings and types have no source.
pub fn definition(analysis: &Analysis, offset: usize) -> Option<Location> {
    let Some(at) = analysis.occurrence(offset) else { return imported_file(analysis, offset) };
    match &at.referent {
        Referent::Declared(name) => Some(Location::of(&analysis.sources, *name)),
        Referent::Kernel(_) | Referent::Setting(_) | Referent::Type(_) => None,
        Referent::Parameter(..) | Referent::Implicit => None,
    }
}

fn imported_file(analysis: &Analysis, offset: usize) -> Option<Location> {
    let Some(Node::Item(Item::Import(import))) = path(&analysis.tree, offset).first().copied()
    else {
        return None;
    };
    let at = import.path.span;
    if !(at.start as usize..at.end as usize).contains(&offset) {
        return None;
    }
    let wanted = import.path.text.trim_start_matches("./");
    let imported = analysis.imports.iter().find(|import| import.path == wanted)?;
    let file = analysis.sources.name(imported.file).to_owned();
    Some(Location { file, start: 0, end: 0 })
}
