//! Whether two files show the same picture.
//!
//! Pictures of the documentation are drawn on the processor in single precision. The mathematical functions of machines
//! differ in the last digits, and at edges a pixel goes one way or the other by rounding alone.

/// A picture counts as the same if no more than this share of its channels, ...
const SHARE: f64 = 0.01;
/// ... differs by more than this, in steps of 1/255.
const DIFFER: u8 = 8;

/// Whether they do, up to rounding; what cannot be read is no picture.
pub fn same(a: &[u8], b: &[u8]) -> bool {
    let decode = |bytes| image::load_from_memory(bytes).map(image::DynamicImage::into_rgb8);
    let (Ok(a), Ok(b)) = (decode(a), decode(b)) else { return false };
    if a.dimensions() != b.dimensions() {
        return false;
    }
    let all = a.as_raw().len() as f64;
    let differ = a.as_raw().iter().zip(b.as_raw()).filter(|(a, b)| a.abs_diff(**b) > DIFFER);
    differ.count() as f64 <= SHARE * all
}
