//! What a view consists of.

use crate::views::input::ViewInput;
use crate::views::legend::Legend;

/// A way to show a picture.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// The name in the menu.
    pub name: &'static str,
    /// What the view shows, as hover text.
    pub help: &'static str,
    /// Returns the colours of each pixel as red, green, blue, alpha in sRGB, and their legend.
    pub paint: fn(&ViewInput<'_>) -> (Vec<u8>, Legend),
}
