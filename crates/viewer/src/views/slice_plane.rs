//! The plane of the view "Slice".

/// The plane on which the field is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlicePlane {
    /// The axis that the plane is perpendicular to, 0 to 2 for x to z.
    pub axis: usize,
    /// The plane's coordinate on that axis, in scene units.
    pub offset: f64,
    /// The distance between isolines, in scene units.
    pub spacing: f64,
    /// True if the plane is drawn over surfaces in front of it.
    pub on_top: bool,
}

impl Default for SlicePlane {
    fn default() -> Self {
        Self { axis: 2, offset: 0.0, spacing: 0.1, on_top: false }
    }
}
