//! The state of writing edited texts and changed values to their files.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Which changed values are saved with the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Saved {
    /// The text and the changed numbers.
    Numbers,
    /// The text, with the params as their defaults.
    Params,
    /// The text with both.
    All,
}

impl Saved {
    /// What both save.
    pub fn and(self, other: Self) -> Self {
        if self == other { self } else { Self::All }
    }
}

/// Whether files are being written.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SaveState {
    /// Nothing is being written, and the last attempt was successful.
    #[default]
    Idle,
    /// A file is being written.
    Writing,
    /// The last attempt failed; why.
    Failed(String),
}

/// The files that are being written, and the last attempt to write the scene.
#[derive(Debug, Default)]
pub struct Saving {
    /// What is being written to imported files, by their path beside the scene.
    pub imports: BTreeMap<String, WrittenImport>,
    /// The imported files that are written again as soon as they are written.
    pub next_imports: BTreeSet<String>,
    /// What is being written to the scene's file.
    pub scene: Option<Edited>,
    /// What is written to the scene's file as soon as it is written.
    pub next_scene: Option<Saved>,
    /// Why an attempt failed since the user asked for saving last.
    pub failure: Option<String>,
    /// What was written to the file last, until the shown scene is that.
    pub written: Option<Edited>,
    /// The text into which numbers were written last, until the shown scene is that.
    pub written_into_text: Option<Edited>,
}

impl Saving {
    /// Whether files are being written.
    pub fn state(&self) -> SaveState {
        match &self.failure {
            Some(why) => SaveState::Failed(why.clone()),
            None if self.scene.is_some() || !self.imports.is_empty() => SaveState::Writing,
            None => SaveState::Idle,
        }
    }
}

/// What is being written to an imported file.
#[derive(Debug)]
pub struct WrittenImport {
    /// The text that the file must have.
    pub before: Arc<str>,
    /// The text in the window.
    pub text: Arc<str>,
    /// The text that the file gets.
    pub after: Arc<str>,
}

/// The scene's source before and after changed values were written into it.
#[derive(Clone, Debug)]
pub struct Edited {
    /// The text that the file must have.
    pub before: Arc<str>,
    /// The text of the scene in the window, without the changed values.
    pub text: Arc<str>,
    /// The text that the file gets.
    pub after: String,
    /// The params that became defaults.
    pub params: BTreeMap<String, [f64; 4]>,
}
