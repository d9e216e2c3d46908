//! What is saved to the scene's file, and whether it is there.

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
pub struct Saving {
    /// Whether the file is being written.
    pub state: SaveState,
    /// What was written last, until the shown scene is that.
    pub written: Option<Edited>,
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
