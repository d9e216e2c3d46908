//! The uses of a name.

use std::ops::Range;

use sdfc_diagnostics::Span;

use crate::analysis::{Analysis, Occurrence, Referent};
use crate::edit::{Location, range};

/// The thing that a name refers to, independent of one analysis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Something that is declared at a location.
    Declared(Location),
    /// A name that the compiler knows.
    Other(Referent),
}

/// The subject of an occurrence.
pub fn subject(analysis: &Analysis, at: &Occurrence) -> Subject {
    match &at.referent {
        Referent::Declared(name) => Subject::Declared(Location::of(&analysis.sources, *name)),
        Referent::Implicit
        | Referent::Kernel(_)
        | Referent::Setting(_)
        | Referent::Parameter(..)
        | Referent::Type(_) => Subject::Other(at.referent.clone()),
    }
}

/// The occurrences of a subject in one analysis. Operators that call a declaration are left out.
pub fn occurrences<'a>(
    analysis: &'a Analysis,
    wanted: &'a Subject,
) -> impl Iterator<Item = &'a Occurrence> {
    analysis
        .occurrences()
        .iter()
        .filter(move |it| is_name(analysis.slice(it.span)) && subject(analysis, it) == *wanted)
}

/// True if a text is a name, not an operator. A name with letters that are errors, such as `é`, is
/// one too, so that it can be renamed.
fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Returns the uses of the name at a byte offset of the first scene, in that scene, in its imports
/// and in the other scenes. Positions that several scenes share are given once.
pub fn references(
    analysis: &Analysis,
    others: &[&Analysis],
    offset: usize,
    with_declaration: bool,
) -> Vec<Location> {
    let Some(at) = analysis.occurrence(offset) else { return Vec::new() };
    let wanted = subject(analysis, at);
    let mut found = Vec::new();
    for scene in std::iter::once(&analysis).chain(others) {
        let uses = occurrences(scene, &wanted).filter(|it| with_declaration || !it.declares);
        found.extend(uses.map(|it| Location::of(&scene.sources, it.span)));
    }
    found.sort();
    found.dedup();
    found
}

/// Returns the uses of the name at a byte offset in the scene's own file, and whether each declares
/// it.
pub fn highlights(analysis: &Analysis, offset: usize) -> Vec<(Range<usize>, bool)> {
    let Some(at) = analysis.occurrence(offset) else { return Vec::new() };
    let wanted = subject(analysis, at);
    let own = |span: Span| span.file == analysis.file;
    let uses = occurrences(analysis, &wanted).filter(|it| own(it.span));
    uses.map(|it| (range(it.span), it.declares)).collect()
}
