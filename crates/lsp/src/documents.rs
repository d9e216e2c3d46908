//! Open files, and the files on disk.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use sdfc_ide::{Analysis, Resolver, ShapeFacts, library_files};
use serde_json::Value;

use crate::lines::{Encoding, Lines};

/// Access to files that are not open in the editor, from any thread.
pub trait Disk: Sync {
    /// Reads a source file.
    ///
    /// # Errors
    ///
    /// Returns the reason in one line.
    fn read(&self, path: &Path) -> Result<String, String>;

    /// Reads a binary file, such as a font.
    ///
    /// # Errors
    ///
    /// Returns the reason in one line.
    fn read_bytes(&self, path: &Path) -> Result<Vec<u8>, String>;

    /// Returns the scenes in a folder and below it. There may be more than those.
    fn scenes(&self, folder: &Path) -> Vec<PathBuf>;

    /// Returns a folder that has the library's files, `std/solids.sdf` and so on.
    fn library(&self) -> Option<PathBuf>;
}

/// The facts about the shapes of a compiled scene, by the byte range of the call that made them.
pub type Compiled = Box<dyn Fn(Range<usize>) -> Option<ShapeFacts>>;

/// The compiler.
pub trait Compile {
    /// Compiles a scene; `None` if it has errors.
    fn compile(&self, name: &str, text: &str, resolver: &dyn Resolver) -> Option<Compiled>;
}

/// The open files, their analyses, and the scenes that were compiled for facts about shapes.
pub struct Documents<'d> {
    open: BTreeMap<PathBuf, String>,
    analyses: BTreeMap<PathBuf, Rc<Analysis>>,
    compiled: BTreeMap<PathBuf, Option<Compiled>>,
    /// The folders that the editor has open.
    folders: Vec<PathBuf>,
    disk: &'d dyn Disk,
    compiler: &'d dyn Compile,
}

/// Resolves the imports of one scene: open files first.
struct Beside<'d> {
    folder: PathBuf,
    open: &'d BTreeMap<PathBuf, String>,
    disk: &'d dyn Disk,
}

impl Resolver for Beside<'_> {
    fn read(&self, path: &str) -> Result<String, String> {
        let path = self.folder.join(path);
        self.open.get(&path).map_or_else(|| self.disk.read(&path), |text| Ok(text.clone()))
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        self.disk.read_bytes(&self.folder.join(path))
    }
}

/// The resolver for the imports of a scene.
pub fn resolver<'a>(
    scene: &Path,
    open: &'a BTreeMap<PathBuf, String>,
    disk: &'a dyn Disk,
) -> impl Resolver + use<'a> {
    Beside { folder: folder_of(scene), open, disk }
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).to_owned()
}

impl<'d> Documents<'d> {
    /// No open files.
    pub fn new(folders: Vec<PathBuf>, disk: &'d dyn Disk, compiler: &'d dyn Compile) -> Self {
        let (open, analyses, compiled) = Default::default();
        Self { open, analyses, compiled, folders, disk, compiler }
    }

    /// The paths of all open files.
    pub fn paths(&self) -> Vec<PathBuf> {
        self.open.keys().cloned().collect()
    }

    /// The texts of all open files.
    pub fn open(&self) -> &BTreeMap<PathBuf, String> {
        &self.open
    }

    /// True if a file is open.
    pub fn is_open(&self, path: &Path) -> bool {
        self.open.contains_key(path)
    }

    /// The text of a file, if it is open or can be read.
    pub fn text(&self, path: &Path) -> Option<String> {
        let open = self.open.get(path).cloned();
        open.or_else(|| {
            let folder = self.disk.library()?;
            let name = path.strip_prefix(folder).ok()?.to_str()?.replace('\\', "/");
            let mut files = library_files().iter();
            files.find(|(file, _)| *file == name).map(|(_, text)| (*text).to_owned())
        })
        .or_else(|| self.disk.read(path).ok())
    }

    /// Opens a file or replaces its text.
    pub fn set(&mut self, path: &Path, text: String) {
        self.open.insert(path.to_owned(), text);
        self.forget(path);
    }

