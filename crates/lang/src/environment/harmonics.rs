//! The light that matt surfaces receive, as nine coefficients.
//!
//! R. Ramamoorthi, P. Hanrahan, An efficient representation for irradiance environment maps
//! (SIGGRAPH 2001): the cosine of the angle of incidence blurs the surroundings so much that the
//! spherical harmonics up to degree 2 are enough. Their products with the cosine's coefficients pi,
//! 2 pi / 3 and pi / 4 are the irradiance.

use super::octahedron::{Octahedron, Vector};

/// Linear colours, one for each function of the basis.
pub type Coefficients = [[f64; 3]; 9];

/// The spherical harmonics up to degree 2 at a direction, without their constant factors.
pub fn basis([x, y, z]: [f64; 3]) -> [f64; 9] {
    [1.0, x, y, z, x * y, y * z, x * z, x * x - y * y, 3.0 * z * z - 1.0]
}

/// The squares of the constant factors, times the coefficient of the cosine over pi.
fn factors() -> [f64; 9] {
    let quarter_over_pi = 0.25 / std::f64::consts::PI;
    let [degree_0, degree_1, degree_2] = [1.0, 2.0, 15.0 / 4.0].map(|it| it * quarter_over_pi);
    let [d0, d1, d2] = [degree_0, degree_1, degree_2];
    [d0, d1, d1, d1, d2, d2, d2, d2 / 4.0, d2 / 12.0]
}

/// The coefficients of the irradiance over pi: with the light 1 from everywhere it is 1.
pub fn irradiance(map: &Octahedron) -> Coefficients {
    let mut sums = [[0.0; 3]; 9];
    for (direction, solid_angle, light) in map.weighted() {
        for (sum, value) in sums.iter_mut().zip(basis(direction.map(f64::from))) {
            for (sum, lane) in sum.iter_mut().zip(light) {
                *sum += solid_angle * value * f64::from(lane);
            }
        }
    }
    for (sum, factor) in sums.iter_mut().zip(factors()) {
        *sum = sum.map(|sum| sum * factor);
    }
    sums
}

/// The irradiance over pi at a normal.
pub fn irradiance_at(coefficients: &Coefficients, normal: Vector) -> [f64; 3] {
    let basis = basis(normal.map(f64::from));
    [0, 1, 2].map(|lane| {
        let terms = coefficients.iter().zip(basis);
        terms.map(|(coefficient, value)| coefficient[lane] * value).sum()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean of the light over the hemisphere, weighted by the cosine.
    fn summed(map: &Octahedron, normal: Vector) -> f64 {
        let cosine = |to: Vector| (0..3).map(|lane| to[lane] * normal[lane]).sum::<f32>().max(0.0);
        let terms = map.weighted().map(|(to, solid_angle, light)| {
            solid_angle * f64::from(cosine(to)) * f64::from(light[0])
        });
        terms.sum::<f64>() / std::f64::consts::PI
    }

    fn normals() -> impl Iterator<Item = Vector> {
        (0..100).map(|index| {
            let y = index as f32 / 50.0 - 0.99;
            let radius = (1.0 - y * y).sqrt();
            let angle = index as f32 * 2.4;
            [radius * angle.cos(), y, radius * angle.sin()]
        })
    }

    #[test]
    fn even_light_lights_evenly() {
        let coefficients = irradiance(&Octahedron::of(65, |_| [1.0, 2.0, 3.0]));
        for normal in normals() {
            let found = irradiance_at(&coefficients, normal);
            assert!((0..3).all(|lane| (found[lane] - (lane + 1) as f64).abs() < 1e-3), "{found:?}");
        }
    }

    #[test]
    fn polynomials_of_degree_2_are_exact() {
        let map = Octahedron::of(129, |[x, y, z]| [2.0 + x - 0.5 * y + x * z - y * y + z * z; 3]);
        let coefficients = irradiance(&map);
        for normal in normals() {
            let [found, expected] = [irradiance_at(&coefficients, normal)[0], summed(&map, normal)];
            assert!((found - expected).abs() < 2e-3, "{normal:?}: {found} {expected}");
        }
    }

    #[test]
    fn a_lit_half_is_nearly_right() {
        let map = Octahedron::of(129, |[_, y, _]| [if y > 0.0 { 1.0 } else { 0.0 }; 3]);
        let coefficients = irradiance(&map);
        for normal in normals() {
            let [found, expected] = [irradiance_at(&coefficients, normal)[0], summed(&map, normal)];
            // The paper states 9 % at most for any surroundings, 1 % on average.
            assert!((found - expected).abs() < 0.03, "{normal:?}: {found} {expected}");
        }
    }
}
