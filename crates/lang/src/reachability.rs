//! Finds the library items that a scene can use; only these are parsed and checked.
//!
//! A library item is used by its name. So a scene can use only the items whose names occur in its
//! source, the items whose names occur in those, and so on. If the check of a scene fails, it is
//! repeated with the whole library, since messages suggest names that the scene does not mention.

use std::ops::Range;
use std::sync::OnceLock;

use rustc_hash::FxHashMap;
use sdfc_diagnostics::{FileId, Sources, has_errors};
use sdfc_syntax::ast::{self, Item};

use crate::check::{CheckedItems, SceneFiles, check_items};
use crate::library;
use crate::uses::Uses;

/// The library items that scenes use without a name: `|`, `&` and `-` call them, and `union` also
/// joins the shapes that are drawn.
const OPERATORS: [&str; 3] = ["union", "intersection", "difference"];

/// Checks a scene and its imports against the library, whose files have these ids in `sources`.
pub(crate) fn check(
    sources: &Sources,
    library: &[FileId],
    of_scene: SceneFiles<'_>,
    uses: Option<Uses>,
) -> CheckedItems {
    // File ids are part of every span. So parsed items can be reused only if the library's files
    // have the same ids, which is always the case for fresh `Sources`.
    static FIRST: OnceLock<Library> = OnceLock::new();
    let other;
    let first = FIRST.get_or_init(|| Library::new(library));
    let library = if first.files == library {
        first
    } else {
        other = Library::new(library);
        &other
    };
    let SceneFiles { imports, scene, camera } = of_scene;
    let own = [scene.file].into_iter().chain(camera.map(|(file, _)| file));
    let files = imports.iter().map(|import| import.file).chain(own);
    let reached = library.reached(sources, files.map(|file| sources.text(file)));
    let look = library.look(sources);
    let again = uses.clone();
    // A question about a cursor needs no messages, and the text is seldom complete then.
    let needs_messages = uses.as_ref().is_none_or(|uses| uses.cursor.is_none());
    let checked = check_items(&reached, look, of_scene, uses);
    if needs_messages && has_errors(&checked.diagnostics) {
        return check_items(&library.whole(sources), look, of_scene, again);
    }
    checked
}

/// The library's items by name. An item is parsed when a scene first uses it.
#[derive(Debug)]
struct Library {
    files: Vec<FileId>,
    parts: Vec<Part>,
    by_name: FxHashMap<&'static str, Vec<usize>>,
    look: OnceLock<ast::File>,
}

/// The source of an item.
#[derive(Debug)]
struct Part {
    /// Index of its file.
    file: usize,
    /// The bytes of the item with its documentation, up to the next item.
    range: Range<usize>,
    read: OnceLock<Read>,
}

/// A parsed part.
#[derive(Debug)]
struct Read {
    /// Its item.
    items: Vec<Item>,
    /// Indices of the parts whose names occur in it.
    mentions: Vec<usize>,
}

impl Library {
    fn new(files: &[FileId]) -> Self {
        let (parts, by_name, look) = Default::default();
        let mut library = Self { files: files.to_vec(), parts, by_name, look };
        for (file, (_, text)) in library::FILES.iter().enumerate() {
            for (name, range) in items_of(text) {
                library.by_name.entry(name).or_default().push(library.parts.len());
                library.parts.push(Part { file, range, read: OnceLock::new() });
            }
        }
        library
    }

    fn read(&self, sources: &Sources, part: usize) -> &Read {
        let Part { file, range, read } = &self.parts[part];
        read.get_or_init(|| {
            let file = self.files[*file];
            let lines = sources.text(file)[range.clone()].lines();
            let code = lines.map(|line| line.split("//").next().unwrap_or(line));
            let mentions = code.flat_map(words).flat_map(|word| self.named(word)).collect();
            let (tree, _) = sdfc_syntax::parse_part(sources, file, range.clone());
            Read { items: tree.items, mentions }
        })
    }

