//! The files that the panel "Code" shows: the scene, the files that it imports, and one file of the
//! library, which cannot be edited.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use sdfc_ide::{Location, library_files};

use crate::scene::document::TextsByPath;
use crate::session::draft::Draft;

/// A file that the panel "Code" can show.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub enum TabFile {
    /// The scene.
    #[default]
    Scene,
    /// A file that the scene imports, directly or not, by its path beside the scene.
    Import(String),
    /// A file of the library, by its name.
    Library(&'static str),
}

impl TabFile {
    /// The name that diagnostics and the language service give the file.
    pub fn name(&self, scene: &Path) -> String {
        match self {
            Self::Scene => scene.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            Self::Import(path) => path.clone(),
            Self::Library(name) => (*name).to_owned(),
        }
    }

    /// The file of a location.
    pub fn of(location: &Location, scene: &Path) -> Self {
        if location.file == Self::Scene.name(scene) {
            return Self::Scene;
        }
        let mut library = library_files().iter();
        match library.find(|(name, _)| *name == location.file) {
            Some((name, _)) => Self::Library(name),
            None => Self::Import(location.file.clone()),
        }
    }
}

/// The imported files and the file of the library.
#[derive(Debug, Default)]
pub struct Tabs {
    imports: BTreeMap<String, Draft>,
    library: Option<(&'static str, Arc<str>)>,
    shown: TabFile,
}

impl Tabs {
    /// All tabs, in the order in which they are shown.
    pub fn list(&self) -> Vec<TabFile> {
        let imports = self.imports.keys().cloned().map(TabFile::Import);
        let library = self.library.iter().map(|(name, _)| TabFile::Library(name));
        [TabFile::Scene].into_iter().chain(imports).chain(library).collect()
    }

    /// The shown tab.
    pub fn shown(&self) -> &TabFile {
        let is_there = match &self.shown {
            TabFile::Scene => true,
            TabFile::Import(path) => self.imports.contains_key(path),
            TabFile::Library(name) => self.library.as_ref().is_some_and(|(it, _)| it == name),
        };
        if is_there { &self.shown } else { &TabFile::Scene }
    }

    /// Shows a file. One that is not there is not shown.
    pub fn show(&mut self, file: TabFile) {
        if let TabFile::Library(name) = file {
            let text = library_files().iter().find(|(it, _)| *it == name);
            self.library = text.map(|(name, text)| (*name, Arc::from(*text)));
        }
        self.shown = file;
    }

    /// Closes the file of the library.
    pub fn close_library(&mut self) {
        self.library = None;
    }

    /// The text of the library's file.
    pub fn library_text(&self) -> Option<&Arc<str>> {
        self.library.as_ref().map(|(_, text)| text)
    }

    /// The text of an imported file.
    pub fn draft(&self, path: &str) -> Option<&Draft> {
        self.imports.get(path)
    }

    /// Changes the text of an imported file.
    pub fn edit(&mut self, path: &str, change: impl FnOnce(&mut Draft)) {
        if let Some(draft) = self.imports.get_mut(path) {
            change(draft);
        }
    }

    /// The texts of the imported files that were edited.
    pub fn edited(&self) -> TextsByPath {
        let edited = self.imports.iter().filter(|(_, draft)| draft.is_edited());
        edited.map(|(path, draft)| (path.clone(), Arc::clone(draft.text()))).collect()
    }

    /// Records the texts of imported files as they were read after a moment.
    pub fn set_read(&mut self, files: BTreeMap<String, Option<Arc<str>>>, after: Instant) {
        for (path, file) in files {
            let draft = self.imports.entry(path).or_default();
            if let Some(file) = file {
                draft.set_read(file, after);
            }
        }
    }

    /// Forgets imported files that the scene no longer has, unless they are shown or edited.
    pub fn keep_imports(&mut self, imported: &TextsByPath) {
        let shown = self.shown.clone();
        self.imports.retain(|path, draft| {
            let is_shown = matches!(&shown, TabFile::Import(it) if it == path);
            imported.contains_key(path) || is_shown || draft.is_edited()
        });
    }

    /// Restores the edited text of an imported file, and the text of the file that it replaces.
    pub fn restore(&mut self, path: &str, text: &str, base: &str) {
        self.imports.entry(path.to_owned()).or_default().restore(text, base);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edited_and_shown_imports_stay_when_the_scene_does_not_import_them() {
        let mut tabs = Tabs::default();
        let files = ["a.sdf", "b.sdf", "c.sdf"].map(|it| (it.to_owned(), Some("solid".into())));
        tabs.set_read(files.into(), Instant::now());
        tabs.edit("a.sdf", |draft| draft.set_text("region"));
        tabs.show(TabFile::Import("b.sdf".to_owned()));
        tabs.keep_imports(&TextsByPath::new());
        let import = |path: &str| TabFile::Import(path.to_owned());
        assert_eq!(tabs.list(), [TabFile::Scene, import("a.sdf"), import("b.sdf")]);
        assert_eq!(tabs.edited(), [("a.sdf".to_owned(), Arc::from("region"))].into());
        tabs.show(TabFile::Scene);
        tabs.keep_imports(&TextsByPath::new());
        assert_eq!(tabs.list(), [TabFile::Scene, import("a.sdf")]);
        // A file that is not there is not shown.
        tabs.show(import("gone.sdf"));
        assert_eq!(*tabs.shown(), TabFile::Scene);
    }

    #[test]
    fn a_location_in_the_library_opens_its_file() {
        let scene = Path::new("/folder/scene.sdf");
        let of =
            |file: &str| TabFile::of(&Location { file: file.to_owned(), start: 0, end: 0 }, scene);
        assert_eq!(of("scene.sdf"), TabFile::Scene);
        assert_eq!(of("parts/gear.sdf"), TabFile::Import("parts/gear.sdf".to_owned()));
        assert_eq!(of("std/solids.sdf"), TabFile::Library("std/solids.sdf"));
        let mut tabs = Tabs::default();
        tabs.show(of("std/solids.sdf"));
        assert!(tabs.library_text().is_some_and(|text| text.contains("solid sphere")));
        tabs.close_library();
        assert_eq!(*tabs.shown(), TabFile::Scene);
    }
}
