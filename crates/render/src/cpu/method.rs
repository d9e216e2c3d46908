//! The ray methods that the CPU has.

use sdfc_march::Method;

/// The ray methods that the CPU has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CpuMethod {
    /// Steps as long as the distance, up to an absolute tolerance.
    Sphere,
    /// Relaxed steps up to a fraction of a pixel, then secants; after a change of sign, false
    /// position.
    Auto,
    /// Ray segments are proven free or cut, the nearer part first, down to a fraction of a pixel;
    /// what is left when the steps for that are spent is sampled.
    Interval,
}

impl CpuMethod {
    /// The methods that the CPU has, the default first.
    pub(crate) const METHODS: [Method; 3] = [Method::Auto, Method::Sphere, Method::Interval];

    /// Returns the CPU's form of a method, or `None` if it has none.
    pub(crate) fn of(method: Method) -> Option<Self> {
        match method {
            Method::Auto => Some(Self::Auto),
            Method::Sphere => Some(Self::Sphere),
            Method::Interval => Some(Self::Interval),
            Method::Fixed
            | Method::SphereCone
            | Method::Relaxed
            | Method::Accelerated
            | Method::AutoRelaxed
            | Method::Segment
            | Method::Practical => None,
        }
    }

    /// Factor of the view's step budget.
    pub(crate) fn step_budget_factor(self) -> u32 {
        match self {
            Self::Sphere => 1,
            Self::Auto => 4,
            // One part for proofs, four for samples.
            Self::Interval => 5,
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

    /// Returns true if rays skip what is proven to hold no surface.
    pub(crate) fn skips_proven(self) -> bool {
        match self {
            Self::Sphere | Self::Auto => false,
            Self::Interval => true,
        }
    }

    /// Returns true if it asks for the analytic pre-intersection.
    pub(crate) fn pre_intersects(self) -> bool {
        match self {
            Self::Sphere => false,
            Self::Auto | Self::Interval => true,
        }
    }

    /// Returns true if it intersects copies analytically, a few at a time.
    pub(crate) fn intersects_copies(self) -> bool {
        match self {
            Self::Sphere | Self::Interval => false,
            Self::Auto => true,
        }
    }
}
