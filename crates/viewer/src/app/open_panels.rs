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
    /// The errors over the picture.
    pub errors: bool,
    /// The warnings over the picture.
    pub warnings: bool,
}

impl Default for OpenPanels {
    fn default() -> Self {
        let [export, help, warnings] = [false; 3];
        Self { controls: true, code: true, export, help, errors: true, warnings }
    }
}
