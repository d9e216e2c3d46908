//! Requests of a panel to the window.

/// Something that only the window can do.
pub enum Action {
    /// Copies text to the clipboard.
    Copy(String),
    /// Shows a message in the status line.
    Message(String),
}
