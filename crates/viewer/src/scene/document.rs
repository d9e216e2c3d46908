//! The scene's source file, the files that it imports, and the folders to watch for changes.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sdfc::Resolver;
use sdfc_diagnostics::{FileId, Sources, Span};
use sdfc_files::{Folder, ReadError};

/// The scene's source as it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Document {
    /// The file.
    pub path: PathBuf,
    /// The name that diagnostics show.
    pub name: String,
    /// The source.
    pub source: String,
}

impl Document {
    /// Reads a scene's file.
    ///
    /// # Errors
    ///
    /// Those of [`sdfc_files::read`].
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        Ok(Self::draft(path, &sdfc_files::read(path)?.text))
    }

    /// The scene's file with another text.
    pub fn draft(path: &Path, text: &str) -> Self {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        Self { path: path.to_owned(), name, source: text.to_owned() }
    }
}

/// Texts by the path of their file, relative to the folder of the scene.
pub type TextsByPath = BTreeMap<String, Arc<str>>;

/// The folder of a scene, with edited texts in place of some of its files.
#[derive(Clone, Debug)]
pub struct EditedFolder {
    folder: Folder,
    drafts: TextsByPath,
}

impl EditedFolder {
    /// The folder of the scene at `path`.
    pub fn new(path: &Path, drafts: TextsByPath) -> Self {
        Self { folder: Folder::of(path), drafts }
    }

    /// The edited texts.
    pub fn drafts(&self) -> &TextsByPath {
        &self.drafts
    }

    /// The text of a file as it is on disk; `None` if it cannot be read.
    pub fn text_on_disk(&self, path: &str) -> Option<Arc<str>> {
        self.folder.read(path).ok().map(Arc::from)
    }
}

impl Resolver for EditedFolder {
    fn read(&self, path: &str) -> Result<String, String> {
        match self.drafts.get(path) {
            Some(draft) => Ok(draft.to_string()),
            None => self.folder.read(path),
        }
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        self.folder.read_bytes(path)
    }
}

/// Reads imported files for the compiler, and records which ones were read and a hash of each.
/// Missing files are recorded too, since they may be created later.
#[derive(Debug)]
pub struct Imports {
    folder: EditedFolder,
    /// Key: path, and true if read as bytes. Value: a hash of the result.
    reads: RefCell<BTreeMap<(String, bool), u64>>,
    texts: RefCell<TextsByPath>,
}

impl Imports {
    /// The imports of a scene; none has been read yet.
    pub fn new(folder: EditedFolder) -> Self {
        Self { folder, reads: RefCell::default(), texts: RefCell::default() }
    }

    /// The texts that were read.
    pub fn texts(&self) -> TextsByPath {
        self.texts.borrow().clone()
    }

    /// The texts that were read, as they are on disk.
    pub fn files(&self) -> BTreeMap<String, Option<Arc<str>>> {
        let on_disk = |(path, text): (String, Arc<str>)| match self.folder.drafts.get(&path) {
            Some(_) => (path.clone(), self.folder.text_on_disk(&path)),
            None => (path, Some(text)),
        };
        self.texts().into_iter().map(on_disk).collect()
    }

    /// Returns true if reading every recorded file again would give the same result.
    pub fn are_unchanged(&self) -> bool {
        let same = |((path, bytes), before): (&(String, bool), &u64)| {
            let now = match bytes {
                true => hash(&self.folder.read_bytes(path)),
                false => hash(&self.folder.read(path)),
            };
            now == *before
        };
        self.reads.borrow().iter().all(same)
    }

    /// The folders in which a change can change the scene: its own and those of its imports.
    pub fn folders(&self) -> BTreeSet<PathBuf> {
        let folder = &self.folder.folder;
        let reads = self.reads.borrow();
        let parents = reads.keys().filter_map(|(path, _)| folder.file(path).parent().map(existing));
        [existing(folder.path())].into_iter().chain(parents).collect()
    }

    fn record<T: Hash>(&self, path: &str, bytes: bool, result: &T) {
        self.reads.borrow_mut().insert((path.to_owned(), bytes), hash(result));
    }
}

impl Resolver for Imports {
    fn read(&self, path: &str) -> Result<String, String> {
        let text = self.folder.read(path);
        self.record(path, false, &text);
        if let Ok(text) = &text {
            self.texts.borrow_mut().insert(path.to_owned(), text.as_str().into());
        }
        text
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        let bytes = self.folder.read_bytes(path);
        self.record(path, true, &bytes);
        bytes
    }
}

fn hash(value: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

/// The folder to watch for a scene whose imports are not known.
pub fn folders_of(path: &Path) -> BTreeSet<PathBuf> {
    [existing(Folder::of(path).path())].into()
}

/// The folder itself, or its nearest ancestor that exists.
fn existing(folder: &Path) -> PathBuf {
    let found = folder.ancestors().find(|folder| folder.is_dir());
    found.filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned()
}

/// The path of a file by the name that a diagnostic gives it.
pub fn path_of(scene: &Path, name: &str) -> PathBuf {
    if scene.file_name().is_some_and(|own| own.to_string_lossy() == name) {
        return scene.to_owned();
    }
    Folder::of(scene).file(name)
}

/// The source with some spans replaced. The spans must not overlap.
pub fn with_replacements(source: &str, edits: &[(Span, String)]) -> String {
    let mut edits: Vec<&(Span, String)> = edits.iter().collect();
    edits.sort_by_key(|(span, _)| span.start);
    let mut out = String::with_capacity(source.len());
    let mut from = 0;
    for (span, new) in edits {
        out.push_str(source.get(from..span.start as usize).unwrap_or_default());
        out.push_str(new);
        from = span.end as usize;
    }
    out.push_str(source.get(from..).unwrap_or_default());
    out
}

/// A line without its line ending; lines count from 1.
pub fn source_line(sources: &Sources, file: FileId, line: u32) -> String {
    let range = sources.line_bytes(file, line.saturating_sub(1) as usize);
    let text = range.and_then(|range| sources.text(file).get(range)).unwrap_or_default();
    text.trim_end_matches(['\n', '\r']).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_existing_folder_of_a_missing_import_is_watched() {
        let root = tempfile::tempdir().unwrap();
        std::fs::create_dir(root.path().join("parts")).unwrap();
        let imports =
            Imports::new(EditedFolder::new(&root.path().join("scene.sdf"), TextsByPath::new()));
        assert!(imports.read("parts/gear.sdf").is_err());
        assert!(imports.read("deep/er/wheel.sdf").is_err());
        let expected = [root.path().to_owned(), root.path().join("parts")];
        assert_eq!(imports.folders(), BTreeSet::from(expected));
    }

    #[test]
    fn replacements_may_come_in_any_order() {
        let span = |start, end| Span::new(FileId(0), start, end);
        let edits = [(span(12, 15), "7".to_owned()), (span(4, 7), "0.25".to_owned())];
        assert_eq!(with_replacements("box(1.5) + (2.0)", &edits), "box(0.25) + (7)");
        assert_eq!(with_replacements("box", &[]), "box");
    }

    #[test]
    fn names_in_diagnostics_become_paths() {
        let scene = Path::new("/a/b/scene.sdf");
        assert_eq!(path_of(scene, "scene.sdf"), scene);
        assert_eq!(path_of(scene, "parts/gear.sdf"), Path::new("/a/b/parts/gear.sdf"));
    }
}
