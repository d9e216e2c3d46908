//! The lights of a frame as numbers.

use glam::DVec3;
use sdfc_graph::{Light, LightSource, NodeId, Settings, Shadow};
use sdfc_march::{LightBlock, MAX_LIGHTS, POINT, SHADOW_HARD, SHADOW_OFF, SHADOW_SOFT, SPOT, SUN};

use super::error::ViewError;
use super::values::{finite, positive};

/// The outer fraction of a spot light's angle over which its light falls off.
const RIM: f64 = 0.15;

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewLight {
    /// The source of the light.
    pub source: ViewSource,
    /// Linear colour times strength; for a light with a position, as received at distance 1.
    pub color: DVec3,
    /// The shadow that it casts.
    pub shadow: ViewShadow,
}

/// The source of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ViewSource {
    /// From infinitely far away: a unit vector towards it.
    Sun(DVec3),
    /// From a position, in all directions.
    Point(DVec3),
    /// From a position, in a cone.
    Spot {
        /// The position.
        position: DVec3,
        /// Unit vector along the middle of the cone.
        axis: DVec3,
        /// Cosines of two angles from the axis: full light within the first, none outside the
        /// second.
        rim: [f64; 2],
    },
}

/// The shadow that a light casts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ViewShadow {
    /// None.
    #[default]
    Off,
    /// A shadow with a sharp edge.
    Hard,
    /// A shadow with a penumbra: its edge fades over the inverse of this number.
    Soft(f64),
}

impl ViewLight {
    /// The light as the shader reads it.
    pub(super) fn block(&self) -> LightBlock {
        let single = |vector: DVec3| vector.as_vec3().to_array();
        let color = single(self.color);
        let (shadow, sharpness) = match self.shadow {
            ViewShadow::Off => (SHADOW_OFF, 0.0),
            ViewShadow::Hard => (SHADOW_HARD, 0.0),
            ViewShadow::Soft(sharpness) => (SHADOW_SOFT, sharpness as f32),
        };
        let any = LightBlock { color, shadow, sharpness, ..LightBlock::default() };
        match self.source {
            ViewSource::Sun(direction) => {
                LightBlock { position: single(direction), kind: SUN, ..any }
            }
            ViewSource::Point(position) => {
                LightBlock { position: single(position), kind: POINT, ..any }
            }
            ViewSource::Spot { position, axis, rim } => LightBlock {
                position: single(position),
                kind: SPOT,
                axis: single(axis),
                rim: rim.map(|cosine| cosine as f32),
                ..any
            },
        }
    }
}

/// The scene's lights, or a white one at the camera if nothing lights it.
pub(super) fn lights(
    settings: &Settings,
    forward: DVec3,
    value: &dyn Fn(NodeId) -> [f64; 4],
) -> Result<Vec<ViewLight>, ViewError> {
    let lights = &settings.lights;
    if lights.len() > MAX_LIGHTS {
        return Err(ViewError::TooManyLights(lights.len()));
    }
    if settings.has_headlight() {
        let (source, shadow) = (ViewSource::Sun(-forward), ViewShadow::Off);
        return Ok(vec![ViewLight { source, color: DVec3::ONE, shadow }]);
    }
    lights.iter().map(|light| view_light(light, value)).collect()
}

fn view_light(light: &Light, value: &dyn Fn(NodeId) -> [f64; 4]) -> Result<ViewLight, ViewError> {
    Ok(ViewLight {
        source: source(&light.source, value)?,
        color: finite(value(light.color), "a light's colour")?,
        shadow: match light.shadow {
            Shadow::Off => ViewShadow::Off,
            Shadow::Hard => ViewShadow::Hard,
            Shadow::Soft(node) => {
                ViewShadow::Soft(positive(value(node), "a soft shadow's sharpness")?)
            }
        },
    })
}

fn source(
    source: &LightSource,
    value: &dyn Fn(NodeId) -> [f64; 4],
) -> Result<ViewSource, ViewError> {
    let position = |node| finite(value(node), "a light's position");
    match *source {
        LightSource::Sun { direction } => {
            let direction = finite(value(direction), "a light's direction")?;
            Ok(ViewSource::Sun(direction.try_normalize().ok_or(ViewError::LightDirection)?))
        }
        LightSource::Point { position: node } => Ok(ViewSource::Point(position(node)?)),
        LightSource::Spot { position: node, target, angle } => {
            let position = position(node)?;
            let target = finite(value(target), "a spot light's target")?;
            let nowhere = || ViewError::SpotIsTarget(position.to_array());
            let axis = (target - position).try_normalize().ok_or_else(nowhere)?;
            let angle = value(angle)[0];
            if !(angle > 0.0 && angle < std::f64::consts::FRAC_PI_2) {
                return Err(ViewError::SpotAngle(angle));
            }
            let rim = [((1.0 - RIM) * angle).cos(), angle.cos()];
            Ok(ViewSource::Spot { position, axis, rim })
        }
    }
}
