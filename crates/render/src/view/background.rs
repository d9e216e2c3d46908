//! The background, the fog and the ambient occlusion of a frame.

use glam::DVec3;
use sdfc_graph::{Fog, NodeId, Occlusion, Settings, Sky};

use super::error::ViewError;
use super::values::{finite, fraction, positive};

/// Radius of the occlusion in heights of the view where the camera looks, if the scene states none.
const DEFAULT_OCCLUSION: f64 = 1.0 / 12.0;

/// The background in linear colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// One colour.
    Plain(DVec3),
    /// A sky, whose colour depends on the direction.
    Sky {
        /// Straight up.
        zenith: DVec3,
        /// At the horizon.
        horizon: DVec3,
        /// Straight down.
        ground: DVec3,
    },
    /// The environment of the program's settings, a function of the direction.
    Environment,
}

/// Fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFog {
    /// Density: a fraction `exp(-density * t)` of a surface's light is left after a length t.
    pub density: f64,
    /// Linear colour of the fog; `None` takes that of the background.
    pub color: Option<DVec3>,
}

/// Ambient occlusion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewOcclusion {
    /// Distance up to which surfaces occlude ambient light.
    pub radius: f64,
    /// Strength, 0..1.
    pub strength: f64,
}

pub(super) fn background(
    settings: &Settings,
    value: &dyn Fn(NodeId) -> [f64; 4],
) -> Result<Background, ViewError> {
    if settings.environment.is_some() {
        return Ok(Background::Environment);
    }
    if let Some(Sky { zenith, horizon, ground }) = settings.sky {
        let [zenith, horizon, ground] = [zenith, horizon, ground.unwrap_or(horizon)]
            .map(|node| finite(value(node), "the sky's colour"));
        return Ok(Background::Sky { zenith: zenith?, horizon: horizon?, ground: ground? });
    }
    let color = settings.background.map(|node| finite(value(node), "the background colour"));
    Ok(Background::Plain(color.transpose()?.unwrap_or_default()))
}

pub(super) fn view_fog(fog: Fog, value: &dyn Fn(NodeId) -> [f64; 4]) -> Result<ViewFog, ViewError> {
    let density = value(fog.density)[0];
    if density < 0.0 {
        return Err(ViewError::NotPositive("the fog's density", density));
    }
    if !density.is_finite() {
        return Err(ViewError::NotFinite("the fog's density"));
    }
    let color = fog.color.map(|node| finite(value(node), "the fog's colour")).transpose()?;
    Ok(ViewFog { density, color })
}

/// The occlusion of a view whose height where the camera looks is `height`.
pub(super) fn view_occlusion(
    occlusion: Occlusion,
    height: f64,
    value: &dyn Fn(NodeId) -> [f64; 4],
) -> Result<ViewOcclusion, ViewError> {
    let radius =
        occlusion.radius.map(|node| positive(value(node), "the radius of ambient occlusion"));
    Ok(ViewOcclusion {
        radius: radius.transpose()?.unwrap_or(DEFAULT_OCCLUSION * height),
        strength: fraction(value(occlusion.strength), "the strength of ambient occlusion")?,
    })
}
