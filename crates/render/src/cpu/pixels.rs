//! What draws groups of pixels: rays in waves, or the formula of a planar picture.

use sdfc_march::PixelBlock;

/// The state of one thread that draws groups of pixels.
pub(super) trait Pixels: Clone + Send + Sync {
    /// Draws pixels, given by column and row.
    fn pixels(&mut self, positions: &[[u32; 2]]) -> Vec<PixelBlock>;
}
