//! Shading in f64: the shader's model, implemented a second time from the papers.
//!
//! Surfaces with a material are an interface of microfacets over an evenly scattering layer. Angles
//! are taken from the normal; `alpha` is the squared roughness.
//!
//! - Slopes of the facets: Trowbridge and Reitz 1975 (GGX).
//! - Masking: Smith's, height-correlated, by the function Lambda of Heitz 2014.
//! - Fresnel: Schlick 1994.
//! - Ambient light: the fit of Karis 2014.

use glam::DVec3;

use super::surroundings::IncomingLight;

/// Linear colour of surfaces without a material.
const DEFAULT_COLOR: DVec3 = DVec3::splat(0.8);
/// Reflectance of a dielectric at normal incidence.
const DIELECTRIC: f64 = 0.04;
/// The highlight of a smoother surface would be narrower than a pixel.
const MIN_ROUGHNESS: f64 = 0.1;
/// Lower bound of cosines, for directions along the surface or, with an inexact normal, below it.
const MIN_COSINE: f64 = 1e-4;

/// The surface at a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Surface {
    /// Outward unit normal.
    pub(super) normal: DVec3,
    /// Unit vector back along the ray.
    pub(super) toward_eye: DVec3,
    /// Its material; `None` in a scene without materials.
    pub(super) paint: Option<Paint>,
}

/// A material whose colour is already mixed with the default one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Paint {
    color: DVec3,
    roughness: f64,
    metallic: f64,
    emission: DVec3,
    occlusion: f64,
}

impl Paint {
    /// Reads a material's fields in the order of `MaterialField::ALL`.
    pub(super) fn of_fields(fields: &[[f64; 4]]) -> Option<Self> {
        let [color, coverage, roughness, metallic, emission, occlusion] = *fields else {
            return None;
        };
        let [color, emission] = [color, emission].map(|[x, y, z, _]| DVec3::new(x, y, z));
        Some(Self {
            color: DEFAULT_COLOR + (color - DEFAULT_COLOR) * coverage[0],
            roughness: roughness[0].clamp(MIN_ROUGHNESS, 1.0),
            metallic: metallic[0],
            emission,
            occlusion: occlusion[0],
        })
    }

    /// The material as a mirror of some roughness shows it.
    pub(super) fn roughened(self, roughness: f64) -> Self {
        Self { roughness: self.roughness.max(roughness), ..self }
    }
}

impl Surface {
    /// A surface with the normal along the gradient, or towards the eye if the field has no slope.
    /// It has no material yet.
    pub(super) fn new(gradient: DVec3, toward_eye: DVec3) -> Self {
        let square = gradient.length_squared();
        let normal = if square > 0.0 { gradient / square.sqrt() } else { toward_eye };
        Self { normal, toward_eye, paint: None }
    }

    /// The light that the surface emits, and the ambient light that it reflects.
    pub(super) fn ambient(&self, ambient: DVec3) -> DVec3 {
        match self.paint {
            Some(paint) => {
                let returned = paint.albedo_everywhere(self.facing());
                ambient * returned * paint.occlusion.max(0.0) + paint.emission
            }
            None => ambient * DEFAULT_COLOR,
        }
    }

    /// The light that the surface emits, and the light of the surroundings that it reflects: that
    /// of a matt white surface, and that which a mirror of its roughness receives. A reflected ray,
    /// if one follows, brings [`Self::mirrored_fraction`], so only the rest is added here. `open`
    /// is the unoccluded fraction.
    pub(super) fn reflected_environment(
        &self,
        irradiance: DVec3,
        radiance: DVec3,
        ray_follows: bool,
        open: f64,
    ) -> DVec3 {
        match self.paint {
            Some(paint) => {
                let share = if ray_follows { paint.roughness } else { 1.0 };
                let mirrored = paint.specular(self.facing()) * radiance * share;
                let scattered = paint.scattered(self.facing()) * irradiance;
                (mirrored + scattered) * open * paint.occlusion.max(0.0) + paint.emission
            }
            None => irradiance * open * DEFAULT_COLOR,
        }
    }