    /// Closes a file.
    pub fn close(&mut self, path: &Path) {
        self.open.remove(path);
        self.forget(path);
    }

    /// Applies the changes of a notification.
    pub fn change(&mut self, path: &Path, changes: &Value, encoding: Encoding) {
        let mut text = self.open.get(path).cloned().unwrap_or_default();
        for change in changes.as_array().into_iter().flatten() {
            let new = change["text"].as_str().unwrap_or_default();
            if change["range"].is_object() {
                let range = Lines::new(&text, encoding).bytes(&change["range"]);
                text.replace_range(range, new);
            } else {
                text = new.to_owned();
            }
        }
        self.set(path, text);
    }

    /// Drops the analyses of a file and of the scenes that import it.
    pub fn forget(&mut self, path: &Path) {
        let name = path.display().to_string();
        self.analyses.retain(|of, analysis| {
            of != path && analysis.imported().all(|imported| imported != name)
        });
        let analyses = &self.analyses;
        self.compiled.retain(|of, _| analyses.contains_key(of));
    }

    /// Drops all analyses.
    pub fn forget_all(&mut self) {
        self.analyses.clear();
        self.compiled.clear();
    }

    /// The analysis of a file.
    pub fn analysis(&mut self, path: &Path) -> Option<Rc<Analysis>> {
        if let Some(known) = self.analyses.get(path) {
            return Some(known.clone());
        }
        let text = self.text(path)?;
        let name = path.display().to_string();
        let analysis = self.with_resolver(path, |beside| Analysis::new(&name, &text, beside));
        let analysis = Rc::new(analysis);
        self.analyses.insert(path.to_owned(), analysis.clone());
        Some(analysis)
    }

    /// The facts about the shapes that a call of a scene made. Compiles the scene when it is first
    /// asked.
    pub fn facts(&mut self, scene: &Analysis, call: Range<usize>) -> Option<ShapeFacts> {
        let path = PathBuf::from(scene.name());
        if !self.compiled.contains_key(&path) {
            let compiler = self.compiler;
            let compile =
                |beside: &dyn Resolver| compiler.compile(scene.name(), scene.text(), beside);
            let compiled = self.with_resolver(&path, compile);
            self.compiled.insert(path.clone(), compiled);
        }
        self.compiled.get(&path)?.as_ref()?(call)
    }

    /// The scenes of the folders that the editor has open, and the open files.
    pub fn workspace(&mut self) -> Vec<Rc<Analysis>> {
        let mut paths = self.paths();
        paths.extend(self.folders.iter().flat_map(|folder| self.disk.scenes(folder)));
        paths.sort();
        paths.dedup();
        paths.iter().filter_map(|path| self.analysis(path)).collect()
    }

    /// Runs a function with the resolver for the imports of a scene.
    pub fn with_resolver<T>(&self, path: &Path, run: impl FnOnce(&dyn Resolver) -> T) -> T {
        run(&resolver(path, &self.open, self.disk))
    }

    /// The other scenes that may import a file: open ones, and those in its folder and below.
    pub fn others(&mut self, path: &Path) -> Vec<Rc<Analysis>> {
        let mut paths = self.paths();
        paths.extend(self.disk.scenes(&folder_of(path)));
        paths.sort();
        paths.dedup();
        paths.retain(|other| other != path);
        paths.iter().filter_map(|path| self.analysis(path)).collect()
    }

    /// The paths that an import of a scene can name.
    pub fn importable(&self, path: &Path) -> Vec<String> {
        let folder = folder_of(path);
        let mut names: Vec<String> = self
            .disk
            .scenes(&folder)
            .iter()
            .filter(|it| *it != path)
            .filter_map(|it| Some(it.strip_prefix(&folder).ok()?.display().to_string()))
            .map(|name| name.replace('\\', "/"))
            .collect();
        names.sort();
        names
    }

    /// The path of a file of an analysis.
    pub fn path_of(&self, file: &str) -> PathBuf {
        let of_library = library_files().iter().any(|(name, _)| *name == file);
        let folder = self.disk.library().filter(|_| of_library);
        folder.map_or_else(|| PathBuf::from(file), |folder| folder.join(file))
    }
}
