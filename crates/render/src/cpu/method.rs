//! The ray methods that the CPU has.

/// The ray methods that the CPU has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CpuMethod {
    /// Steps as long as the distance, up to an absolute tolerance.
    Sphere,
    /// Steps to where balls of free space just meet, up to a quarter of a pixel, then secants; or closing in on a sign change.
    Auto,
    /// Stretches of the ray are proven free or cut, the nearer part first, down to a part of the pixel.
    Interval,
}

impl CpuMethod {
    pub(crate) const ALL: [(&'static str, Self); 3] =
        [("auto", Self::Auto), ("sphere", Self::Sphere), ("interval", Self::Interval)];

    /// The names of all, the default first.
    pub(crate) const NAMES: [&'static str; Self::ALL.len()] =
        [Self::ALL[0].0, Self::ALL[1].0, Self::ALL[2].0];

    /// Returns the method of that name.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        let found = Self::ALL.into_iter().find(|(own, _)| *own == name);
        found.map(|(_, method)| method)
    }

    /// How many times the steps of the view a ray may take.
    pub(crate) fn step_budget_factor(self) -> u32 {
        match self {
            Self::Sphere | Self::Interval => 1,
            Self::Auto => 4,
        }
    }

    /// How many evaluations a sample is; `interval` counts those of stretches, to whose ends its samples belong.
    pub(crate) fn evaluations_per_sample(self) -> u32 {
        match self {
            Self::Sphere | Self::Auto => 1,
            Self::Interval => 0,
        }
    }

    /// Whether it asks what is known of rays before they are marched.
    pub(crate) fn pre_intersects(self) -> bool {
        match self {
            Self::Sphere | Self::Interval => false,
            Self::Auto => true,
        }
    }
}
