//! Changed values: written to the scene's file, and carried over when the file changes.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use super::Session;
use crate::export::exporter::{ExportJob, ExportOutcome};
use crate::scene::document::path_of;
use crate::scene::line_endings::formatted;
use crate::scene::model::Model;
use crate::scene::param_source::with_param_defaults;
use crate::scene::rebase::{pair_numbers, rebase_numbers};
use crate::session::draft::{Draft, SavedText};
use crate::session::save_state::{Edited, SaveState, Saved, WrittenImport};
use crate::session::tabs::TabFile;

/// The most lost numbers that a message lists.
const MAX_LISTED: usize = 4;
/// Why a text is not saved that was edited in the window and in the file.
const CONFLICT: &str = "not saved: the file has changed on disk; the panel Code asks";

impl Session {
    /// Whether files are being written.
    pub fn save_state(&self) -> SaveState {
        self.saving.state()
    }

    /// Returns true if a text was edited or numbers were changed, and the files have neither.
    /// Changed params are not counted, because the settings keep them.
    pub fn has_unsaved_changes(&self) -> bool {
        !self.edited_files().is_empty() || self.param_values.changed_numbers() > 0
    }

    /// The text of the scene with its changed numbers.
    pub fn current_text(&self) -> String {
        let text = self.text();
        match self.model.as_ref().filter(|_| self.param_values.changed_numbers() > 0) {
            None => text.to_string(),
            Some(model) => {
                let positions = rebase_numbers(&model.source, text);
                self.param_values.moved(&positions).source_with_values(text)
            }
        }
    }

    /// Writes the text and the changed values to the scene's file, unless that has changed on disk.
    /// The outcome is the later [`save_state`](Self::save_state), and a
    /// [message](Self::messages).
    pub fn save_to_file(&mut self, what: Saved) {
        self.saving.failure = None;
        self.save_scene(what);
    }

    /// Writes the scene as [`save_to_file`](Self::save_to_file) does, and keeps an earlier failure.
    /// While the scene is being written, saving begins when that has ended: the file has then the
    /// text that this one replaces.
    pub(super) fn save_scene(&mut self, what: Saved) {
        let saving = &mut self.saving;
        if saving.scene.is_some() {
            saving.next_scene = Some(saving.next_scene.map_or(what, |next| next.and(what)));
            return;
        }
        match self.text_to_save(what) {
            Ok(edited) => self.write_scene(edited),
            Err(why) => self.fail_saving(why),
        }
    }

    fn write_scene(&mut self, edited: Edited) {
        let (before, after) = (edited.before.to_string(), edited.after.clone());
        let path = self.path().to_owned();
        self.saving.written = Some(edited.clone());
        self.saving.scene = Some(edited);
        self.export_worker.send(ExportJob::SaveSource { path, before, after });
    }

    /// Writes the text of an imported file, unless that has changed on disk. While it is being
    /// written, saving begins when that has ended.
    pub(super) fn save_import(&mut self, name: &str) {
        if self.saving.imports.contains_key(name) {
            self.saving.next_imports.insert(name.to_owned());
            return;
        }
        let Some(draft) = self.tabs.draft(name) else { return };
        if draft.is_in_conflict() {
            return self.fail_saving(format!("{name}: {CONFLICT}"));
        }
        let [before, text] = [draft.base(), draft.text()].map(Arc::clone);
        let after: Arc<str> = self.formatted_to_save(text.to_string()).into();
        let path = path_of(self.path(), name);
        let job = [before.to_string(), after.to_string()];
        self.saving.imports.insert(name.to_owned(), WrittenImport { before, text, after });
        let [before, after] = job;
        self.export_worker.send(ExportJob::SaveSource { path, before, after });
    }

    /// Writes the changed numbers into the text of the scene, but not into its file.
    pub fn write_numbers_into_text(&mut self) {
        if self.param_values.changed_numbers() > 0 {
            let [before, text] = [self.draft.base(), self.text()].map(Arc::clone);
            let after = self.current_text();
            self.edit(|draft| draft.set_text(&after));
            let params = BTreeMap::new();
            self.saving.written_into_text = Some(Edited { before, text, after, params });
        }
    }