    /// The fraction of the light from the mirrored direction that the surface reflects as a mirror.
    pub(super) fn mirrored_fraction(&self) -> DVec3 {
        match self.paint {
            Some(paint) => paint.specular(self.facing()) * (1.0 - paint.roughness),
            None => DVec3::splat(schlick(DIELECTRIC, self.facing().min(1.0))),
        }
    }

    /// The roughness of the material; 0 without one.
    pub(super) fn roughness(&self) -> f64 {
        self.paint.map_or(0.0, |paint| paint.roughness)
    }

    /// What mirroring the sky adds to mirroring the ambient light, which is `sky` and `ambient`.
    pub(super) fn mirrored_sky(&self, sky: DVec3, ambient: DVec3) -> DVec3 {
        let occlusion = self.paint.map_or(0.0, |paint| paint.occlusion.max(0.0));
        self.mirrored_fraction() * (sky - ambient) * occlusion
    }

    /// The direction in which the surface mirrors the eye.
    pub(super) fn mirrored_direction(&self) -> DVec3 {
        self.normal * (2.0 * self.normal.dot(self.toward_eye)) - self.toward_eye
    }

    /// The light that the surface reflects from a light source: Lambert's law and, with a material,
    /// a highlight.
    pub(super) fn lit(&self, incoming: &IncomingLight) -> DVec3 {
        let incidence = self.normal.dot(incoming.direction).max(0.0);
        if incidence == 0.0 {
            return DVec3::ZERO;
        }
        let reflectance = match self.paint {
            // An occlusion below 0 keeps direct light away too.
            Some(paint) => {
                let open = (1.0 + paint.occlusion).clamp(0.0, 1.0);
                paint.reflectance(self, incoming.direction) * open
            }
            None => DEFAULT_COLOR,
        };
        incoming.color * incidence * reflectance
    }

    /// Cosine between the normal and the direction to the eye.
    fn facing(&self) -> f64 {
        self.normal.dot(self.toward_eye).max(MIN_COSINE)
    }
}

impl Paint {
    /// The responses of the metal and of the dielectric, mixed.
    fn mixed(&self, answer: impl Fn(DVec3, DVec3) -> DVec3) -> DVec3 {
        let dielectric = answer(DVec3::splat(DIELECTRIC), self.color);
        let metal = answer(self.color, DVec3::ZERO);
        dielectric + (metal - dielectric) * self.metallic
    }

    /// Pi times the bidirectional reflectance: the fraction of light from a direction that leaves
    /// towards the eye.
    fn reflectance(&self, surface: &Surface, toward_light: DVec3) -> DVec3 {
        let normal = surface.normal;
        let halfway = (toward_light + surface.toward_eye).normalize_or_zero();
        let [entering, leaving] = [normal.dot(toward_light), surface.facing()];
        let alpha = self.roughness.powi(2);
        let facets = density(alpha, normal.dot(halfway)) * visible(alpha, entering, leaving)
            / (4.0 * entering * leaving);
        let tilt = toward_light.dot(halfway).clamp(0.0, 1.0);
        let passed = (1.0 - schlick(DIELECTRIC, entering)) * (1.0 - schlick(DIELECTRIC, leaving));
        self.mixed(|mirrored, matt| {
            mirrored.map(|straight_on| schlick(straight_on, tilt) * facets) + matt * passed
        })
    }

    /// The fraction of uniform light that microfacets reflect towards the eye.
    fn specular(&self, facing: f64) -> DVec3 {
        let [scale, bias] = karis(self.roughness, facing);
        self.mixed(|color, _| color.map(|straight_on| (straight_on * scale + bias).max(0.0)))
    }

    /// The fraction of uniform light that the layer below scatters towards the eye.
    fn scattered(&self, facing: f64) -> DVec3 {
        let [scale, bias] = karis(self.roughness, facing);
        let lost = (DIELECTRIC * scale + bias).max(0.0);
        self.mixed(|_, matt| matt * (1.0 - lost))
    }

    /// The fraction of uniform ambient light that leaves towards the eye.
    fn albedo_everywhere(&self, facing: f64) -> DVec3 {
        self.specular(facing) + self.scattered(facing)
    }
}

