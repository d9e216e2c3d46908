//! Comparison of the pictures in the documentation with those that are drawn today.
//!
//! Pictures of the documentation are drawn on the CPU in single precision. The mathematical
//! functions of different machines differ in the last digits, and at an edge rounding alone decides
//! which surface a pixel shows.

/// The largest fraction of channels that may differ by more than [`TOLERANCE`].
const MAX_FRACTION: f64 = 0.01;

/// The largest difference of a channel that does not count, in steps of 1/255.
const TOLERANCE: u8 = 8;

/// Returns true if two image files show the same picture up to rounding.
///
/// Files that cannot be decoded are never the same.
pub fn is_same_picture(a: &[u8], b: &[u8]) -> bool {
    let decode = |bytes| image::load_from_memory(bytes).map(image::DynamicImage::into_rgb8);
    let (Ok(a), Ok(b)) = (decode(a), decode(b)) else { return false };
    if a.dimensions() != b.dimensions() {
        return false;
    }
    let total = a.as_raw().len() as f64;
    let differ = a.as_raw().iter().zip(b.as_raw()).filter(|(a, b)| a.abs_diff(**b) > TOLERANCE);
    differ.count() as f64 <= MAX_FRACTION * total
}
