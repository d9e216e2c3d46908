//! Applies a view to every pixel of a rendered image, or to some.
//!
//! Most views evaluate the field in f64 for each pixel, which can take seconds. So the colours of
//! few pixels come first, and more follow.

use sdfc_render::{Image, RenderError};

use crate::render::surface_points;
use crate::views::input::{ViewInput, rendered_position};
use crate::views::legend::Legend;
use crate::views::mode::ViewMode;

/// The most pixels of the first and coarsest picture of a view.
const FIRST_PIXELS: u32 = 4096;

/// A view of an image.
#[derive(Clone, Debug)]
pub struct ColoredView {
    /// Red, green, blue, alpha of each pixel in sRGB.
    pub rgba: Vec<u8>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The meaning of the colours.
    pub legend: Legend,
    /// Every `stride`-th pixel of every `stride`-th row is there.
    pub stride: u32,
}

/// The stride of the first picture of an image: a power of two. The shaded view needs no field.
pub fn first_stride(mode: ViewMode, size: [u32; 2]) -> u32 {
    if mode == ViewMode::Shaded {
        return 1;
    }
    surface_points::stride(size, FIRST_PIXELS).next_power_of_two()
}

fn reduced(size: [u32; 2], stride: u32) -> [u32; 2] {
    size.map(|side| side.div_ceil(stride).max(1))
}

/// Applies a view to every `stride`-th pixel of every `stride`-th row of `input`, which has all.
///
/// # Errors
///
/// There is no memory for the reduced images.
pub fn paint(
    mode: ViewMode,
    input: &ViewInput<'_>,
    stride: u32,
) -> Result<ColoredView, RenderError> {
    if stride == 1 {
        let (rgba, legend) = mode.paint(input);
        return Ok(ColoredView { rgba, size: input.image.size(), legend, stride });
    }
    let [image, colors] =
        [every_nth(input.image, input, stride)?, every_nth(input.colors, input, stride)?];
    let (rgba, legend) =
        mode.paint(&ViewInput { image: &image, colors: &colors, stride, ..*input });
    Ok(ColoredView { rgba, size: image.size(), legend, stride })
}

/// Every `stride`-th pixel of every `stride`-th row. The width of a pixel stays that of `image`.
fn every_nth(image: &Image, input: &ViewInput<'_>, stride: u32) -> Result<Image, RenderError> {
    let mut out = Image::new(reduced(image.size(), stride), input.view.footprint())?;
    let [columns, _] = out.size();
    for (index, pixel) in out.pixels_mut().iter_mut().enumerate() {
        let index = index as u32;
        let position = [index % columns, index / columns];
        let [x, y] = rendered_position(position, stride, image.size());
        if let Some(rendered) = image.pixel(x, y) {
            *pixel = *rendered;
        }
    }
    Ok(out)
}
