//! Changed values: written to the scene's file, and carried over when the file changes.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Session;
use crate::export::exporter::{ExportJob, ExportOutcome};
use crate::scene::model::Model;
use crate::scene::param_source::with_param_defaults;
use crate::scene::rebase::{pair_numbers, rebase_numbers};
use crate::session::save_state::{Edited, SaveState, Saved, Saving};

/// The most lost numbers that a message lists.
const MAX_LISTED: usize = 4;

impl Session {
    /// Whether changed values are being written to the scene's file.
    pub fn save_state(&self) -> &SaveState {
        &self.saving.state
    }

    /// Returns true if the text was edited or numbers were changed, and the file has neither.
    /// Changed params are not counted, because the settings keep them.
    pub fn has_unsaved_changes(&self) -> bool {
        self.draft.is_edited() || self.param_values.changed_numbers() > 0
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
                self.saving = Saving { state: SaveState::Writing, written: Some(edited) };
                self.export_worker.send(ExportJob::SaveScene { path, before, after });
            }
            Err(why) => self.fail_saving(why),
        }
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
            return Err("not saved: the file has changed on disk; the panel Code asks".to_owned());
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
        Ok(Edited { before, text, after, params })
    }

    fn fail_saving(&mut self, why: String) {
        self.messages.push(why.clone());
        self.saving = Saving { state: SaveState::Failed(why), written: None };
    }

    /// Reports the outcome of an export or of saving.
    pub(super) fn handle_export_outcome(&mut self, outcome: ExportOutcome) {
        match outcome.result {
            Err(why) if outcome.is_scene => self.fail_saving(why),
            Ok(message) if outcome.is_scene => {
                self.saving.state = SaveState::Idle;
                self.messages.push(message);
                // The text may have been edited since the file was written.
                if let Some(written) = &self.saving.written {
                    let [text, before] = [&written.text, &written.before].map(Arc::clone);
                    let after = Arc::from(&*written.after);
                    self.edit(|draft| draft.set_saved(&text, &before, &after));
                }
            }
            Ok(message) | Err(message) => self.messages.push(message),
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
