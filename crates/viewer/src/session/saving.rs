//! Changed values: written to the scene's file, and carried over when the file changes.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::Session;
use crate::export::exporter::{ExportJob, ExportOutcome};
use crate::scene::document::path_of;
use crate::scene::line_endings::formatted;
use crate::scene::model::Model;
use crate::scene::param_source::with_param_defaults;
use crate::scene::rebase::{pair_numbers, rebase_numbers};
use crate::session::draft::Draft;
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
        match self.text_to_save(what) {
            Ok(edited) => {
                let (before, after) = (edited.before.to_string(), edited.after.clone());
                let path = self.path().to_owned();
                (self.saving.writes_scene, self.saving.failure) = (true, None);
                self.saving.written = Some(edited);
                self.export_worker.send(ExportJob::SaveSource { path, before, after });
            }
            Err(why) => self.fail_saving(why),
        }
    }

    /// Writes the text of an imported file, unless that has changed on disk.
    pub(super) fn save_import(&mut self, name: &str) {
        let Some(draft) = self.tabs.draft(name) else { return };
        if draft.is_in_conflict() {
            return self.fail_saving(format!("{name}: {CONFLICT}"));
        }
        let [before, text] = [draft.base(), draft.text()].map(Arc::clone);
        let after: Arc<str> = self.formatted_to_save(text.to_string()).into();
        let path = path_of(self.path(), name);
        let job = [before.to_string(), after.to_string()];
        self.saving.failure = None;
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
            self.saving.written = Some(Edited { before, text, after, params });
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
            Some(path) if path == *self.path() => self.scene_is_written(outcome.result),
            Some(path) => self.import_is_written(&path, outcome.result),
        }
    }

    fn scene_is_written(&mut self, result: Result<String, String>) {
        self.saving.writes_scene = false;
        match result {
            Err(why) => {
                self.saving.written = None;
                self.fail_saving(why);
            }
            Ok(message) => {
                self.messages.push(message);
                // The text may have been edited since the file was written.
                if let Some(written) = &self.saving.written {
                    let [text, before] = [&written.text, &written.before].map(Arc::clone);
                    let after = Arc::from(&*written.after);
                    self.edit(|draft| draft.set_saved(&text, &before, &after));
                }
            }
        }
    }

    fn import_is_written(&mut self, path: &Path, result: Result<String, String>) {
        let is_it = |name: &String| path_of(self.path(), name) == *path;
        let Some(name) = self.saving.imports.keys().find(|name| is_it(name)).cloned() else {
            // Another scene was opened meanwhile.
            return self.messages.push(result.unwrap_or_else(|why| why));
        };
        let Some(written) = self.saving.imports.remove(&name) else { return };
        match result {
            Err(why) => self.fail_saving(why),
            Ok(message) => {
                self.messages.push(message);
                let WrittenImport { before, text, after } = written;
                let saved = |draft: &mut Draft| draft.set_saved(&text, &before, &after);
                self.edit_file(&TabFile::Import(name), saved);
            }
        }
    }

    /// Moves the changed values from the shown model to the next one. A number that the user of an
    /// editor has changed or removed meanwhile is lost, which a message says.
    pub(super) fn carry_values_over(&mut self, next: &Arc<Model>) {
        let Some(model) = self.model.as_ref().filter(|model| model.source != next.source) else {
            return;
        };
        let written = self.saving.written.take_if(|edited| edited.after == next.source);
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
