//! How far a picture's normals are off, where the surface has one.

use crate::oracle::Prober;

/// A surface whose normal turns by more within half a pixel has a crease there, or bends within the pixel: no
/// picture of that size shows its normal.
const SMOOTH_DEGREES: f64 = 5.0;

/// A normal that a picture shades with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normal {
    /// Where it was taken. That is the ray's hit as the method itself has it, which it gives away as a distance, rounded.
    pub place: [f64; 3],
    /// Outward, of any length.
    pub direction: [f64; 3],
}

/// Degrees between the normal that a picture shows and the field's gradient at just the place where it was taken, in f64;
/// none where the surface is not smooth there, within half the width of a pixel. A normal that is no number is as wrong as can be.
pub(crate) fn normal_error(prober: &mut Prober<'_>, width: f64, normal: Normal) -> Option<f64> {
    let Normal { place, direction } = normal;
    let gradient = prober.gradient(place);
    let half = 0.5 * width;
    let is_smooth = (0..6).all(|side| {
        let mut beside = place;
        beside[side / 2] += if side % 2 == 0 { half } else { -half };
        // What is no number is not smooth.
        degrees(prober.gradient(beside), gradient) <= SMOOTH_DEGREES
    });
    let error = degrees(direction, gradient);
    is_smooth.then_some(if error.is_nan() { 180.0 } else { error })
}

/// The angle between two vectors, by a formula that is good for small angles too; NaN if one is 0.
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
