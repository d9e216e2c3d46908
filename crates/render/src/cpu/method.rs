//! The ray methods that the CPU has.

/// The ray methods that the CPU has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CpuMethod {
    /// Steps as long as the distance, up to an absolute tolerance.
    Sphere,
    /// Relaxed steps up to a fraction of a pixel, then secants; after a change of sign, false
    /// position.
    Auto,
    /// Ray segments are proven free or cut, the nearer part first, down to a fraction of a pixel.
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

    /// Factor of the view's step budget.
    pub(crate) fn step_budget_factor(self) -> u32 {
        match self {
            Self::Sphere | Self::Interval => 1,
            Self::Auto => 4,
        }
    }

    /// The number of evaluations that a sample counts; `interval` counts segments, and a sample is
    /// part of the segment that it ends.
    pub(crate) fn evaluations_per_sample(self) -> u32 {
        match self {
            Self::Sphere | Self::Auto => 1,
            Self::Interval => 0,
        }
    }

    /// Returns true if it asks for the analytic pre-intersection.
    pub(crate) fn pre_intersects(self) -> bool {
        match self {
            Self::Sphere | Self::Interval => false,
            Self::Auto => true,
        }
    }
}
