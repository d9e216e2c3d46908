//! Values of settings at a frame, checked.

use glam::DVec3;
use sdfc_graph::NodeId;

use super::error::ViewError;

/// Lowest and highest corner of a box, in scene units; infinite where it is not limited.
pub type Bounds = [[f64; 3]; 2];

/// Width divided by height.
pub(super) fn aspect([width, height]: [u32; 2]) -> f64 {
    f64::from(width.max(1)) / f64::from(height.max(1))
}

/// The value of one of the settings' nodes.
pub(super) fn value_of(nodes: &[NodeId], values: &[[f64; 4]], id: NodeId) -> [f64; 4] {
    let found = nodes.iter().position(|node| *node == id);
    found.and_then(|index| values.get(index)).copied().unwrap_or([f64::NAN; 4])
}

pub(super) fn stated(value: Option<f64>, what: &'static str) -> Result<Option<f64>, ViewError> {
    match value {
        Some(value) if !value.is_finite() => Err(ViewError::NotFinite(what)),
        Some(value) if value <= 0.0 => Err(ViewError::NotPositive(what, value)),
        value => Ok(value),
    }
}

pub(super) fn fraction([value, ..]: [f64; 4], what: &'static str) -> Result<f64, ViewError> {
    if (0.0..=1.0).contains(&value) { Ok(value) } else { Err(ViewError::NotShare(what, value)) }
}

pub(super) fn positive([value, ..]: [f64; 4], what: &'static str) -> Result<f64, ViewError> {
    match value {
        value if !value.is_finite() => Err(ViewError::NotFinite(what)),
        value if value <= 0.0 => Err(ViewError::NotPositive(what, value)),
        value => Ok(value),
    }
}

pub(super) fn finite([x, y, z, _]: [f64; 4], what: &'static str) -> Result<DVec3, ViewError> {
    let vector = DVec3::new(x, y, z);
    if vector.is_finite() { Ok(vector) } else { Err(ViewError::NotFinite(what)) }
}
