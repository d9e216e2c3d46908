//! The colours that views share, and the conversion to sRGB.

use sdfc_march::PixelBlock;
use sdfc_render::linear_to_srgb8;

use crate::views::legend::mix;

/// Pixels that are wrong.
pub const ALARM: [u8; 3] = [255, 64, 129];
/// Pixels that deserve a look.
pub const NOTICE: [u8; 3] = [255, 193, 7];
/// Values that are not finite.
pub const NOT_FINITE: [u8; 3] = [0, 229, 255];
/// Pixels that are right.
pub const GOOD: [u8; 3] = [76, 175, 80];
/// Pixels whose ray hit nothing.
pub const BACKGROUND: [u8; 3] = [24, 26, 30];
/// Negative values of the field.
pub const INSIDE: [u8; 3] = [224, 122, 63];
/// Positive values of the field.
pub const OUTSIDE: [u8; 3] = [58, 124, 165];

/// The sRGB colour of a pixel.
pub fn to_srgb(pixel: &PixelBlock) -> [u8; 3] {
    let [red, green, blue, _] = pixel.color;
    [red, green, blue].map(linear_to_srgb8)
}

/// A darkened grey of the same luminance, against which marked pixels stand out.
pub fn dimmed(color: [u8; 3]) -> [u8; 3] {
    let [red, green, blue] = color.map(u32::from);
    let grey = ((red * 54 + green * 183 + blue * 19) / 256) as u8;
    mix([grey; 3], [0; 3], 0.45)
}
