//! The width of a pixel along its ray.

/// Half the width that a pixel sees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// Where rays start.
    pub radius: f64,
    /// What it gains per length.
    pub spread: f64,
}

impl Footprint {
    /// At a distance from where rays start.
    pub fn at(self, t: f64) -> f64 {
        self.radius + self.spread * t
    }
}
