//! The transfer function of sRGB (IEC 61966-2-1).

use std::sync::LazyLock;

/// Encodes a linear channel as 8 bits of sRGB; below 0 and NaN are 0, above 1 is 255.
///
/// It looks the value up, because a picture has millions of channels, and a power for each takes
/// longer than everything else that is done with them. The results are those of the formula.
pub fn linear_to_srgb8(linear: f32) -> u8 {
    let table = &*TABLE;
    // NaN is not above 0.
    let linear = if linear > 0.0 { linear.min(1.0) } else { 0.0 };
    let code = table.codes[interval(linear)];
    // The next code begins in the same interval or in a later one.
    code + u8::from(linear >= table.begins[usize::from(code) + 1])
}

/// Numbers below 2^-13 have code 0.
const LOWEST: u32 = (127 - 13) << 23;
/// Intervals between a power of 2 and the next, so many that no two codes begin in one: the upper
/// half of 0..1 has 67 codes.
const INTERVALS_BITS: u32 = 7;
const INTERVALS: usize = (13 << INTERVALS_BITS) + 1;

struct Table {
    /// The code at the start of each interval.
    codes: [u8; INTERVALS],
    /// The smallest number of each code, and one that none reaches.
    begins: [f32; 257],
}

static TABLE: LazyLock<Table> = LazyLock::new(|| {
    let mut begins = [f32::INFINITY; 257];
    for (code, begin) in begins.iter_mut().take(256).enumerate() {
        *begin = smallest(|linear| usize::from(encoded(linear)) >= code);
    }
    let mut codes = [0; INTERVALS];
    for (code, bits) in codes.iter_mut().zip((LOWEST..).step_by(1 << (23 - INTERVALS_BITS))) {
        *code = encoded(f32::from_bits(bits));
    }
    Table { codes, begins }
});

/// The interval of a number in 0..=1.
fn interval(linear: f32) -> usize {
    (linear.to_bits().saturating_sub(LOWEST) >> (23 - INTERVALS_BITS)) as usize
}

/// The smallest number in 0..=1 for which a condition holds that holds for all larger ones.
fn smallest(holds: impl Fn(f32) -> bool) -> f32 {
    // The bits of positive numbers are in the order of the numbers.
    let (mut low, mut high) = (0, 1.0f32.to_bits());
    while low < high {
        let middle = low.midpoint(high);
        if holds(f32::from_bits(middle)) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    f32::from_bits(high)
}

/// The code of a number in 0..=1, by the formula.
fn encoded(linear: f32) -> u8 {
    let encoded =
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_has_its_known_values() {
        // 0.5 in linear light is 188 (187.5 rounded), 0.2140411 is the middle grey 127.5.
        let cases = [(0.0, 0), (1.0, 255), (0.5, 188), (0.002, 7), (-1.0, 0), (3.0, 255)];
        for (linear, expected) in cases {
            assert_eq!(linear_to_srgb8(linear), expected, "{linear}");
        }
        for (special, expected) in [(f32::NAN, 0), (f32::INFINITY, 255), (-0.0, 0)] {
            assert_eq!(linear_to_srgb8(special), expected, "{special}");
        }
    }

    #[test]
    fn the_table_has_the_codes_of_the_formula() {
        let near_begins = TABLE.begins.iter().take(256).flat_map(|begin| {
            let bits = begin.to_bits();
            [bits.saturating_sub(1), bits, bits + 1]
        });
        // A step that is prime to powers of 2 reaches each interval in many places.
        let spread = (0..=1.0f32.to_bits()).step_by(997);
        for bits in near_begins.chain(spread) {
            let linear = f32::from_bits(bits).min(1.0);
            assert_eq!(linear_to_srgb8(linear), encoded(linear), "{linear}");
        }
    }
}
