//! The text in the panel "Code": that of the shown file.

use std::sync::Arc;

use super::Session;
use crate::session::draft::Draft;
use crate::session::save_state::Saved;
use crate::session::tabs::TabFile;
use crate::unsaved_texts::{UnsavedScene, UnsavedText};

impl Session {
    /// The files that the panel "Code" can show.
    pub fn tabs(&self) -> Vec<TabFile> {
        self.tabs.list()
    }

    /// The file that the panel "Code" shows.
    pub fn shown_file(&self) -> &TabFile {
        self.tabs.shown()
    }

    /// Shows a file in the panel "Code".
    pub fn show_file(&mut self, file: TabFile) {
        self.tabs.show(file);
    }

    /// Closes the file of the library.
    pub fn close_library_file(&mut self) {
        self.tabs.close_library();
    }

    /// The text of a file; `None` if it is not there.
    pub fn text_of(&self, file: &TabFile) -> Option<&Arc<str>> {
        match file {
            TabFile::Library(_) => self.tabs.library_text(),
            TabFile::Scene | TabFile::Import(_) => self.draft_of(file).map(Draft::text),
        }
    }

    /// The text of a file and that on disk; `None` for a file of the library.
    pub fn draft_of(&self, file: &TabFile) -> Option<&Draft> {
        match file {
            TabFile::Scene => Some(&self.draft),
            TabFile::Import(path) => self.tabs.draft(path),
            TabFile::Library(_) => None,
        }
    }

    /// The text of the shown file.
    pub fn shown_text(&self) -> &Arc<str> {
        self.text_of(self.shown_file()).unwrap_or(self.text())
    }

    /// The text of the shown file and that on disk; `None` for a file of the library.
    pub fn shown_draft(&self) -> Option<&Draft> {
        self.draft_of(self.shown_file())
    }

    /// Changes the text of a file, and compiles the scene. A file of the library stays as it is.
    pub fn edit_file(&mut self, file: &TabFile, change: impl FnOnce(&mut Draft)) {
        match file {
            TabFile::Scene => self.edit(change),
            TabFile::Import(path) => {
                self.tabs.edit(path, change);
                self.compile_texts();
            }
            TabFile::Library(_) => {}
        }
    }

    /// Changes the text of the shown file.
    pub fn edit_shown(&mut self, change: impl FnOnce(&mut Draft)) {
        let file = self.shown_file().clone();
        self.edit_file(&file, change);
    }

    /// Writes the text of the shown file; for the scene, `what` is written.
    pub fn save_shown(&mut self, what: Saved) {
        self.saving.failure = None;
        match self.shown_file().clone() {
            TabFile::Scene => self.save_scene(what),
            TabFile::Import(path) => self.save_import(&path),
            TabFile::Library(_) => {
                self.messages.push("a file of the library cannot be changed".to_owned());
            }
        }
    }

    /// Writes all edited files, and the changed numbers of the scene.
    pub fn save_all(&mut self) {
        self.saving.failure = None;
        let imports: Vec<String> = self.tabs.edited().into_keys().collect();
        imports.iter().for_each(|path| self.save_import(path));
        if self.draft.is_edited() || self.param_values.changed_numbers() > 0 {
            self.save_scene(Saved::Numbers);
        }
    }

    /// The texts that are not saved, with the changed numbers in that of the scene.
    pub fn unsaved_texts(&self) -> UnsavedScene {
        let unsaved =
            |draft: &Draft, text: String| UnsavedText { text, base: draft.base().to_string() };
        let is_changed = self.draft.is_edited() || self.param_values.changed_numbers() > 0;
        let scene = is_changed.then(|| unsaved(&self.draft, self.current_text()));
        let import = |(path, text): (String, Arc<str>)| {
            let draft = self.tabs.draft(&path)?;
            let unsaved = unsaved(draft, text.to_string());
            Some((path, unsaved))
        };
        let imports = self.tabs.edited().into_iter().filter_map(import).collect();
        UnsavedScene { path: String::new(), scene, imports }
    }

    /// Restores texts that were not saved, as edited texts.
    pub fn restore_texts(&mut self, unsaved: &UnsavedScene) {
        if let Some(UnsavedText { text, base }) = &unsaved.scene {
            self.draft.restore(text, base);
        }
        for (path, UnsavedText { text, base }) in &unsaved.imports {
            self.tabs.restore(path, text, base);
        }
        if !unsaved.is_empty() {
            self.compile_texts();
            let text = "the text that was not saved when the window was lost is back";
            self.messages.push(text.to_owned());
        }
    }

    /// Returns true if the text of an imported file is not saved.
    pub fn has_edited_imports(&self) -> bool {
        !self.tabs.edited().is_empty()
    }

    /// The names of the files whose text is not saved.
    pub fn edited_files(&self) -> Vec<String> {
        let is_edited = |file: &TabFile| self.draft_of(file).is_some_and(Draft::is_edited);
        let edited = self.tabs().into_iter().filter(is_edited);
        edited.map(|file| file.name(self.path())).collect()
    }
}
