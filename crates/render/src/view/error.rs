//! Why a frame's settings make no picture.

use std::fmt;

use sdfc_march::MAX_LIGHTS;

/// A setting whose values make no picture. The values are those of this frame.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewError {
    /// The camera's eye and target are one point.
    EyeIsTarget([f64; 3]),
    /// The field of view, in radians, is not between 0 and half a turn.
    Fov(f64),
    /// A value is not a finite number; which.
    NotFinite(&'static str),
    /// A number that must be above 0 is not; which, and its value.
    NotPositive(&'static str, f64),
    /// A share is not within 0..1; which, and its value.
    NotShare(&'static str, f64),
    /// The direction of a light has no length.
    LightDirection,
    /// A spot light stands at its target.
    SpotIsTarget([f64; 3]),
    /// A spot light's angle, in radians, is not between 0 and a quarter of a turn.
    SpotAngle(f64),
    /// More lights than [`MAX_LIGHTS`].
    TooManyLights(usize),
}

impl fmt::Display for ViewError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EyeIsTarget(eye) => {
                write!(f, "the camera's eye and target are one point, {eye:?}: move one of them")
            }
            Self::Fov(fov) => write!(
                f,
                "the camera's field of view is {} degrees; it must lie between 0 and 180",
                fov.to_degrees()
            ),
            Self::NotFinite(what) => write!(f, "{what} is not a finite number"),
            Self::NotPositive(what, value) => write!(f, "{what} is {value}; it must be above 0"),
            Self::NotShare(what, value) => {
                write!(f, "{what} is {value}; it must lie between 0 and 1")
            }
            Self::LightDirection => f.write_str("a light's direction is [0, 0, 0]"),
            Self::SpotIsTarget(place) => {
                write!(f, "a spot light stands at its target, {place:?}: move one of them")
            }
            Self::SpotAngle(angle) => write!(
                f,
                "a spot light's angle is {} degrees; it must lie between 0 and 90",
                angle.to_degrees()
            ),
            Self::TooManyLights(count) => {
                write!(f, "the scene has {count} lights; at most {MAX_LIGHTS} are drawn")
            }
        }
    }
}

impl std::error::Error for ViewError {}
