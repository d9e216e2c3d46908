//! The width of a pixel along its ray.

/// The footprint of a camera ray: half the width of its pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// At the ray's origin.
    pub radius: f64,
    /// Growth per unit of length.
    pub spread: f64,
}

impl Footprint {
    /// The footprint at a distance from the ray's origin.
    pub fn at(self, t: f64) -> f64 {
        self.radius + self.spread * t
    }
}
