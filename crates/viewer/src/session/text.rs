//! What the editor does with the text and asks about it: its errors, its words, and the code of a
//! shape.

use std::ops::Range;
use std::sync::Arc;

use super::Session;
use crate::compile::diagnostics::{ShownDiagnostic, ShownFix};
use crate::language::worker::LanguageRequest;
use crate::render::pixel_info::PixelInfo;
use crate::scene::document::with_replacements;
use crate::session::draft::Draft;

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
        let draft = self.draft.is_edited().then(|| Arc::clone(self.draft.text()));
        self.update_build(|build| build.draft = draft);
    }

    /// The range of the text that makes the shape at a position of the picture, given as in
    /// [`pixel_info`](Self::pixel_info). `None` if the text is not that of the picture.
    pub fn code_at(&self, position: [f64; 2]) -> Option<Range<usize>> {
        let picture = self.picture.as_deref()?;
        let (file, range) = PixelInfo::at(picture, position)?.call?;
        let own = self.path().file_name().unwrap_or_default().to_string_lossy();
        (file == own && picture.request.model.source == **self.text()).then_some(range)
    }

    /// Asks the language service about the text, unless it was asked the same last.
    pub fn ask_about_text(&mut self, cursor: Option<usize>) {
        let (path, text) = (self.path().to_owned(), Arc::clone(self.text()));
        let request = LanguageRequest { path, text, cursor };
        if self.language_request.as_ref() != Some(&request) {
            self.language_request = Some(request.clone());
            self.language_worker.send(request);
        }
    }

    /// The errors and warnings of the text as it is now; none while it is being compiled.
    pub fn diagnostics_of_text(&self) -> impl Iterator<Item = &ShownDiagnostic> {
        let is_current = self.diagnosed == *self.text();
        let own = self.path().file_name().unwrap_or_default().to_string_lossy();
        self.diagnostics.all.iter().filter(move |found| is_current && found.file == own)
    }

    /// Makes a change that one of the [diagnostics of the text](Self::diagnostics_of_text)
    /// proposes.
    pub fn apply_fix(&mut self, fix: &ShownFix) {
        let text = with_replacements(self.text(), &fix.edits);
        self.edit(|draft| draft.set_text(&text));
    }
}
