//! Errors of a picture's normals on smooth surfaces.

use crate::oracle::Prober;

/// A surface whose normal turns by more than this within half a pixel has a crease or bends within
/// the pixel; no picture of that size shows its normal.
const SMOOTH_DEGREES: f64 = 5.0;

/// A normal that a picture shades with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normal {
    /// The point of the normal: the method's own hit, before its distance is rounded.
    pub point: [f64; 3],
    /// Outward direction, of any length.
    pub direction: [f64; 3],
}

/// Returns the angle in degrees between a picture's normal and the field's gradient in f64 at the
/// same point. `None` if the surface is not smooth within half the width of a pixel. A NaN normal
/// counts as 180 degrees.
pub(crate) fn normal_error(prober: &mut Prober<'_>, width: f64, normal: Normal) -> Option<f64> {
    let Normal { point, direction } = normal;
    let gradient = prober.gradient(point);
    let half = 0.5 * width;
    let is_smooth = (0..6).all(|side| {
        let mut beside = point;
        beside[side / 2] += if side % 2 == 0 { half } else { -half };
        // NaN is not smooth.
        degrees(prober.gradient(beside), gradient) <= SMOOTH_DEGREES
    });
    let error = degrees(direction, gradient);
    is_smooth.then_some(if error.is_nan() { 180.0 } else { error })
}

/// Returns the angle between two vectors in degrees, accurate for small angles too; NaN if one
/// vector is 0.
fn degrees(a: [f64; 3], b: [f64; 3]) -> f64 {
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot: f64 = a.iter().zip(b).map(|(x, y)| x * y).sum();
    let sine = cross.iter().map(|part| part * part).sum::<f64>().sqrt();
    if sine == 0.0 && dot == 0.0 { f64::NAN } else { sine.atan2(dot).to_degrees() }
}

#[cfg(test)]
mod tests {
    use super::degrees;

    #[test]
    fn angles_are_those_of_geometry() {
        assert_eq!(degrees([1.0, 0.0, 0.0], [0.0, 3.0, 0.0]), 90.0);
        assert_eq!(degrees([0.0, 0.0, 1.0], [0.0, 0.0, -2.0]), 180.0);
        assert!((degrees([1.0, 1e-9, 0.0], [1.0, 0.0, 0.0]) - 1e-9f64.to_degrees()).abs() < 1e-16);
        assert!(degrees([0.0; 3], [1.0, 0.0, 0.0]).is_nan());
    }
}
