//! The limits of all rays of a picture.

use crate::cpu::method::CpuMethod;
use crate::cpu::ray::{Ray, Real};

/// The limits of all rays of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits<T> {
    pub(crate) method: CpuMethod,
    pub(crate) epsilon: T,
    pub(crate) steps: u32,
    /// True if rays record how narrowly they pass what they do not hit.
    pub(crate) records_clearance: bool,
    /// The clearance from which on all light passes.
    pub(crate) full_light: T,
    /// True if these rays end at their light, where the cone of a penumbra closes.
    pub(crate) ends_at_light: bool,
    /// True if a ray ends where something is not proven.
    pub(crate) ends_unproven: bool,
    /// True if a small value of the field may be far from the surface.
    pub(crate) is_loose: bool,
}

impl<T: Real> Limits<T> {
    /// The distance from the surface below which a point is a hit.
    pub(crate) fn tolerance(&self, ray: &Ray<T>, t: T) -> T {
        match self.method {
            CpuMethod::Sphere => self.epsilon,
            CpuMethod::Auto | CpuMethod::Interval => {
                let part = T::constant(2.0) * ray.tolerance * ray.footprint(t);
                part.max(ray.rounding(t))
            }
        }
    }
}
