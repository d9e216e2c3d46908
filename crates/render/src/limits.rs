//! Limits of pictures.

/// The longest side of a picture in pixels.
pub const MAX_SIDE: u32 = 16_384;
/// The largest number of pixels of a picture: 2 GiB of [`PixelBlock`](sdfc_march::PixelBlock)s.
pub const MAX_PIXELS: u64 = 1 << 26;
/// The largest number of camera rays for one pixel.
pub const MAX_SAMPLES: u32 = 1024;
