//! Fonts: lays out text and returns its outline as curves. Without the feature `fonts`, a scene
//! with text is an error.

#[cfg(not(feature = "fonts"))]
mod absent;
#[cfg(feature = "fonts")]
mod letters;

#[cfg(not(feature = "fonts"))]
pub use absent::Fonts;
#[cfg(feature = "fonts")]
pub use letters::{Fonts, MAX_CURVES, TOLERANCE};

/// The built-in font: Roboto, an OpenType file.
pub const SANS: &[u8] = include_bytes!("../../fonts/Roboto-Regular.ttf");

/// The layout of lines of text.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// The fraction of a line that is left of x = 0: 0 to start there, 1 to end there.
    pub align: f64,
    /// Extra space between letters, in ems.
    pub spacing: f64,
    /// Distance from one baseline to the next, in ems.
    pub leading: f64,
}
