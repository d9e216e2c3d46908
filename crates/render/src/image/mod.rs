//! A finished picture in linear light, with how each ray ended.

#[cfg(feature = "files")]
mod file;
#[cfg(feature = "files")]
mod raster;
mod samples;

use sdfc_graph::linear_to_srgb8;
use sdfc_march::{LOOPS_ENDED, PixelBlock};

use crate::error::RenderError;
use crate::limits::{MAX_PIXELS, MAX_SIDE};
use crate::tiles::Tile;
use crate::view::footprint::Footprint;
#[cfg(feature = "files")]
pub use file::Animation;
#[cfg(feature = "files")]
pub use raster::{Raster, RasterKind};
pub use samples::sample_offsets;

/// [`PixelBlock::status`] of a ray that hit nothing.
pub const MISS: u16 = 0;
/// [`PixelBlock::status`] of a ray that hit a surface.
pub const HIT: u16 = 1;
/// [`PixelBlock::status`] of a ray that ran out of steps.
pub const CAPPED: u16 = 2;

/// The colour, in sRGB, of pixels whose colour or depth is not a finite number.
pub const NOT_FINITE_COLOR: [u8; 3] = [255, 0, 255];

/// A picture: linear colours, depths, and how each ray ended, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    size: [u32; 2],
    footprint: Footprint,
    pixels: Vec<PixelBlock>,
}

/// The numbers of rays of a picture by how they ended. The first four add up to its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct PixelCounts {
    /// The ray hit a surface.
    pub hit: u64,
    /// The ray hit nothing.
    pub miss: u64,
    /// The ray ran out of steps.
    pub capped: u64,
    /// Depth or colour is not a finite number, however the ray ended.
    pub nan: u64,
    /// The ray ran out of steps, or it, a reflection or a shadow ray passed a stretch without a
    /// proof that it is free, however the ray ended.
    pub unproven: u64,
    /// The driver ended loops of the pixel early, however the ray ended.
    pub loops_ended: u64,
}

impl PixelCounts {
    /// Returns the number of all pixels.
    pub fn all(&self) -> u64 {
        self.hit + self.miss + self.capped + self.nan
    }
}

impl Image {
    /// An empty picture, every pixel zero.
    ///
    /// # Errors
    ///
    /// [`RenderError::Size`] outside the limits, [`RenderError::OutOfMemory`].
    pub fn new(size: [u32; 2], footprint: Footprint) -> Result<Self, RenderError> {
        Self::in_place_of(None, size, footprint)
    }

    /// As [`Image::new`], in the memory of a picture that is no longer needed. The system gives
    /// fresh memory page by page when it is written, which can take longer than copying a picture.
    ///
    /// # Errors
    ///
    /// As [`Image::new`].
    pub fn in_place_of(
        old: Option<Self>,
        size: [u32; 2],
        footprint: Footprint,
    ) -> Result<Self, RenderError> {
        check_size(size)?;
        let count = size[0] as usize * size[1] as usize;
        let mut pixels = old.map(|old| old.pixels).unwrap_or_default();
        pixels.clear();
        pixels.try_reserve_exact(count).map_err(|_| {
            RenderError::OutOfMemory(format!("a picture of {}x{} pixels", size[0], size[1]))
        })?;
        pixels.resize(count, PixelBlock::default());
        Ok(Self { size, footprint, pixels })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The width of a pixel at a depth.
    pub fn pixel_width(&self, depth: f32) -> f32 {
        2.0 * self.footprint.at(f64::from(depth)) as f32
    }

    /// The pixels, row by row from the top.
    pub fn pixels(&self) -> &[PixelBlock] {
        &self.pixels
    }

    /// The pixels, row by row from the top.
    pub fn pixels_mut(&mut self) -> &mut [PixelBlock] {
        &mut self.pixels
    }

    /// The pixel in a column and a row; `None` outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> Option<&PixelBlock> {
        let [width, height] = self.size;
        let index = y as usize * width as usize + x as usize;
        (x < width && y < height).then(|| self.pixels.get(index)).flatten()
    }

    /// Writes the pixels of a tile, given row by row in a form that `block` reads. `origin` is the
    /// position of this picture in the whole one, which the tile is relative to; pixels outside of
    /// this picture are left out.
    pub(crate) fn put<T>(
        &mut self,
        origin: [u32; 2],
        tile: Tile,
        pixels: &[T],
        block: impl Fn(&T) -> PixelBlock,
    ) {
        let [columns, rows] = [0, 1].map(|axis| overlap(origin[axis], self.size[axis], tile, axis));
        let (width, tile_width) = (self.size[0] as usize, tile.size[0] as usize);
        let drawn = pixels.chunks_exact(tile_width.max(1)).skip(rows.skipped);
        let shown = self.pixels.chunks_exact_mut(width).skip(rows.first).take(rows.count);
        for (to, from) in shown.zip(drawn) {
            let from = &from[columns.skipped..columns.skipped + columns.count];
            let to = &mut to[columns.first..columns.first + columns.count];
            for (to, from) in to.iter_mut().zip(from) {
                *to = block(from);
            }
        }
    }

