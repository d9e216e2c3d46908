//! Gives something another name, wherever it is used.

use std::ops::Range;

use sdfc_diagnostics::Span;
use sdfc_syntax::{Class, classes};

use crate::analysis::{Analysis, Occurrence, Referent};
use crate::edit::{Edit, Location, range};
use crate::library::library_files;
use crate::references::{Subject, occurrences, subject};

/// Returns the range of the name at a byte offset.
///
/// # Errors
///
/// Returns the reason if there is nothing that can be renamed.
pub fn prepare_rename(analysis: &Analysis, offset: usize) -> Result<Range<usize>, String> {
    Ok(range(renamable(analysis, offset)?.0.span))
}

/// The name at an offset and the span of its declared name, if it can be renamed.
fn renamable(analysis: &Analysis, offset: usize) -> Result<(&Occurrence, Span), String> {
    let at = analysis.occurrence(offset).ok_or("there is no name here")?;
    let written = analysis.slice(at.span);
    let Referent::Declared(name) = at.referent else {
        return Err(format!("`{written}` belongs to the language and cannot be renamed"));
    };
    let declared = analysis.sources.name(name.file);
    if library_files().iter().any(|(file, _)| *file == declared) {
        return Err(format!("`{written}` belongs to the library and cannot be renamed"));
    }
    Ok((at, name))
}

/// Renames what the name at a byte offset of a scene refers to: in the scene, its imports, and the
/// other scenes that use it. If an import gives it another name, only that name changes, and only
/// in its file.
///
/// # Errors
///
/// Returns the reason if it cannot be renamed, if `to` is not a name, or if one of the files
/// already uses that name.
pub fn rename(
    analysis: &Analysis,
    others: &[&Analysis],
    offset: usize,
    to: &str,
) -> Result<Vec<Edit>, String> {
    let (at, name) = renamable(analysis, offset)?;
    check_name(to)?;
    let written = analysis.slice(at.span);
    let file = analysis.sources.name(at.span.file);
    let wanted = subject(analysis, at);
    let only = (analysis.slice(name) != written).then_some(file);
    let mut edits = Vec::new();
    for scene in std::iter::once(&analysis).chain(others) {
        edits.extend(edits_of(scene, &wanted, written, to, only)?);
    }
    if edits.is_empty() {
        let file = analysis.sources.name(name.file);
        return Err(format!("`{written}` in {file} cannot be renamed"));
    }
    edits.sort();
    edits.dedup();
    Ok(edits)
}

/// The changes that one scene and its imports need.
fn edits_of(
    scene: &Analysis,
    wanted: &Subject,
    written: &str,
    to: &str,
    only: Option<&str>,
) -> Result<Vec<Edit>, String> {
    let mut edits = Vec::new();
    for it in occurrences(scene, wanted).filter(|it| scene.slice(it.span) == written) {
        let at = Location::of(&scene.sources, it.span);
        if only.is_none_or(|only| only == at.file) {
            edits.push(Edit { at, text: to.to_owned() });
        }
    }
    let mut files: Vec<&str> = edits.iter().map(|edit| edit.at.file.as_str()).collect();
    files.dedup();
    for file in files {
        let text = scene.text_of(file).unwrap_or_default();
        let has = |(class, range): &(Class, Range<usize>)| {
            *class == Class::Name && text.get(range.clone()) == Some(to)
        };
        if to != written && classes(text).iter().any(has) {
            return Err(format!("`{to}` already appears in {file}: choose another name"));
        }
    }
    Ok(edits)
}

fn check_name(to: &str) -> Result<(), String> {
    let whole = [(Class::Name, 0..to.len())];
    if classes(to) == whole {
        return Ok(());
    }
    match sdfc_syntax::is_reserved(to) {
        true => Err(format!("`{to}` is a reserved word, not a name")),
        false => Err(format!("`{to}` is not a name: use the letters a to z, digits and `_`")),
    }
}
