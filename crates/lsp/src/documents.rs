//! Open files, and the files on disk.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use sdfc_ide::{Analysis, ExampleScene, MAX_FILES, Resolver, ShapeFacts, imports, library_files};
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

    /// Where a file is that scenes in a folder import by a path: in that folder or elsewhere.
    fn file(&self, folder: &Path, path: &str) -> PathBuf {
        folder.join(path)
    }

    /// Returns the scenes in a folder and below it. There may be more than those.
    fn scenes(&self, folder: &Path) -> Vec<PathBuf>;

    /// Returns the scenes in a folder, without those in folders below it.
    fn scenes_in(&self, folder: &Path) -> Vec<PathBuf>;

    /// Returns a folder that has the library's files, `std/solids.sdf` and so on.
    fn library(&self) -> Option<PathBuf>;
}

/// A compiled scene.
pub trait Compiled {
    /// Returns the facts about the shapes that a call made. The range is that of the call.
    fn facts(&self, call: Range<usize>) -> Option<ShapeFacts>;

    /// Returns the calls that make uncertified shapes, with the reasons.
    fn uncertified(&self) -> Vec<(Range<usize>, String)>;
}

/// The compiler.
pub trait Compile {
    /// Compiles a scene; `None` if it has errors.
    fn compile(&self, name: &str, text: &str, resolver: &dyn Resolver)
    -> Option<Box<dyn Compiled>>;

    /// Draws a small picture of a scene, as a PNG file; `None` if it cannot be drawn.
    fn picture(&self, name: &str, text: &str) -> Option<Vec<u8>>;
}

/// The open files, their analyses, and the scenes that were compiled for facts about shapes.
pub struct Documents<'d> {
    open: BTreeMap<PathBuf, String>,
    analyses: BTreeMap<PathBuf, Rc<Analysis>>,
    compiled: BTreeMap<PathBuf, Option<Box<dyn Compiled>>>,
    /// Pictures of the library's examples.
    pictures: BTreeMap<ExampleScene, Option<Vec<u8>>>,
    /// The folders of the scenes that import a file, as far as they were looked for.
    importers: RefCell<BTreeMap<PathBuf, Option<PathBuf>>>,
    /// The folders that the editor has open.
    folders: Vec<PathBuf>,
    disk: &'d dyn Disk,
    compiler: &'d dyn Compile,
}

/// The most folders above a file that are searched for scenes which import it.
const MAX_LEVELS: usize = 4;

/// Resolves the imports of one scene: open files first.
struct Beside<'d> {
    folder: PathBuf,
    /// The path of the scene below the folder.
    scene: String,
    open: &'d BTreeMap<PathBuf, String>,
    disk: &'d dyn Disk,
}

impl Resolver for Beside<'_> {
    fn read(&self, path: &str) -> Result<String, String> {
        let path = self.disk.file(&self.folder, path);
        self.open.get(&path).map_or_else(|| self.disk.read(&path), |text| Ok(text.clone()))
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        self.disk.read_bytes(&self.disk.file(&self.folder, path))
    }

    fn name_of(&self, path: &str) -> Option<String> {
        let file = self.disk.file(&self.folder, path);
        (file != self.folder.join(path)).then(|| file.display().to_string())
    }

    fn scene_path(&self) -> &str {
        &self.scene
    }
}

/// The resolver for the imports of a scene in a folder or below it.
pub fn resolver<'a>(
    folder: &Path,
    scene: &Path,
    open: &'a BTreeMap<PathBuf, String>,
    disk: &'a dyn Disk,
) -> impl Resolver + use<'a> {
    Beside { folder: folder.to_owned(), scene: path_below(folder, scene), open, disk }
}

/// The path of a file below a folder, with `/` between its parts.
fn path_below(folder: &Path, file: &Path) -> String {
    let below = file.strip_prefix(folder).unwrap_or(file);
    let parts: Vec<_> = below.iter().map(std::ffi::OsStr::to_string_lossy).collect();
    parts.join("/")
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).to_owned()
}

