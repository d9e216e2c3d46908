//! The legend of a view, and its colour scales.

/// The meaning of a view's colours.
#[derive(Clone, Debug, PartialEq)]
pub enum Legend {
    /// No legend is shown.
    None,
    /// A scale from one number to another.
    Scale {
        /// The measured quantity, with its unit.
        label: &'static str,
        /// The numbers at both ends.
        ends: [f64; 2],
        /// The colours between them.
        ramp: Ramp,
    },
    /// Single colours and their labels.
    Keys(Vec<([u8; 3], String)>),
}

/// A colour scale for numbers from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ramp {
    /// From few to many (viridis).
    Heat,
    /// From near (light) to far (dark).
    Grey,
    /// Diverging: blue below the middle, red above it.
    Diverging,
}

impl Ramp {
    /// The colour of a number from 0 to 1; numbers outside are clamped, NaN is 0.
    pub fn color(self, value: f64) -> [u8; 3] {
        // Evenly spaced samples of viridis (Smith and van der Walt, CC0).
        const HEAT: &[[u8; 3]] = &[
            [68, 1, 84],
            [72, 40, 120],
            [62, 74, 137],
            [49, 104, 142],
            [38, 130, 142],
            [31, 158, 137],
            [53, 183, 121],
            [109, 205, 89],
            [180, 222, 44],
            [253, 231, 37],
        ];
        const GREY: &[[u8; 3]] = &[[245, 245, 245], [28, 30, 34]];
        const DIVERGING: &[[u8; 3]] =
            &[[33, 102, 172], [146, 197, 222], [247, 247, 247], [244, 165, 130], [178, 24, 43]];
        let stops = match self {
            Self::Heat => HEAT,
            Self::Grey => GREY,
            Self::Diverging => DIVERGING,
        };
        let position = value.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
        // The cast turns NaN into 0.
        let index = (position as usize).min(stops.len() - 2);
        mix(stops[index], stops[index + 1], position - index as f64)
    }
}

/// Interpolates from `a` (at 0) to `b` (at 1).
pub fn mix(a: [u8; 3], b: [u8; 3], fraction: f64) -> [u8; 3] {
    let lane = |i: usize| f64::from(a[i]) + (f64::from(b[i]) - f64::from(a[i])) * fraction;
    [0, 1, 2].map(|i| lane(i).round() as u8)
}
