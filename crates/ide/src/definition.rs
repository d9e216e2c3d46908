//! The declaration of a name.

use sdfc_syntax::ast::Item;

use crate::analysis::{Analysis, Referent};
use crate::edit::{Location, range};

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
    let imports = analysis.tree.items.iter().filter_map(Item::as_import);
    let mut at_offset = imports.filter(|import| range(import.path.span).contains(&offset));
    let imported = analysis.imported_file(&at_offset.next()?.path.text)?;
    let file = analysis.sources.name(imported.file).to_owned();
    Some(Location { file, start: 0, end: 0 })
}