impl<'d> Documents<'d> {
    /// No open files.
    pub fn new(folders: Vec<PathBuf>, disk: &'d dyn Disk, compiler: &'d dyn Compile) -> Self {
        let (open, analyses, compiled, pictures, importers) = Default::default();
        Self { open, analyses, compiled, pictures, importers, folders, disk, compiler }
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
        // Which scenes import a file does not depend on its own text.
        self.importers.get_mut().retain(|of, _| of == path);
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
        self.importers.get_mut().clear();
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

    /// The facts about the shapes that a call of a scene made.
    pub fn facts(&mut self, scene: &Analysis, call: Range<usize>) -> Option<ShapeFacts> {
        self.compiled(scene)?.facts(call)
    }

    /// The calls of a scene that make uncertified shapes, with the reasons.
    pub fn uncertified(&mut self, scene: &Analysis) -> Vec<(Range<usize>, String)> {
        self.compiled(scene).map(|compiled| compiled.uncertified()).unwrap_or_default()
    }

    /// The picture of an example as a PNG file, drawn when it is first asked for.
    pub fn picture(&mut self, example: ExampleScene) -> Option<&[u8]> {
        let compiler = self.compiler;
        let picture = self.pictures.entry(example);
        picture.or_insert_with_key(|it| compiler.picture(&it.name, &it.source)).as_deref()
    }

    /// A scene, compiled when it is first asked for; `None` if it has errors.
    fn compiled(&mut self, scene: &Analysis) -> Option<&dyn Compiled> {
        let path = PathBuf::from(scene.name());
        if !self.compiled.contains_key(&path) {
            let compiler = self.compiler;
            let compile =
                |beside: &dyn Resolver| compiler.compile(scene.name(), scene.text(), beside);
            let compiled = self.with_resolver(&path, compile);
            self.compiled.insert(path.clone(), compiled);
        }
        self.compiled.get(&path)?.as_deref()
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
        run(&resolver(&self.root(path), path, &self.open, self.disk))
    }

    /// The folder that the imports of a file and its imports stay in: that of the nearest scene
    /// which imports the file, else its own.
    pub fn root(&self, path: &Path) -> PathBuf {
        self.importer(path).unwrap_or_else(|| folder_of(path))
    }

    /// True if another scene imports a file.
    pub fn is_imported(&self, path: &Path) -> bool {
        self.importer(path).is_some()
    }

    /// The folder of the nearest scene that imports a file: in its folder, or in one above it.
    fn importer(&self, path: &Path) -> Option<PathBuf> {
        let known = self.importers.borrow().get(path).cloned();
        known.unwrap_or_else(|| {
            let mut folders = path.ancestors().skip(1).take(1 + MAX_LEVELS);
            let has_importer = |folder: &&Path| {
                let open = self.open.keys().filter(|it| it.parent() == Some(folder)).cloned();
                let mut scenes = open.chain(self.disk.scenes_in(folder));
                scenes.any(|scene| scene != path && self.imports(folder, &scene, path))
            };
            let found = folders.find(has_importer).map(Path::to_owned);
            self.importers.borrow_mut().insert(path.to_owned(), found.clone());
            found
        })
    }

    /// True if a scene of a folder imports a file, directly or not.
    fn imports(&self, folder: &Path, scene: &Path, file: &Path) -> bool {
        let wanted = path_below(folder, file);
        let mut waiting = vec![path_below(folder, scene)];
        let mut seen = BTreeSet::new();
        while let Some(path) = waiting.pop() {
            if path == wanted {
                return true;
            }
            if seen.len() < MAX_FILES && seen.insert(path.clone()) {
                let text = self.text(&self.disk.file(folder, &path)).unwrap_or_default();
                waiting.extend(imports(&path, &text));
            }
        }
        false
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

    /// The paths that an import of a scene can name: files below its folder, and those above it up
    /// to the folder of a scene that imports it.
    pub fn importable(&self, path: &Path) -> Vec<String> {
        let (root, own) = (self.root(path), folder_of(path));
        let name = |it: &PathBuf| {
            let levels = own.ancestors().take_while(|folder| folder.starts_with(&root));
            let (up, folder) = levels.enumerate().find(|(_, folder)| it.starts_with(folder))?;
            Some((up, "../".repeat(up) + &path_below(folder, it)))
        };
        let scenes = self.disk.scenes(&root);
        let mut names: Vec<_> = scenes.iter().filter(|it| *it != path).filter_map(name).collect();
        names.sort();
        names.into_iter().map(|(_, name)| name).collect()
    }

    /// The path of a file of an analysis.
    pub fn path_of(&self, file: &str) -> PathBuf {
        let of_library = library_files().iter().any(|(name, _)| *name == file);
        let folder = self.disk.library().filter(|_| of_library);
        folder.map_or_else(|| PathBuf::from(file), |folder| folder.join(file))
    }
}
