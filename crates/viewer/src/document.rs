//! The scene's text on disk, the files that it imports, and where to look for changes of either.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use sdfc::Resolver;
use sdfc::diagnostics::{FileId, Sources, Span};
use sdfc_files::{Folder, ReadError};

/// The scene's text, as it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Document {
    /// Where it lies.
    pub path: PathBuf,
    /// The name that messages show.
    pub name: String,
    /// The text.
    pub text: String,
}

impl Document {
    /// Reads it.
    ///
    /// # Errors
    ///
    /// As [`sdfc_files::read`].
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let input = sdfc_files::read(path)?;
        let name = path.file_name().map_or(input.name, |name| name.to_string_lossy().into_owned());
        Ok(Self { path: path.to_owned(), name, text: input.text })
    }
}

/// Hands in imported files, and notes which were asked for and what they held: those that are missing may come.
#[derive(Debug)]
pub struct Imports {
    folder: Folder,
    /// By path, and whether as bytes: a hash of what was given.
    asked: RefCell<BTreeMap<(String, bool), u64>>,
}

impl Imports {
    /// Of the scene at `path`.
    pub fn of(path: &Path) -> Self {
        Self { folder: Folder::of(path), asked: RefCell::default() }
    }

    /// Whether all that was asked for would be given again as it was.
    pub fn are_as_read(&self) -> bool {
        let same = |((path, bytes), before): (&(String, bool), &u64)| {
            let now = match bytes {
                true => hash(&self.folder.read_bytes(path)),
                false => hash(&self.folder.read(path)),
            };
            now == *before
        };
        self.asked.borrow().iter().all(same)
    }

    /// Folders in which a change can change the scene: its own, and those of the files that were asked for.
    pub fn folders(&self) -> BTreeSet<PathBuf> {
        let root = self.folder.path();
        let asked = self.asked.borrow();
        let parents = asked.keys().filter_map(|(path, _)| root.join(path).parent().map(existing));
        [existing(root)].into_iter().chain(parents).collect()
    }

    fn note<T: Hash>(&self, path: &str, bytes: bool, given: &T) {
        self.asked.borrow_mut().insert((path.to_owned(), bytes), hash(given));
    }
}

impl Resolver for Imports {
    fn read(&self, path: &str) -> Result<String, String> {
        let text = self.folder.read(path);
        self.note(path, false, &text);
        text
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        let bytes = self.folder.read_bytes(path);
        self.note(path, true, &bytes);
        bytes
    }
}

fn hash(what: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    what.hash(&mut hasher);
    hasher.finish()
}

/// The folder itself, or the nearest one above it that is there.
fn existing(folder: &Path) -> PathBuf {
    let found = folder.ancestors().find(|folder| folder.is_dir());
    found.filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned()
}

/// The path of a file by the name that a message gives it.
pub fn path_of(scene: &Path, name: &str) -> PathBuf {
    if scene.file_name().is_some_and(|own| own.to_string_lossy() == name) {
        return scene.to_owned();
    }
    Folder::of(scene).path().join(name)
}

/// The scene's text with other texts in the places of some spans, which do not overlap.
pub fn replaced(text: &str, edits: &[(Span, String)]) -> String {
    let mut edits: Vec<&(Span, String)> = edits.iter().collect();
    edits.sort_by_key(|(span, _)| span.start);
    let mut out = String::with_capacity(text.len());
    let mut from = 0;
    for (span, new) in edits {
        out.push_str(text.get(from..span.start as usize).unwrap_or_default());
        out.push_str(new);
        from = span.end as usize;
    }
    out.push_str(text.get(from..).unwrap_or_default());
    out
}

/// What stands in a line, without its end; lines count from 1.
pub fn line(sources: &Sources, file: FileId, line: u32) -> String {
    let range = sources.line_bytes(file, line.saturating_sub(1) as usize);
    let text = range.and_then(|range| sources.text(file).get(range)).unwrap_or_default();
    text.trim_end_matches(['\n', '\r']).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_missing_imports_are_watched_where_they_can_appear() {
        let root = tempfile::tempdir().unwrap();
        std::fs::create_dir(root.path().join("parts")).unwrap();
        let imports = Imports::of(&root.path().join("scene.sdf"));
        assert!(imports.read("parts/gear.sdf").is_err());
        assert!(imports.read("deep/er/wheel.sdf").is_err());
        let expected = [root.path().to_owned(), root.path().join("parts")];
        assert_eq!(imports.folders(), BTreeSet::from(expected));
    }

    #[test]
    fn spans_are_replaced_in_any_order() {
        let span = |start, end| Span::new(FileId(0), start, end);
        let edits = [(span(12, 15), "7".to_owned()), (span(4, 7), "0.25".to_owned())];
        assert_eq!(replaced("box(1.5) + (2.0)", &edits), "box(0.25) + (7)");
        assert_eq!(replaced("box", &[]), "box");
    }

    #[test]
    fn names_of_messages_become_paths() {
        let scene = Path::new("/a/b/scene.sdf");
        assert_eq!(path_of(scene, "scene.sdf"), scene);
        assert_eq!(path_of(scene, "parts/gear.sdf"), Path::new("/a/b/parts/gear.sdf"));
    }
}
