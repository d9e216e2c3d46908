//! Requests of a panel to the window.

use crate::compile::diagnostics::ShownFix;

/// Something that only the window can do.
pub enum Action {
    /// Copies text to the clipboard.
    Copy(String),
    /// Makes a change of a file that a diagnostic proposes.
    Fix(String, ShownFix),
    /// Shows a message in the status line.
    Message(String),
}