    fn text_to_save(&self, what: Saved) -> Result<Edited, String> {
        if self.draft.is_in_conflict() {
            return Err(CONFLICT.to_owned());
        }
        let [before, text] = [self.draft.base(), self.text()].map(Arc::clone);
        let mut after = match what {
            Saved::Params => text.to_string(),
            Saved::Numbers | Saved::All => self.current_text(),
        };
        let mut params = BTreeMap::new();
        if let Some(model) = self.model.as_ref().filter(|_| what != Saved::Numbers) {
            let values = &self.param_values.params;
            match with_param_defaults(&after, model.declared(), values) {
                Ok(text) => (after, params) = (text, values.clone()),
                Err(why) if what == Saved::Params => return Err(why),
                // The settings keep the params; the text must be saved.
                Err(_) => {}
            }
        }
        let after = self.formatted_to_save(after);
        Ok(Edited { before, text, after, params })
    }

    /// The text as it is saved: formatted, if the user wants that and it has no syntax errors.
    fn formatted_to_save(&self, text: String) -> String {
        let formatted = self.format_on_save.then(|| formatted(&text)).flatten();
        formatted.unwrap_or(text)
    }

    fn fail_saving(&mut self, why: String) {
        self.messages.push(why.clone());
        self.saving.failure = Some(why);
    }

    /// Reports the outcome of an export or of saving.
    pub(super) fn handle_export_outcome(&mut self, outcome: ExportOutcome) {
        match outcome.source {
            None => self.messages.extend([outcome.result.unwrap_or_else(|why| why)]),
            Some(path) if path == *self.path() => {
                self.scene_is_written(outcome.result, outcome.ended);
            }
            Some(path) => self.import_is_written(&path, outcome.result, outcome.ended),
        }
    }

    fn scene_is_written(&mut self, result: Result<String, String>, ended: Instant) {
        let (written, next) = (self.saving.scene.take(), self.saving.next_scene.take());
        match result {
            Err(why) => {
                self.saving.written = None;
                self.fail_saving(why);
            }
            Ok(message) => {
                self.messages.push(message);
                // The text may have been edited since the file was written.
                if let Some(Edited { before, text, after, .. }) = written {
                    let saved = SavedText { before, text, after: after.into(), ended };
                    self.edit(|draft| draft.set_saved(&saved));
                }
                next.into_iter().for_each(|what| self.save_scene_again(what));
            }
        }
    }

    /// Writes the scene's file once more, unless it would get the same text.
    fn save_scene_again(&mut self, what: Saved) {
        match self.text_to_save(what) {
            Ok(edited) if edited.after == *edited.before => {}
            Ok(edited) => self.write_scene(edited),
            Err(why) => self.fail_saving(why),
        }
    }

    fn import_is_written(&mut self, path: &Path, result: Result<String, String>, ended: Instant) {
        let is_it = |name: &String| path_of(self.path(), name) == *path;
        let Some(name) = self.saving.imports.keys().find(|name| is_it(name)).cloned() else {
            // Another scene was opened meanwhile.
            return self.messages.push(result.unwrap_or_else(|why| why));
        };
        let Some(written) = self.saving.imports.remove(&name) else { return };
        let is_wanted_again = self.saving.next_imports.remove(&name);
        match result {
            Err(why) => self.fail_saving(why),
            Ok(message) => {
                self.messages.push(message);
                let WrittenImport { before, text, after } = written;
                let saved = SavedText { before, text, after, ended };
                let file = TabFile::Import(name.clone());
                self.edit_file(&file, |draft| draft.set_saved(&saved));
                if is_wanted_again && self.draft_of(&file).is_some_and(Draft::is_edited) {
                    self.save_import(&name);
                }
            }
        }
    }

