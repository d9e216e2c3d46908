//! Why a frame's settings make no picture.

use sdfc_march::MAX_LIGHTS;
use thiserror::Error;

/// A setting whose values make no picture. The values are those of this frame.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ViewError {
    /// The camera's eye and target are the same point.
    #[error("the camera's eye and target are one point, {0:?}: move one of them")]
    EyeIsTarget([f64; 3]),
    /// The field of view, in radians, is not between 0 and half a turn.
    #[error(
        "the camera's `fov` is {0} radians ({degrees} degrees); it must be above 0 and below pi \
         radians (180 degrees)", degrees = .0.to_degrees()
    )]
    Fov(f64),
    /// A value is not a finite number; contains its name.
    #[error("{0} is not a finite number")]
    NotFinite(&'static str),
    /// A number that must be greater than 0 is not; contains its name and value.
    #[error("{0} is {1}; it must be above 0")]
    NotPositive(&'static str, f64),
    /// A fraction is not within 0..1; contains its name and value.
    #[error("{0} is {1}; it must lie between 0 and 1")]
    NotShare(&'static str, f64),
    /// The direction of a light has no length.
    #[error("a light's direction is [0, 0, 0]")]
    LightDirection,
    /// The position of a spot light is its target.
    #[error("a spot light stands at its target, {0:?}: move one of them")]
    SpotIsTarget([f64; 3]),
    /// A spot light's angle, in radians, is not between 0 and a quarter of a turn.
    #[error("a spot light's angle is {} degrees; it must lie between 0 and 90", .0.to_degrees())]
    SpotAngle(f64),
    /// The scene has more lights than [`MAX_LIGHTS`].
    #[error("the scene has {0} lights; at most {MAX_LIGHTS} are drawn")]
    TooManyLights(usize),
}