    /// The numbers of rays by how they ended.
    pub fn counts(&self) -> PixelCounts {
        let mut counts = PixelCounts::default();
        for pixel in &self.pixels {
            let count = if !is_finite(pixel) {
                &mut counts.nan
            } else {
                match pixel.status {
                    HIT => &mut counts.hit,
                    MISS => &mut counts.miss,
                    _ => &mut counts.capped,
                }
            };
            *count += 1;
            counts.unproven += u64::from(is_unproven(pixel));
            counts.loops_ended += u64::from(pixel.unproven & LOOPS_ENDED != 0);
        }
        counts
    }

    /// Red, green, blue of every pixel in sRGB, 8 bits each. Pixels that are not finite are
    /// [`NOT_FINITE_COLOR`].
    pub fn to_srgb8(&self) -> Vec<u8> {
        let channels = |pixel: &PixelBlock| {
            if !is_finite(pixel) {
                return NOT_FINITE_COLOR;
            }
            let [red, green, blue, _] = pixel.color;
            [red, green, blue].map(linear_to_srgb8)
        };
        let mut bytes = vec![0; 3 * self.pixels.len()];
        for (to, pixel) in bytes.as_chunks_mut().0.iter_mut().zip(&self.pixels) {
            *to = channels(pixel);
        }
        bytes
    }
}

/// The columns or rows that a tile has in common with a picture.
struct Overlap {
    /// The first of them in the picture.
    first: usize,
    /// The number of those before it in the tile.
    skipped: usize,
    count: usize,
}

fn overlap(origin: u32, length: u32, tile: Tile, axis: usize) -> Overlap {
    let (start, side) = (tile.origin[axis], tile.size[axis]);
    let first = start.saturating_sub(origin).min(length);
    let skipped = origin.saturating_sub(start).min(side);
    let count = (side - skipped).min(length - first);
    Overlap { first: first as usize, skipped: skipped as usize, count: count as usize }
}

/// Refuses sizes outside the limits.
pub(crate) fn check_size(size: [u32; 2]) -> Result<(), RenderError> {
    let sides = size.iter().all(|side| (1..=MAX_SIDE).contains(side));
    let area = u64::from(size[0]) * u64::from(size[1]) <= MAX_PIXELS;
    if sides && area { Ok(()) } else { Err(RenderError::Size(size)) }
}

/// Returns true if colour and depth of a pixel are finite numbers.
pub fn is_finite(pixel: &PixelBlock) -> bool {
    pixel.depth.is_finite() && pixel.color.iter().all(|channel| channel.is_finite())
}

/// Returns true if a ray of the pixel ran out of steps or passed a stretch without a proof that it
/// is free, or if the driver ended a loop early.
pub fn is_unproven(pixel: &PixelBlock) -> bool {
    pixel.unproven != 0 || pixel.status == CAPPED
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_outside_the_limits_are_refused() {
        for size in [[0, 4], [4, 0], [MAX_SIDE + 1, 1], [MAX_SIDE, MAX_SIDE]] {
            assert_eq!(Image::new(size, Footprint::default()), Err(RenderError::Size(size)));
        }
        assert!(check_size([MAX_SIDE, 4096]).is_ok());
    }

    #[test]
    fn counts_add_up_and_nan_comes_first() {
        let mut image = Image::new([5, 1], Footprint::default()).unwrap();
        let statuses = [HIT, MISS, CAPPED, HIT, MISS];
        for (pixel, status) in image.pixels_mut().iter_mut().zip(statuses) {
            pixel.status = status;
        }
        image.pixels_mut()[3].depth = f32::NAN;
        image.pixels_mut()[4].color[1] = f32::INFINITY;
        image.pixels_mut()[0].unproven = LOOPS_ENDED;
        let expected =
            PixelCounts { hit: 1, miss: 1, capped: 1, nan: 2, unproven: 2, loops_ended: 1 };
        assert_eq!(image.counts(), expected);
    }

    #[test]
    fn pixels_that_are_not_finite_are_magenta() {
        let mut image = Image::new([3, 1], Footprint::default()).unwrap();
        image.pixels_mut()[0].color = [f32::NAN, 1.0, 1.0, 1.0];
        image.pixels_mut()[1].depth = f32::INFINITY;
        assert_eq!(image.to_srgb8(), [255, 0, 255, 255, 0, 255, 0, 0, 0]);
    }

    #[test]
    fn pixels_outside_are_none() {
        let image = Image::new([3, 2], Footprint::default()).unwrap();
        assert!(image.pixel(2, 1).is_some());
        assert!(image.pixel(3, 0).is_none());
        assert!(image.pixel(0, 2).is_none());
    }
}
