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
    /// True if the panel of controls was opened after that of the source.
    controls_are_newer: bool,
}

/// Below this width in points there is no room for the picture and both panels.
const BOTH_PANELS: f32 = 820.0;

impl OpenPanels {
    /// Closes the older one of both panels if there is no room for both.
    pub fn keep_room_for_picture(&mut self, width: f32) {
        if self.code && self.controls {
            if width < BOTH_PANELS {
                (self.code, self.controls) = (!self.controls_are_newer, self.controls_are_newer);
            }
        } else {
            self.controls_are_newer = self.code;
        }
    }
}

impl Default for OpenPanels {
    fn default() -> Self {
        let [export, help, warnings] = [false; 3];
        Self {
            controls: true,
            code: true,
            export,
            help,
            errors: true,
            warnings,
            controls_are_newer: false,
        }
    }
}
