//! Light on surfaces, in f64: the formulas of the shader's shading, written a second time.

use glam::DVec3;

use crate::ViewLight;

/// Linear colour of what nothing paints.
const UNPAINTED: DVec3 = DVec3::splat(0.8);
/// Reflectance of a dielectric seen straight on.
const DIELECTRIC: f64 = 0.04;
/// The lobe of a smoother surface would be thinner than a pixel.
const LEAST_ROUGHNESS: f64 = 0.1;

/// Where a ray met something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Surface {
    /// Unit vector outwards.
    pub(super) normal: DVec3,
    /// Unit vector back along the ray.
    pub(super) toward_eye: DVec3,
    /// What it is made of; `None` in a scene that paints nothing.
    pub(super) paint: Option<Paint>,
}

/// A material, its colour already mixed with that of unpainted surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Paint {
    color: DVec3,
    roughness: f64,
    metallic: f64,
    emission: DVec3,
    occlusion: f64,
}

impl Paint {
    /// From the fields of a material in the order of `MaterialField::ALL`.
    pub(super) fn of_fields(fields: &[[f64; 4]]) -> Option<Self> {
        let [color, coverage, roughness, metallic, emission, occlusion] = *fields else {
            return None;
        };
        let [color, emission] = [color, emission].map(|[x, y, z, _]| DVec3::new(x, y, z));
        Some(Self {
            color: UNPAINTED + (color - UNPAINTED) * coverage[0],
            roughness: roughness[0],
            metallic: metallic[0],
            emission,
            occlusion: occlusion[0],
        })
    }
}

impl Surface {
    /// With the normal along the gradient; towards the eye where the field has no slope.
    pub(super) fn new(gradient: DVec3, toward_eye: DVec3, paint: Option<Paint>) -> Self {
        let square = gradient.length_squared();
        let normal = if square > 0.0 { gradient / square.sqrt() } else { toward_eye };
        Self { normal, toward_eye, paint }
    }

    /// What it gives off, and returns of the light from everywhere.
    pub(super) fn ambient(&self, ambient: DVec3) -> DVec3 {
        match self.paint {
            Some(paint) => ambient * paint.color * paint.occlusion + paint.emission,
            None => ambient * UNPAINTED,
        }
    }

    /// What it returns of a lamp's light: Lambert's law for the matt part and, where painted, a
    /// normalised Blinn-Phong lobe of exponent `2 / roughness^4 - 2` for the mirroring part.
    pub(super) fn lit(&self, light: &ViewLight) -> DVec3 {
        let incidence = self.normal.dot(light.direction).max(0.0);
        let albedo = match self.paint {
            Some(paint) => paint.albedo(self, light),
            None => UNPAINTED,
        };
        light.color * incidence * albedo
    }
}

impl Paint {
    fn albedo(&self, surface: &Surface, light: &ViewLight) -> DVec3 {
        let halfway = (light.direction + surface.toward_eye).normalize_or_zero();
        let aligned = surface.normal.dot(halfway).max(1e-4);
        let exponent = 2.0 / self.roughness.clamp(LEAST_ROUGHNESS, 1.0).powi(4) - 2.0;
        let lobe = (exponent + 8.0) / 8.0 * aligned.powf(exponent);
        let dielectric = DVec3::splat(DIELECTRIC);
        let mirrored = dielectric + (self.color - dielectric) * self.metallic;
        self.color * (1.0 - self.metallic) + mirrored * lobe
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lamp(direction: DVec3) -> ViewLight {
        ViewLight { direction, color: DVec3::splat(2.0), shadow: false }
    }

    #[test]
    fn an_unpainted_surface_follows_lamberts_law() {
        let surface = Surface::new(DVec3::Y * 3.0, DVec3::Z, None);
        assert_eq!(surface.normal, DVec3::Y);
        let slanted = DVec3::new(0.0, 0.5, 0.75f64.sqrt());
        assert!((surface.lit(&lamp(slanted)) - 0.8).length() < 1e-6);
        assert_eq!(surface.lit(&lamp(-slanted)), DVec3::ZERO);
        assert!((surface.ambient(DVec3::ONE) - 0.8).length() < 1e-6);
    }

    #[test]
    fn a_field_without_slope_faces_the_eye() {
        assert_eq!(Surface::new(DVec3::ZERO, DVec3::Z, None).normal, DVec3::Z);
        assert_eq!(Surface::new(DVec3::NAN, DVec3::Z, None).normal, DVec3::Z);
    }

    #[test]
    fn a_rough_material_seen_and_lit_straight_on() {
        let one = |value: f64| [value, 0.0, 0.0, 0.0];
        let color = [1.0, 0.5, 0.0, 0.0];
        let fields = [color, one(1.0), one(1.0), one(0.0), [0.0, 0.0, 0.25, 0.0], one(0.5)];
        let paint = Paint::of_fields(&fields).unwrap();
        let surface = Surface::new(DVec3::Z, DVec3::Z, Some(paint));
        // Exponent 0: the lobe is 1, so matt colour plus 0.04, times a light of 2.
        let expected = DVec3::new(2.08, 1.08, 0.08);
        assert!((surface.lit(&lamp(DVec3::Z)) - expected).length() < 1e-12);
        let ambient = surface.ambient(DVec3::ONE);
        assert!((ambient - DVec3::new(0.5, 0.25, 0.25)).length() < 1e-12);
    }

    #[test]
    fn half_covered_paint_lies_between_its_colour_and_unpainted() {
        let one = |value: f64| [value, 0.0, 0.0, 0.0];
        let fields = [[0.0; 4], one(0.5), one(1.0), one(0.0), [0.0; 4], one(1.0)];
        let paint = Paint::of_fields(&fields).unwrap();
        assert!((paint.color - 0.4).length() < 1e-6);
        assert!(Paint::of_fields(&fields[..5]).is_none());
    }
}
