//! The surroundings of a surface: lights as it sees them, the background, and fog.

use glam::DVec3;

use crate::view::{Background, View, ViewFog, ViewLight, ViewShadow, ViewSource};

/// Lower bound of the distance to a light.
const MIN_DISTANCE: f64 = 1e-6;

/// A light as seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct IncomingLight {
    /// Unit vector towards it.
    pub(super) direction: DVec3,
    /// Distance to it; `None` for a sun.
    pub(super) distance: Option<f64>,
    /// Linear colour of what arrives.
    pub(super) color: DVec3,
}

impl IncomingLight {
    pub(super) fn seen_from(point: DVec3, light: &ViewLight) -> Self {
        match light.source {
            ViewSource::Sun(direction) => Self { direction, distance: None, color: light.color },
            ViewSource::Point(position) => Self::at(position, point, light.color),
            ViewSource::Spot { position, axis, rim: [inner, outer] } => {
                let incoming = Self::at(position, point, light.color);
                let cosine = -axis.dot(incoming.direction);
                let fraction = fade((cosine - outer) / (inner - outer));
                Self { color: incoming.color * fraction, ..incoming }
            }
        }
    }

    /// Light falls off with the square of the distance.
    fn at(position: DVec3, point: DVec3, color: DVec3) -> Self {
        let way = position - point;
        let distance = way.length().max(MIN_DISTANCE);
        Self {
            direction: way / distance,
            distance: Some(distance),
            color: color / (distance * distance),
        }
    }
}

/// The fraction of a light that a ray towards it lets through, if the ray hits nothing and has this
/// clearance.
pub(super) fn light_visibility(light: &ViewLight, clearance: f64) -> f64 {
    match light.shadow {
        ViewShadow::Off | ViewShadow::Hard => 1.0,
        ViewShadow::Soft(sharpness) => fade(sharpness * clearance),
    }
}

/// The background in a direction; black if it is an environment, which [`super::environment`]
/// evaluates.
pub(super) fn background_color(view: &View, direction: DVec3) -> DVec3 {
    match view.background {
        Background::Plain(color) => color,
        Background::Environment => DVec3::ZERO,
        Background::Sky { zenith, horizon, ground } => {
            let far = if direction.y < 0.0 { ground } else { zenith };
            far + (horizon - far) * (1.0 - direction.y.abs().min(1.0)).powi(3)
        }
    }
}

/// The fraction of a surface's light that is left after the fog.
pub(super) fn clear_fraction(view: &View, t: f64) -> f64 {
    view.fog.map_or(1.0, |ViewFog { density, color: _ }| (-density * t).exp())
}

/// The smoothstep function: from 0 to 1, flat at both ends.
fn fade(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
