//! The exposure of a frame, and its tone curve on the CPU.

use glam::DVec3;
use sdfc_graph::{Exposure, NodeId, Tone};

use super::error::ViewError;
use super::values::positive;

/// How light becomes the colours of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewExposure {
    /// Factor of all light.
    pub factor: f64,
    /// The tone curve.
    pub tone: Tone,
}

impl ViewExposure {
    /// The colour of some light.
    pub fn developed(self, light: DVec3) -> DVec3 {
        let light = light * self.factor;
        match self.tone {
            Tone::Clip => light,
            Tone::Neutral => neutral(light),
            Tone::Film => light.map(film),
        }
    }
}

pub(super) fn view_exposure(
    exposure: Exposure,
    value: &dyn Fn(NodeId) -> [f64; 4],
) -> Result<ViewExposure, ViewError> {
    let factor = exposure.factor.map(|node| positive(value(node), "the factor of the exposure"));
    Ok(ViewExposure { factor: factor.transpose()?.unwrap_or(1.0), tone: exposure.tone })
}

/// The PBR Neutral Tone Mapper of Khronos (2024): the reflection of dielectrics, 0.04, is taken
/// away; the brightest channel is compressed towards 1 from 0.76 on.
fn neutral(light: DVec3) -> DVec3 {
    const START: f64 = 0.76;
    const DESATURATION: f64 = 0.15;
    let lowest = light.min_element();
    let color = light - if lowest < 0.08 { lowest * (1.0 - 6.25 * lowest) } else { 0.04 };
    let peak = color.max_element();
    if peak < START {
        return color;
    }
    let room = 1.0 - START;
    let compressed = 1.0 - room * room / (peak - START + room);
    let kept = 1.0 / (DESATURATION * (peak - compressed) + 1.0);
    color * (compressed / peak) * kept + compressed * (1.0 - kept)
}

/// A fit to the curve of the Academy Color Encoding System (Narkowicz 2016), per channel.
fn film(light: f64) -> f64 {
    light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_neutral_curve_keeps_dark_colours_and_never_reaches_1() {
        let at = |light: f64| neutral(DVec3::splat(light)).x;
        assert!((at(0.5) - 0.46).abs() < 1e-12);
        assert!(at(0.8) < at(0.81) && at(3.0) < at(30.0) && at(30.0) < 1.0);
        let [below, above] = [at(0.8 - 1e-9), at(0.8 + 1e-9)];
        assert!((below - above).abs() < 1e-8, "the curve has no jump: {below}, {above}");
    }

    #[test]
    fn a_factor_brightens_before_the_curve() {
        let exposure = ViewExposure { factor: 4.0, tone: Tone::Clip };
        assert_eq!(exposure.developed(DVec3::splat(0.5)), DVec3::splat(2.0));
        let film = ViewExposure { factor: 1e6, tone: Tone::Film };
        assert!((film.developed(DVec3::ONE) - 1.03).abs().max_element() < 0.01);
        assert!(film.developed(DVec3::NAN).is_nan());
    }
}
