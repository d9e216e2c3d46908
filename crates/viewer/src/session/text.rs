//! What the editor does with the text and asks about it: its errors, its words, and the code of a
//! shape.

use std::ops::Range;
use std::sync::Arc;

use sdfc_ide::Location;

use super::Session;
use crate::compile::diagnostics::{ShownDiagnostic, ShownFix};
use crate::language::worker::{LanguageAnswer, LanguageRequest};
use crate::render::pixel_info::PixelInfo;
use crate::scene::document::with_replacements;
use crate::scene::model::Model;
use crate::session::draft::Draft;
use crate::session::tabs::TabFile;

impl Session {
    /// The text of the scene and of its file.
    pub fn draft(&self) -> &Draft {
        &self.draft
    }

    /// The text of the scene: that of the file, or one that was edited in the window.
    pub fn text(&self) -> &Arc<str> {
        self.draft.text()
    }

    /// Changes the text of the scene, in the window or in the file, and compiles it.
    pub fn edit(&mut self, change: impl FnOnce(&mut Draft)) {
        change(&mut self.draft);
        self.compile_texts();
    }

    /// Compiles the texts as they are now, unless they were compiled last.
    pub(super) fn compile_texts(&mut self) {
        let draft = self.draft.is_edited().then(|| Arc::clone(self.draft.text()));
        let imports = self.tabs.edited();
        self.update_build(|build| (build.draft, build.imports) = (draft, imports));
    }

    /// The file and the range of its text that make the shape at a position of the picture, given
    /// as in [`pixel_info`](Self::pixel_info). `None` if the text is not that of the picture.
    pub fn code_at(&self, position: [f64; 2]) -> Option<(TabFile, Range<usize>)> {
        let picture = self.known_picture()?;
        let (name, range) = PixelInfo::at(picture, position)?.call?;
        let file = self.file_named(&name);
        let compiled = self.compiled_text(&picture.request.model, &file)?;
        (*compiled == **self.text_of(&file)?).then_some((file, range))
    }

    /// The text of a file that was compiled to a model; `None` for a file of the library.
    pub(super) fn compiled_text<'m>(&self, model: &'m Model, file: &TabFile) -> Option<&'m str> {
        match file {
            TabFile::Scene => Some(&model.source),
            TabFile::Import(path) => model.import_text(path),
            TabFile::Library(_) => None,
        }
    }

    /// Asks the language service about the shown text, unless it was asked the same last.
    pub fn ask_about_text(&mut self, cursor: Option<usize>) {
        let file = self.shown_file().name(self.path());
        let request = LanguageRequest {
            path: self.path().to_owned(),
            file,
            text: Arc::clone(self.shown_text()),
            drafts: self.tabs.edited(),
            imports: self.diagnosed_imports.clone(),
            cursor,
        };
        if self.language_request.as_ref() != Some(&request) {
            self.language_request = Some(request.clone());
            self.language_worker.send(request);
        }
    }

    /// The answer of the language service about the shown text; `None` until it is there.
    pub fn answer_about_text(&self) -> Option<&LanguageAnswer> {
        let answer = self.language.as_ref()?;
        let file = self.shown_file().name(self.path());
        let LanguageRequest { path, file: about, text, .. } = &answer.request;
        let is_current = path == self.path() && *about == file && text == self.shown_text();
        is_current.then_some(answer)
    }

    /// The errors and warnings of the shown text; none while it is being compiled.
    pub fn diagnostics_of_text(&self) -> impl Iterator<Item = &ShownDiagnostic> {
        let (file, name) = (self.shown_file(), self.shown_file().name(self.path()));
        let is_current = self.is_diagnosed(file);
        self.diagnostics.all.iter().filter(move |found| is_current && found.file == name)
    }

    /// Returns true if the diagnostics are about the text of a file as it is now.
    pub fn has_diagnosed_text(&self, name: &str) -> bool {
        self.is_diagnosed(&self.file_named(name))
    }

    fn file_named(&self, name: &str) -> TabFile {
        let location = Location { file: name.to_owned(), start: 0, end: 0 };
        TabFile::of(&location, self.path())
    }

    fn is_diagnosed(&self, file: &TabFile) -> bool {
        let compiled = match file {
            TabFile::Scene => Some(&self.diagnosed),
            TabFile::Import(path) => self.diagnosed_imports.get(path),
            TabFile::Library(_) => None,
        };
        compiled.is_some() && compiled == self.text_of(file)
    }

    /// Makes a change of a file that one of the diagnostics proposes, and shows the file. Returns
    /// the texts before and after; `None` if the file has another text than the diagnosed one.
    pub fn apply_fix(&mut self, name: &str, fix: &ShownFix) -> Option<[Arc<str>; 2]> {
        let file = self.file_named(name);
        let before = Arc::clone(self.text_of(&file).filter(|_| self.is_diagnosed(&file))?);
        let after = with_replacements(&before, &fix.edits);
        self.edit_file(&file, |draft| draft.set_text(&after));
        self.show_file(file);
        Some([before, after.into()])
    }
}