    /// The default look, whose file is the last one.
    fn look(&self, sources: &Sources) -> Option<&ast::File> {
        let file = *self.files.last()?;
        Some(self.look.get_or_init(|| sdfc_syntax::parse(sources, file).0))
    }

    fn named(&self, word: &str) -> impl Iterator<Item = usize> {
        self.by_name.get(word).into_iter().flatten().copied()
    }

    /// The items of each file that these sources can use.
    fn reached<'a>(
        &self,
        sources: &Sources,
        texts: impl Iterator<Item = &'a str>,
    ) -> Vec<(FileId, Vec<&Item>)> {
        let mut reached = vec![false; self.parts.len()];
        let words = texts.flat_map(words).chain(OPERATORS);
        let mut waiting: Vec<usize> = words.flat_map(|word| self.named(word)).collect();
        while let Some(part) = waiting.pop() {
            if !std::mem::replace(&mut reached[part], true) {
                waiting.extend(&self.read(sources, part).mentions);
            }
        }
        self.items(sources, |part| reached[part])
    }

    /// All items of each file.
    fn whole(&self, sources: &Sources) -> Vec<(FileId, Vec<&Item>)> {
        self.items(sources, |_| true)
    }

    fn items(
        &self,
        sources: &Sources,
        wanted: impl Fn(usize) -> bool,
    ) -> Vec<(FileId, Vec<&Item>)> {
        let mut files: Vec<_> = self.files.iter().map(|file| (*file, Vec::new())).collect();
        for part in (0..self.parts.len()).filter(|part| wanted(*part)) {
            files[self.parts[part].file].1.extend(&self.read(sources, part).items);
        }
        files
    }
}

/// Name and byte range of each item of a formatted file. An item begins with a letter in the first
/// column, or with comments on the lines above.
fn items_of(text: &str) -> Vec<(&str, Range<usize>)> {
    let mut parts: Vec<(&str, Range<usize>)> = Vec::new();
    let (mut at, mut documentation) = (0, None);
    for line in text.split_inclusive('\n') {
        if line.starts_with("//") {
            documentation.get_or_insert(at);
        } else {
            let start = documentation.take().unwrap_or(at);
            if line.starts_with(|c: char| c.is_ascii_lowercase()) {
                if let Some((_, last)) = parts.last_mut() {
                    last.end = start;
                }
                parts.push((words(line).nth(1).unwrap_or(""), start..text.len()));
            }
        }
        at += line.len();
    }
    parts
}

/// All words in a source: names, keywords and numbers.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).filter(|word| !word.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_library() -> (Sources, Library) {
        let mut sources = Sources::new();
        let library = Library::new(&library::add_to(&mut sources));
        (sources, library)
    }

    #[test]
    fn the_parts_cover_the_whole_library() {
        let (sources, library) = with_library();
        for (file, items) in library.whole(&sources) {
            let (whole, found) = sdfc_syntax::parse(&sources, file);
            assert!(found.is_empty(), "{found:?}");
            if library.files.last() == Some(&file) {
                assert!(items.is_empty(), "the look declares nothing");
                continue;
            }
            assert_eq!(items, whole.items.iter().collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_items_reached_from_a_name_are_enough_to_check_it() {
        let (sources, library) = with_library();
        for name in library.by_name.keys() {
            let reached = library.reached(&sources, [*name].into_iter());
            let (_, found) = crate::check::check_library_items(&reached);
            assert!(!has_errors(&found), "{name}: {found:?}");
        }
    }

    #[test]
    fn items_that_no_name_leads_to_are_not_parsed() {
        let (sources, library) = with_library();
        let count = |files: Vec<(FileId, Vec<&Item>)>| {
            files.iter().map(|(_, items)| items.len()).sum::<usize>()
        };
        let reached = count(library.reached(&sources, ["sphere(1)"].into_iter()));
        let unread = library.parts.iter().filter(|part| part.read.get().is_none()).count();
        assert_eq!(reached + unread, library.parts.len());
        assert!(unread > reached, "{unread} of {}", library.parts.len());
    }
}