/// Fresnel reflectance at an angle, from that at normal incidence.
fn schlick(straight_on: f64, cosine: f64) -> f64 {
    straight_on + (1.0 - straight_on) * (1.0 - cosine).powi(5)
}

/// Pi times the density of facets that face a direction.
fn density(alpha: f64, cosine: f64) -> f64 {
    let square = alpha * alpha;
    square / (cosine * cosine * (square - 1.0) + 1.0).powi(2)
}

/// The fraction of facets that both the light and the eye see.
fn visible(alpha: f64, entering: f64, leaving: f64) -> f64 {
    let lambda = |cosine: f64| {
        let tangent_squared = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
        ((1.0 + alpha * alpha * tangent_squared).sqrt() - 1.0) / 2.0
    };
    1.0 / (1.0 + lambda(entering) + lambda(leaving))
}

/// Scale and bias of the reflectance at normal incidence that give the reflected fraction of
/// ambient light.
fn karis(roughness: f64, facing: f64) -> [f64; 2] {
    let narrow = 1.0 - roughness;
    let low = 0.0425 - 0.0275 * roughness;
    let edge = low + narrow * (narrow * narrow).min((-9.28 * facing).exp2());
    [1.04 - 0.572 * roughness - 1.04 * edge, 0.022 * roughness - 0.04 + 1.04 * edge]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn incoming(direction: DVec3) -> IncomingLight {
        IncomingLight { direction, distance: None, color: DVec3::splat(2.0) }
    }

    #[test]
    fn a_surface_without_a_material_follows_lamberts_law() {
        let surface = Surface::new(DVec3::Y * 3.0, DVec3::Z);
        assert_eq!(surface.normal, DVec3::Y);
        let slanted = DVec3::new(0.0, 0.5, 0.75f64.sqrt());
        assert!((surface.lit(&incoming(slanted)) - 0.8).length() < 1e-6);
        assert_eq!(surface.lit(&incoming(-slanted)), DVec3::ZERO);
        assert!((surface.ambient(DVec3::ONE) - 0.8).length() < 1e-6);
    }

    #[test]
    fn a_field_without_slope_faces_the_eye() {
        assert_eq!(Surface::new(DVec3::ZERO, DVec3::Z).normal, DVec3::Z);
        assert_eq!(Surface::new(DVec3::NAN, DVec3::Z).normal, DVec3::Z);
    }

    #[test]
    fn a_rough_material_seen_and_lit_at_normal_incidence() {
        let one = |value: f64| [value, 0.0, 0.0, 0.0];
        let color = [1.0, 0.5, 0.0, 0.0];
        let fields = [color, one(1.0), one(1.0), one(0.0), [0.0, 0.0, 0.25, 0.0], one(0.5)];
        let paint = Paint::of_fields(&fields).unwrap();
        let surface = Surface { paint: Some(paint), ..Surface::new(DVec3::Z, DVec3::Z) };
        // Facets face everywhere and hide nothing, so 0.04 / 4 is mirrored; 0.96 squared of the
        // colour comes back through the interface; the light is 2.
        let expected = (color_vector(color) * 0.96 * 0.96 + 0.01) * 2.0;
        assert!((surface.lit(&incoming(DVec3::Z)) - expected).length() < 1e-12);
        // Occlusion halves the light from everywhere, not the emission.
        let [bright, dark] = [DVec3::ONE, DVec3::ZERO].map(|light| surface.ambient(light));
        assert_eq!(dark, DVec3::new(0.0, 0.0, 0.25));
        assert!((bright - dark - color_vector(color) / 2.0).abs().max_element() < 0.02);
    }

    fn color_vector([x, y, z, _]: [f64; 4]) -> DVec3 {
        DVec3::new(x, y, z)
    }

    fn paint(color: f64, roughness: f64, metallic: f64) -> Paint {
        let one = |value: f64| [value; 4];
        let fields = [one(color), one(1.0), one(roughness), one(metallic), [0.0; 4], one(1.0)];
        Paint::of_fields(&fields).unwrap()
    }

    #[test]
    fn fresnel_is_the_given_value_at_normal_incidence_and_1_along_the_surface() {
        assert_eq!(schlick(0.04, 1.0), 0.04);
        assert_eq!(schlick(0.04, 0.0), 1.0);
        assert!(schlick(0.04, 0.4) > schlick(0.04, 0.5));
    }

    /// The part of even light that leaves towards an eye at a cosine: the reflectance summed over
    /// directions of equal weight, taken over halfway vectors, where a highlight is not narrow.
    fn furnace(paint: &Paint, facing: f64) -> f64 {
        let toward_eye = DVec3::new((1.0 - facing * facing).sqrt(), 0.0, facing);
        let surface = Surface { normal: DVec3::Z, toward_eye, paint: Some(*paint) };
        let alpha = paint.roughness.powi(2);
        const STEPS: usize = 200;
        let middle = |i: usize| (i as f64 + 0.5) / STEPS as f64;
        let mut sum = 0.0;
        for (u, v) in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (middle(i), middle(j)))) {
            // Half the samples by facets (Walter et al. 2007), half by Lambert's law, each weighed
            // by the sum of both densities.
            let turn = |cosine: f64| {
                let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
                let (y, x) = (std::f64::consts::TAU * v).sin_cos();
                DVec3::new(sine * x, sine * y, cosine)
            };
            let facet = turn(((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u)).sqrt());
            for light in [facet * 2.0 * facet.dot(toward_eye) - toward_eye, turn(u.sqrt())] {
                let halfway = (light + toward_eye).normalize();
                if light.z <= 0.0 {
                    continue;
                }
                let by_facet = density(alpha, halfway.z) * halfway.z
                    / (4.0 * halfway.dot(toward_eye)).max(1e-12);
                sum += surface.lit(&incoming(light)).x / 2.0 / (by_facet + light.z);
            }
        }
        sum / (STEPS * STEPS) as f64
    }

    #[test]
    fn no_material_returns_more_than_it_receives() {
        for roughness in [0.1, 0.3, 0.5, 0.7, 1.0] {
            for facing in [0.05, 0.2, 0.5, 0.8, 1.0] {
                let [metal, plastic, black] = [(1.0, 1.0), (1.0, 0.0), (0.0, 0.0)]
                    .map(|(color, metallic)| furnace(&paint(color, roughness, metallic), facing));
                let case = format!("roughness {roughness}, cosine {facing}");
                assert!(metal <= 1.005 && plastic <= 1.005, "{case}: {metal}, {plastic}");
                assert!(black < plastic && black > 0.0, "{case}: {black}");
                // A perfect mirror of facets loses only what is caught between them.
                assert!(roughness > 0.3 || metal > 0.9, "{case}: {metal}");
            }
        }
    }

    #[test]
    fn ambient_light_is_the_sum_of_light_from_each_direction() {
        for roughness in [0.1, 0.3, 0.5, 0.7, 1.0] {
            for facing in [0.3, 0.6, 1.0] {
                for (color, metallic) in [(1.0, 1.0), (0.5, 1.0), (0.8, 0.0), (0.0, 0.0)] {
                    let paint = paint(color, roughness, metallic);
                    let summed = furnace(&paint, facing);
                    let fitted = paint.albedo_everywhere(facing).x;
                    let case = format!("{color} {metallic} {roughness} {facing}");
                    assert!((summed - fitted).abs() < 0.2, "{case}: {summed}, {fitted}");
                    assert!(fitted <= 1.0, "{case}: {fitted}");
                }
            }
        }
    }

    #[test]
    fn a_half_covering_colour_lies_between_itself_and_the_default() {
        let one = |value: f64| [value, 0.0, 0.0, 0.0];
        let fields = [[0.0; 4], one(0.5), one(1.0), one(0.0), [0.0; 4], one(1.0)];
        let paint = Paint::of_fields(&fields).unwrap();
        assert!((paint.color - 0.4).length() < 1e-6);
        assert!(Paint::of_fields(&fields[..5]).is_none());
    }
}
