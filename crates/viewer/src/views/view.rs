//! The parts of a view: name, hover text and function.

use crate::views::input::ViewInput;
use crate::views::legend::Legend;

/// A way to show a picture.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// The name in the menu.
    pub name: &'static str,
    /// The hover text: the quantity that the view shows, and its unit.
    pub help: &'static str,
    /// Returns the colours of each pixel as red, green, blue, alpha in sRGB, and their legend.
    pub paint: fn(&ViewInput<'_>) -> (Vec<u8>, Legend),
}
