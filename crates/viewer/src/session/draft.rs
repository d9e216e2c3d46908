//! The text of the scene, which may be edited in the window before it is saved.

use std::sync::Arc;
use std::time::Instant;

/// A text that was written to its file.
#[derive(Clone, Debug)]
pub struct SavedText {
    /// The text that the file had.
    pub before: Arc<str>,
    /// The text in the window.
    pub text: Arc<str>,
    /// The text that the file got.
    pub after: Arc<str>,
    /// When the file had been written.
    pub ended: Instant,
}

/// The text of a scene and of its file.
#[derive(Clone, Debug, Default)]
pub struct Draft {
    /// The text of the file when it was read last.
    file: Arc<str>,
    /// The edited text, and the text of the file that it replaces; `None` if it is not edited.
    edited: Option<[Arc<str>; 2]>,
    /// When the file was written last.
    saved: Option<Instant>,
}

impl Draft {
    /// The text: the edited one, else that of the file.
    pub fn text(&self) -> &Arc<str> {
        self.edited.as_ref().map_or(&self.file, |[text, _]| text)
    }

    /// The text of the file when it was read last.
    pub fn file(&self) -> &Arc<str> {
        &self.file
    }

    /// The text of the file that saving replaces.
    pub fn base(&self) -> &Arc<str> {
        self.edited.as_ref().map_or(&self.file, |[_, base]| base)
    }

    /// Returns true if the text differs from that of the file.
    pub fn is_edited(&self) -> bool {
        self.edited.is_some()
    }

    /// Returns true if the text was edited in the window and the file was changed meanwhile.
    pub fn is_in_conflict(&self) -> bool {
        self.edited.as_ref().is_some_and(|[_, base]| *base != self.file)
    }

    /// Edits the text. The text of the file ends the edit.
    pub fn set_text(&mut self, text: &str) {
        let base = Arc::clone(self.base());
        self.edited = (*text != *self.file).then(|| [text.into(), base]);
    }

    /// Records the text of the file as it was read after a moment. It is ignored if the file has
    /// been written since, because it may be the text before that.
    pub fn set_read(&mut self, file: Arc<str>, after: Instant) {
        if self.saved.is_none_or(|saved| saved < after) {
            self.set_file(file);
        }
    }

    /// Records the text of the file. An edited text is kept, unless the file has the same now.
    fn set_file(&mut self, file: Arc<str>) {
        self.edited.take_if(|[text, _]| *text == file);
        self.file = file;
    }

    /// Records that a text was saved. If it was edited since, it is based on the saved one. A file
    /// that was changed and read since has its newer text.
    pub fn set_saved(&mut self, saved: &SavedText) {
        self.saved = Some(saved.ended);
        self.edited.take_if(|[edited, _]| *edited == saved.text);
        if let Some([_, base]) = &mut self.edited {
            *base = Arc::clone(&saved.after);
        }
        if self.file == saved.before {
            self.set_file(Arc::clone(&saved.after));
        }
    }

    /// Restores an edited text, and the text of the file that it replaces.
    pub fn restore(&mut self, text: &str, base: &str) {
        self.edited = (*text != *self.file).then(|| [text.into(), base.into()]);
    }

    /// Gives up the edited text.
    pub fn discard(&mut self) {
        self.edited = None;
    }

    /// Keeps the edited text; saving it replaces the changed file.
    pub fn keep(&mut self) {
        if let Some([_, base]) = &mut self.edited {
            *base = Arc::clone(&self.file);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn saved([before, text]: [&str; 2]) -> SavedText {
        let [before, text] = [before, text].map(Arc::from);
        SavedText { before, after: Arc::clone(&text), text, ended: Instant::now() }
    }

    #[test]
    fn a_text_that_was_read_before_the_file_was_saved_is_ignored() {
        let mut draft = Draft::default();
        let before = Instant::now();
        draft.set_read("a".into(), before);
        draft.set_text("b");
        draft.set_saved(&saved(["a", "b"]));
        draft.set_read("a".into(), before);
        assert_eq!((&**draft.text(), draft.is_edited()), ("b", false));
        draft.set_read("a".into(), Instant::now() + std::time::Duration::from_nanos(1));
        assert_eq!(&**draft.text(), "a");
    }

    #[test]
    fn an_edited_text_is_kept_when_the_file_changes() {
        let mut draft = Draft::default();
        draft.set_file("a".into());
        draft.set_text("b");
        draft.set_file("c".into());
        assert_eq!((&**draft.text(), &**draft.base(), draft.is_in_conflict()), ("b", "a", true));
        draft.set_text("bb");
        assert!(draft.is_in_conflict());
        draft.keep();
        assert_eq!((&**draft.text(), &**draft.base(), draft.is_in_conflict()), ("bb", "c", false));
        // Saved, and edited since.
        draft.set_text("bbb");
        draft.set_saved(&saved(["c", "bb"]));
        assert_eq!((&**draft.text(), &**draft.base(), draft.is_edited()), ("bbb", "bb", true));
        draft.set_saved(&saved(["bb", "bbb"]));
        assert_eq!((&**draft.text(), draft.is_edited()), ("bbb", false));
        // The file was changed again before its saving was reported.
        draft.set_saved(&saved(["c", "bb"]));
        assert_eq!(&**draft.text(), "bbb");
        // Undone.
        draft.set_text("d");
        draft.set_text("bbb");
        assert!(!draft.is_edited());
        draft.set_text("d");
        draft.discard();
        assert_eq!(&**draft.text(), "bbb");
    }
}
