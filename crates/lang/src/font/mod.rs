//! Letters as curves: text laid out in an outline font. Without the feature `fonts` there are none, and a scene that
//! writes something is refused.

#[cfg(not(feature = "fonts"))]
mod absent;
#[cfg(feature = "fonts")]
mod letters;

#[cfg(not(feature = "fonts"))]
pub use absent::Fonts;
#[cfg(feature = "fonts")]
pub use letters::{Fonts, MAX_CURVES, TOLERANCE};

/// The font that comes with the library: Roboto, an OpenType file.
pub const SANS: &[u8] = include_bytes!("../../fonts/Roboto-Regular.ttf");

/// How lines are set.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Which part of a line lies at x = 0: 0 its start, 1 its end.
    pub align: f64,
    /// Added between letters.
    pub spacing: f64,
    /// From one baseline to the next.
    pub leading: f64,
}
