//! Changed values: written to the scene's file, and carried over when the file changes.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Session;
use crate::export::exporter::{ExportJob, ExportOutcome};
use crate::scene::model::Model;
use crate::scene::param_source::with_param_defaults;
use crate::scene::rebase::{pair_numbers, rebase_numbers};

/// The most lost numbers that a message lists.
const MAX_LISTED: usize = 4;

/// Which changed values are saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Saved {
    /// The numbers of the source.
    Numbers,
    /// The params, as their defaults.
    Params,
    /// Both.
    All,
}

/// Whether changed values are being written to the scene's file.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SaveState {
    /// Nothing is being written, and the last attempt was successful.
    #[default]
    Idle,
    /// The file is being written.
    Writing,
    /// The last attempt failed; why.
    Failed(String),
}

/// The last attempt to save.
#[derive(Debug, Default)]
pub(super) struct Saving {
    state: SaveState,
    written: Option<Edited>,
}

/// The scene's source before and after changed values were written into it.
#[derive(Debug)]
struct Edited {
    before: String,
    after: String,
    /// The params that became defaults.
    params: BTreeMap<String, [f64; 4]>,
}

impl Session {
    /// Whether changed values are being written to the scene's file.
    pub fn save_state(&self) -> &SaveState {
        &self.saving.state
    }

    /// Returns true if numbers of the source have been changed and are not in the file.
    /// Changed params are not counted, because the settings keep them.
    pub fn has_unsaved_numbers(&self) -> bool {
        self.param_values.changed_numbers() > 0
    }

    /// The scene's source with its changed numbers.
    pub fn current_text(&self) -> String {
        let is_shown = self.model.as_ref().is_some_and(|model| model.source == *self.source);
        match is_shown {
            true => self.param_values.source_with_values(&self.source),
            false => self.source.to_string(),
        }
    }

    /// Writes changed values to the scene's file, unless it has changed on disk. The outcome is
    /// the later [`save_state`](Self::save_state), and a [message](Self::messages).
    pub fn save_to_file(&mut self, what: Saved) {
        match self.source_to_save(what) {
            Ok(edited) => {
                let (before, after) = (edited.before.clone(), edited.after.clone());
                let path = self.path().to_owned();
                self.saving = Saving { state: SaveState::Writing, written: Some(edited) };
                self.export_worker.send(ExportJob::SaveScene { path, before, after });
            }
            Err(why) => self.fail_saving(why),
        }
    }

    fn source_to_save(&self, what: Saved) -> Result<Edited, String> {
        let Some(model) = &self.model else { return Err("not saved: there is no scene".into()) };
        if *self.source != *model.source {
            let why = "not saved: the scene's file was edited and has errors; correct them and \
                       save again. The changed values are kept";
            return Err(why.to_owned());
        }
        let before = model.source.clone();
        let mut after = before.clone();
        let mut params = BTreeMap::new();
        if what != Saved::Params {
            after = self.param_values.source_with_values(&after);
        }
        if what != Saved::Numbers {
            params = self.param_values.params.clone();
            after = with_param_defaults(&after, model.declared(), &params)?;
        }
        Ok(Edited { before, after, params })
    }

    fn fail_saving(&mut self, why: String) {
        self.messages.push(why.clone());
        self.saving = Saving { state: SaveState::Failed(why), written: None };
    }

    /// Reports the outcome of an export or of saving.
    pub(super) fn handle_export_outcome(&mut self, outcome: ExportOutcome) {
        match outcome.result {
            Err(why) if outcome.is_scene => self.fail_saving(why),
            Ok(message) | Err(message) => {
                if outcome.is_scene {
                    self.saving.state = SaveState::Idle;
                }
                self.messages.push(message);
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
        if self.has_unsaved_numbers() {
            let positions = match &written {
                Some(_) => pair_numbers(&model.source, &next.source),
                None => rebase_numbers(&model.source, &next.source),
            };
            let lost = self.param_values.rebase(next, &positions);
            if !lost.is_empty() {
                let more = if lost.len() > MAX_LISTED { ", …" } else { "" };
                let listed = lost.iter().take(MAX_LISTED).cloned().collect::<Vec<_>>().join(", ");
                let text =
                    format!("the file replaced numbers that you had changed: {listed}{more}");
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
