//! The text of the scene, which may be edited in the window before it is saved.

use std::sync::Arc;

/// The text of a scene and of its file.
#[derive(Clone, Debug, Default)]
pub struct Draft {
    /// The text of the file when it was read last.
    file: Arc<str>,
    /// The edited text, and the text of the file that it replaces; `None` if it is not edited.
    edited: Option<[Arc<str>; 2]>,
}

impl Draft {
    /// The text: the edited one, else that of the file.
    pub fn text(&self) -> &Arc<str> {
        self.edited.as_ref().map_or(&self.file, |[text, _]| text)
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

    /// Records the text of the file. An edited text is kept, unless the file has the same now.
    pub fn set_file(&mut self, file: Arc<str>) {
        self.edited.take_if(|[text, _]| *text == file);
        self.file = file;
    }

    /// Records that `text` was saved as `after`, in place of `before`. If the text was edited
    /// since, it is based on that. A file that was changed and read since has its newer text.
    pub fn set_saved(&mut self, text: &str, before: &str, after: &Arc<str>) {
        self.edited.take_if(|[edited, _]| **edited == *text);
        if let Some([_, base]) = &mut self.edited {
            *base = Arc::clone(after);
        }
        if *self.file == *before {
            self.set_file(Arc::clone(after));
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
        draft.set_saved("bb", "c", &"bb".into());
        assert_eq!((&**draft.text(), &**draft.base(), draft.is_edited()), ("bbb", "bb", true));
        draft.set_saved("bbb", "bb", &"bbb".into());
        assert_eq!((&**draft.text(), draft.is_edited()), ("bbb", false));
        // The file was changed again before its saving was reported.
        draft.set_saved("bb", "c", &"bb".into());
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
