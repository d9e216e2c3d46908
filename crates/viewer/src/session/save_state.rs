//! The state of writing edited texts and changed values to their files.

use std::collections::BTreeMap;
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
    /// True while the scene is being written.
    pub writes_scene: bool,
    /// Why the last attempt failed.
    pub failure: Option<String>,
    /// What was written last, until the shown scene is that.
    pub written: Option<Edited>,
}

impl Saving {
    /// Whether files are being written.
    pub fn state(&self) -> SaveState {
        match &self.failure {
            Some(why) => SaveState::Failed(why.clone()),
            None if self.writes_scene || !self.imports.is_empty() => SaveState::Writing,
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
#[derive(Debug)]
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
