//! The transfer function of sRGB (IEC 61966-2-1).

/// Encodes a linear channel as 8 bits of sRGB; below 0 and NaN are 0, above 1 is 255.
pub fn linear_to_srgb8(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded =
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    // `as` saturates, and makes 0 of NaN.
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
        assert_eq!(linear_to_srgb8(f32::NAN), 0);
    }
}
