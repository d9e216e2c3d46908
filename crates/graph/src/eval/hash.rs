//! The integer hash, the same bits in every domain and on every device.

/// How many values a hash has: 24 bits, which f32 holds.
pub const HASHES: f64 = 16_777_216.0;

/// The greatest f32 below 2^31.
const LARGEST: f64 = 2_147_483_520.0;

/// A whole number from 0 to [`HASHES`] - 1, from another such and the whole part of x.
///
/// The state and `floor(x)`, brought into the range of an f32 that fits 32 bits with a sign, are added as words and
/// permuted by one round of PCG (Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020); the upper 24 bits stay. A
/// place in several dimensions is hashed one coordinate after the other, each result the next state. NaN counts as 0 here
/// and as anything on a device.
pub fn hash(state: f64, x: f64) -> f64 {
    let whole = x.floor().clamp(-LARGEST - 128.0, LARGEST) as i64;
    let word = (state as u32).wrapping_add(whole as u32);
    let state = word.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    f64::from(((word >> 22) ^ word) >> 8)
}