    /// Moves the changed values from the shown model to the next one. A number that the user of an
    /// editor has changed or removed meanwhile is lost, which a message says.
    pub(super) fn carry_values_over(&mut self, next: &Arc<Model>) {
        let Some(model) = self.model.as_ref().filter(|model| model.source != next.source) else {
            return;
        };
        let is_next = |edited: &mut Edited| edited.after == next.source;
        let in_text = self.saving.written_into_text.take_if(is_next);
        let written = self.saving.written.take_if(is_next).or(in_text);
        if self.param_values.changed_numbers() > 0 {
            let positions = match &written {
                Some(edited) if *edited.text == *model.source => {
                    pair_numbers(&model.source, &next.source)
                }
                Some(_) | None => rebase_numbers(&model.source, &next.source),
            };
            let lost = self.param_values.rebase(next, &positions);
            if !lost.is_empty() {
                let more = if lost.len() > MAX_LISTED { ", …" } else { "" };
                let listed = lost.iter().take(MAX_LISTED).cloned().collect::<Vec<_>>().join(", ");
                let text = format!("an edit replaced numbers that you had changed: {listed}{more}");
                self.messages.push(text);
            }
        }
        for (name, lanes) in written.into_iter().flat_map(|edited| edited.params) {
            if self.param_values.params.get(&name) == Some(&lanes) {
                self.param_values.params.remove(&name);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::TIMEOUT;

    /// A scene that draws nothing, and files beside it that were read.
    fn opened(folder: &Path, imports: &[&str]) -> Session {
        let path = folder.join("scene.sdf");
        std::fs::write(&path, "// 0\n").unwrap();
        let mut session = Session::open(&path, Arc::new(|| {})).unwrap();
        session.draft.set_read("// 0\n".into(), Instant::now());
        for name in imports {
            std::fs::write(folder.join(name), "// 0\n").unwrap();
            read_import(&mut session, name, "// 0\n");
        }
        session
    }

    fn read_import(session: &mut Session, name: &str, text: &str) {
        let files = [(name.to_owned(), Some(text.into()))];
        session.tabs.set_read(files.into(), Instant::now());
    }

    /// Waits until no file is being written.
    fn finish(session: &mut Session) {
        while session.saving.scene.is_some() || !session.saving.imports.is_empty() {
            let outcome = session.export_outcomes.recv_timeout(TIMEOUT).unwrap();
            session.handle_export_outcome(outcome);
        }
    }

    #[test]
    fn saving_several_files_fails_if_one_of_them_cannot_be_saved() {
        let folder = tempfile::tempdir().unwrap();
        let names = ["a.sdf", "b.sdf"];
        let mut session = opened(folder.path(), &names);
        session.edit(|draft| draft.set_text("// 1\n"));
        for name in names {
            session.tabs.edit(name, |draft| draft.set_text("// 1\n"));
        }
        read_import(&mut session, "a.sdf", "// theirs\n");
        session.save_all();
        finish(&mut session);
        let state = session.save_state();
        assert!(matches!(&state, SaveState::Failed(why) if why.starts_with("a.sdf")), "{state:?}");
        assert_eq!(session.edited_files(), ["a.sdf"]);
        // The user decides to keep the text.
        std::fs::write(folder.path().join("a.sdf"), "// theirs\n").unwrap();
        session.tabs.edit("a.sdf", Draft::keep);
        session.save_all();
        finish(&mut session);
        assert_eq!((session.save_state(), session.has_unsaved_changes()), (SaveState::Idle, false));
        let text = std::fs::read_to_string(folder.path().join("a.sdf")).unwrap();
        assert_eq!(text, "// 1\n");
    }

    #[test]
    fn a_text_that_is_saved_again_while_it_is_written_is_written_afterwards() {
        let folder = tempfile::tempdir().unwrap();
        let mut session = opened(folder.path(), &["a.sdf"]);
        for file in [TabFile::Scene, TabFile::Import("a.sdf".to_owned())] {
            session.show_file(file.clone());
            for text in ["// 1\n", "// 2\n", "// 3\n"] {
                session.edit_shown(|draft| draft.set_text(text));
                session.save_shown(Saved::All);
            }
            session.edit_shown(|draft| draft.set_text("// 4\n"));
            finish(&mut session);
            let path = folder.path().join(file.name(session.path()));
            // What is in the window then is saved.
            assert_eq!(std::fs::read_to_string(&path).unwrap(), "// 4\n");
            assert_eq!((session.save_state(), session.edited_files()), (SaveState::Idle, vec![]));
        }
    }

    #[test]
    fn numbers_that_are_written_into_the_text_do_not_replace_what_is_being_saved() {
        let folder = tempfile::tempdir().unwrap();
        let mut session = opened(folder.path(), &[]);
        let text = "let a = 1\nlet b = 2\n";
        let model = crate::test_support::model("let a = 1\nsphere(a)\n");
        session.draft.set_read(model.source.as_str().into(), Instant::now());
        std::fs::write(session.path(), &model.source).unwrap();
        session.model = Some(Arc::clone(&model));
        session.edit(|draft| draft.set_text(&format!("{text}sphere(a)\n")));
        session.save_to_file(Saved::Numbers);
        session.param_values.set_number(&model.numbers[0], 3.0);
        session.write_numbers_into_text();
        finish(&mut session);
        // The draft replaces the text that was saved.
        assert_eq!(**session.draft().base(), *format!("{text}sphere(a)\n"));
        assert!(!session.draft().is_in_conflict() && session.text().starts_with("let a = 3"));
    }
}
