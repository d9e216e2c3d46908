//! The integer hash, with the same bits in every number type and on every device.

/// Number of hash values: 24 bits, the widest whole numbers that f32 holds.
pub const HASH_COUNT: f64 = 16_777_216.0;

/// The greatest f32 below 2^31.
const LARGEST: f64 = 2_147_483_520.0;

/// A whole number from 0 to [`HASH_COUNT`] - 1, from another one (the state) and `floor(x)`.
///
/// The state and `floor(x)`, clamped to the f32 values that fit an i32, are added as words and
/// permuted by one round of PCG (Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020).
/// The upper 24 bits are the result. A point in several dimensions is hashed one coordinate after
/// the other, each result being the next state. NaN counts as 0 here and as any number on a device.
pub fn hash(state: f64, x: f64) -> f64 {
    let clamped = x.clamp(-LARGEST - 128.0, LARGEST);
    // The same as `clamped.floor()`, which is a function call where the target has no instruction.
    let truncated = clamped as i64;
    let whole = truncated - i64::from(clamped < truncated as f64);
    let word = (state as u32).wrapping_add(whole as u32);
    let state = word.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    f64::from(((word >> 22) ^ word) >> 8)
}
