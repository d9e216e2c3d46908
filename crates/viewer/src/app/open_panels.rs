//! Which panels and windows are open.

/// Which panels and windows are open.
#[derive(Clone, Copy, Debug)]
pub struct OpenPanels {
    /// The panel of params, time, camera and drawing.
    pub controls: bool,
    /// The panel with the scene's source.
    pub code: bool,
    /// The export dialog.
    pub export: bool,
    /// The list of keys.
    pub help: bool,
    /// The warnings over the picture; errors are always shown.
    pub warnings: bool,
}

impl Default for OpenPanels {
    fn default() -> Self {
        Self { controls: true, code: false, export: false, help: false, warnings: false }
    }
}
