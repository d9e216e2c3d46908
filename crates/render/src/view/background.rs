//! The background, the fog and the ambient occlusion of a frame.

use glam::DVec3;
use sdfc_graph::{Fog, NodeId, Occlusion, Settings, Sky};

use super::error::ViewError;
use super::values::{finite, fraction, positive};

/// What is seen where nothing is met, in linear colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// One colour.
    Plain(DVec3),
    /// Colours by direction.
    Sky {
        /// Straight up.
        zenith: DVec3,
        /// At the horizon and below it.
        horizon: DVec3,
    },
}

/// What is far away fades.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFog {
    /// What is left of a surface's light after a length t is `exp(-density * t)`.
    pub density: f64,
    /// Linear colour that it fades to; none: what lies behind.
    pub color: Option<DVec3>,
}

/// How much of the light from everywhere reaches a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewOcclusion {
    /// What is farther away takes no light.
    pub radius: f64,
    /// By what part light is taken, 0..1.
    pub strength: f64,
}

pub(super) fn background(
    settings: &Settings,
    value: &dyn Fn(NodeId) -> [f64; 4],
) -> Result<Background, ViewError> {
    if let Some(Sky { zenith, horizon }) = settings.sky {
        let [zenith, horizon] =
            [zenith, horizon].map(|node| finite(value(node), "the sky's colour"));
        return Ok(Background::Sky { zenith: zenith?, horizon: horizon? });
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

pub(super) fn view_occlusion(
    occlusion: Occlusion,
    value: &dyn Fn(NodeId) -> [f64; 4],
) -> Result<ViewOcclusion, ViewError> {
    Ok(ViewOcclusion {
        radius: positive(value(occlusion.radius), "the radius of ambient occlusion")?,
        strength: fraction(value(occlusion.strength), "the strength of ambient occlusion")?,
    })
}
