//! What the colours of a view mean.

/// What the colours mean.
#[derive(Clone, Debug, PartialEq)]
pub enum Legend {
    /// What they are.
    None,
    /// A scale from one number to another.
    Scale {
        /// What is measured.
        label: &'static str,
        /// The numbers at the ends.
        ends: [f64; 2],
        /// Which colours.
        ramp: Ramp,
    },
    /// Single colours.
    Keys(Vec<([u8; 3], String)>),
}

/// Colours for numbers from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ramp {
    /// From little to much.
    Heat,
    /// From near to far.
    Grey,
    /// About a middle.
    Balance,
}

impl Ramp {
    /// The colour of a number from 0 to 1.
    pub fn color(self, value: f64) -> [u8; 3] {
        // Evenly spaced samples: of viridis (Smith and van der Walt, CC0), of two greys, of a diverging scale.
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
        const BALANCE: &[[u8; 3]] =
            &[[33, 102, 172], [146, 197, 222], [247, 247, 247], [244, 165, 130], [178, 24, 43]];
        let stops = match self {
            Self::Heat => HEAT,
            Self::Grey => GREY,
            Self::Balance => BALANCE,
        };
        let place = value.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
        // NaN becomes 0 on the way.
        let index = (place as usize).min(stops.len() - 2);
        mix(stops[index], stops[index + 1], place - index as f64)
    }
}

/// So much of the way from one colour to another.
pub fn mix(a: [u8; 3], b: [u8; 3], share: f64) -> [u8; 3] {
    let lane = |i: usize| f64::from(a[i]) + (f64::from(b[i]) - f64::from(a[i])) * share;
    [0, 1, 2].map(|i| lane(i).round() as u8)
}
