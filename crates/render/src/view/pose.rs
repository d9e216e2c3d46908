//! The pose of the camera: the scene's, or fitted to the bounds.

use glam::DVec3;
use sdfc_graph::{
    Camera, Lens, NodeId, Program,
    eval::{FrameValues, evaluate_frame},
};

use super::error::ViewError;
use super::values::{Bounds, finite, positive, value_of};

/// Direction from the middle of the bounds towards a fitted camera: from the right, above and in
/// front.
const FITTED_DIRECTION: DVec3 = DVec3::new(0.5, 0.45, 1.0);
/// The fraction of the picture's width and height that the corners of the bounds may fill.
const FITTED_FILL: f64 = 0.9;

/// The position and direction of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Origin of the rays.
    pub eye: DVec3,
    /// The point in the middle of the picture.
    pub target: DVec3,
    /// Upward direction, of any length.
    pub up: DVec3,
    /// True if rays are parallel.
    pub parallel: bool,
    /// Half the height of the picture: at distance 1, or at any distance if rays are parallel.
    pub half_height: f64,
}

impl Pose {
    /// Vertical field of view of a fitted camera, in radians.
    pub const FITTED_FOV: f64 = 40.0 * std::f64::consts::PI / 180.0;

    /// A camera with a vertical field of view `fov`, in radians. `up` has any length.
    ///
    /// # Errors
    ///
    /// [`ViewError::EyeIsTarget`]; [`ViewError::Fov`]: not above 0 and below pi;
    /// [`ViewError::NotFinite`].
    pub fn with_fov(
        eye: [f64; 3],
        target: [f64; 3],
        up: [f64; 3],
        fov: f64,
    ) -> Result<Self, ViewError> {
        if fov > 0.0 && fov < std::f64::consts::PI {
            Self::checked(eye, target, up, false, (fov / 2.0).tan())
        } else {
            Err(ViewError::Fov(fov))
        }
    }

    /// A camera with parallel rays, whose picture shows `height` scene units. `up` has any length.
    ///
    /// # Errors
    ///
    /// [`ViewError::EyeIsTarget`]; [`ViewError::NotPositive`]: the height is 0 or less;
    /// [`ViewError::NotFinite`].
    pub fn with_height(
        eye: [f64; 3],
        target: [f64; 3],
        up: [f64; 3],
        height: f64,
    ) -> Result<Self, ViewError> {
        Self::checked(eye, target, up, true, positive([height; 4], "the camera's height")? / 2.0)
    }

    fn checked(
        eye: [f64; 3],
        target: [f64; 3],
        up: [f64; 3],
        parallel: bool,
        half_height: f64,
    ) -> Result<Self, ViewError> {
        let finite = |[x, y, z]: [f64; 3], what| finite([x, y, z, 0.0], what);
        let eye = finite(eye, "the camera's eye")?;
        let target = finite(target, "the camera's target")?;
        let up = finite(up, "the camera's up")?;
        // Also for points that are too close for a direction.
        if (target - eye).try_normalize().is_none() {
            return Err(ViewError::EyeIsTarget(eye.to_array()));
        }
        Ok(Self { eye, target, up, parallel, half_height })
    }

    /// The scene's camera at a frame; without one, a camera fitted to the bounds, for a picture
    /// whose width is `aspect` times its height.
    ///
    /// # Errors
    ///
    /// [`ViewError`] if the camera's values make no picture.
    pub fn new(
        program: &Program,
        frame: &FrameValues,
        bounds: Option<Bounds>,
        aspect: f64,
    ) -> Result<Self, ViewError> {
        let settings = &program.settings;
        let nodes = settings.nodes();
        let values = evaluate_frame(&program.graph, &nodes, frame);
        let stated = settings
            .camera
            .map(|camera| Self::of_camera(&camera, &|id| value_of(&nodes, &values, id)));
        match stated.transpose()? {
            Some(camera) if program.is_planar() => Ok(camera.facing_the_plane()),
            Some(camera) => Ok(camera),
            None if program.is_planar() => Ok(Self::planar(bounds, aspect)),
            None => Ok(Self::fitted(bounds, aspect)),
        }
    }

    /// A camera straight in front of a planar picture, which sees the whole of the bounds with a
    /// margin; an unlimited side counts as long as the longest limited one.
    pub fn planar(bounds: Option<Bounds>, aspect: f64) -> Self {
        let [lo, hi] = limited(bounds);
        let half = (hi - lo) / 2.0;
        // A single point still needs some size.
        let half_height = half.y.max(half.x / aspect).max(1e-3) / FITTED_FILL;
        let target = (lo + hi) / 2.0;
        let pose = Self { eye: target, target, up: DVec3::Y, parallel: true, half_height };
        pose.facing_the_plane()
    }

    /// The camera moved to where it looks along -z at the plane z = 0 from a distance of 1, with
    /// parallel rays. What it shows at its target keeps its size.
    pub(super) fn facing_the_plane(self) -> Self {
        let (target, half_height) = (self.target.with_z(0.0), self.height_at_target() / 2.0);
        Self { eye: target + DVec3::Z, target, parallel: true, half_height, ..self }
    }

    /// The camera that the scene states.
    fn of_camera(camera: &Camera, value: &dyn Fn(NodeId) -> [f64; 4]) -> Result<Self, ViewError> {
        let point = |id| {
            let [x, y, z, _] = value(id);
            [x, y, z]
        };
        let (eye, target, up) = (point(camera.eye), point(camera.target), point(camera.up));
        match camera.lens {
            Lens::Fov(fov) => Self::with_fov(eye, target, up, value(fov)[0]),
            Lens::Height(height) => Self::with_height(eye, target, up, value(height)[0]),
        }
    }

    /// A camera that sees the whole of the bounds from the right, above and in front; an unlimited
    /// side counts as long as the longest limited one.
    pub fn fitted(bounds: Option<Bounds>, aspect: f64) -> Self {
        Self::fitted_from(bounds, aspect, FITTED_DIRECTION, DVec3::Y)
    }

    /// A camera that sees the whole of the bounds from a direction, of any length.
    pub fn fitted_from(bounds: Option<Bounds>, aspect: f64, toward_eye: DVec3, up: DVec3) -> Self {
        let [lo, hi] = limited(bounds);
        let target = (lo + hi) / 2.0;
        let half_height = (Self::FITTED_FOV / 2.0).tan();
        let toward_eye = toward_eye.normalize_or(DVec3::Z);
        let pose = Self { eye: target + toward_eye, target, up, parallel: false, half_height };
        let [x, y, z] = pose.basis();
        // Each corner is in the picture, at least this far away.
        let corners = (0..8).map(|index| {
            let end = |axis: usize| if index >> axis & 1 == 0 { lo[axis] } else { hi[axis] };
            DVec3::new(end(0), end(1), end(2)) - target
        });
        let away = corners.map(|corner| {
            let [width, height] =
                [aspect * half_height, half_height].map(|half| FITTED_FILL * half);
            (corner.dot(x).abs() / width).max(corner.dot(y).abs() / height) - corner.dot(z)
        });
        // A single point still needs some distance.
        let distance = away.fold(1e-3, f64::max);
        Self { eye: target + toward_eye * distance, ..pose }
    }

    /// Height of the view where the camera looks.
    pub fn height_at_target(&self) -> f64 {
        let distance = if self.parallel { 1.0 } else { (self.target - self.eye).length() };
        2.0 * self.half_height * distance
    }

    /// Unit vectors to the right, upwards and into the picture.
    pub fn basis(&self) -> [DVec3; 3] {
        let forward = (self.target - self.eye).normalize_or(DVec3::NEG_Z);
        // If the camera looks along `up`, what lies behind is at the bottom, as on a map. As z
        // points at the viewer of a scene, it is at the bottom of a view from above.
        let stand_in = if forward.z.abs() > 0.9 { DVec3::Y } else { DVec3::NEG_Z * -forward.y };
        let up = self.up.normalize_or_zero();
        let right = match forward.cross(up) {
            cross if cross.length() > 1e-6 => cross.normalize(),
            _ => forward.cross(stand_in).normalize_or(DVec3::X),
        };
        [right, right.cross(forward), forward]
    }
}

/// The box with each unlimited side replaced: centred on 0 if both ends are open, else on its one
/// end, and as long as the longest limited side (2 if there is none).
fn limited(bounds: Option<Bounds>) -> [DVec3; 2] {
    let [lo, hi] = bounds.unwrap_or([[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]]);
    let sides = [0, 1, 2].map(|axis| hi[axis] - lo[axis]);
    let longest = sides.into_iter().filter(|side| side.is_finite() && *side > 0.0);
    let half = longest.fold(0.0, f64::max) / 2.0;
    let half = if half > 0.0 { half } else { 1.0 };
    let [mut low, mut high] = [DVec3::ZERO; 2];
    for axis in 0..3 {
        let middle = match [lo[axis].is_finite(), hi[axis].is_finite()] {
            [true, true] if sides[axis] >= 0.0 => {
                (low[axis], high[axis]) = (lo[axis], hi[axis]);
                continue;
            }
            [true, false] => lo[axis],
            [false, true] => hi[axis],
            [true, true] | [false, false] => 0.0,
        };
        (low[axis], high[axis]) = (middle - half, middle + half);
    }
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: DVec3, b: [f64; 3]) {
        assert!((a - DVec3::from(b)).length() < 1e-12, "{a} is not {b:?}");
    }

    #[test]
    fn unlimited_sides_take_the_length_of_the_longest_limited_one() {
        let inf = f64::INFINITY;
        let [lo, hi] = limited(Some([[-inf, -inf, 1.0], [inf, 2.0, 5.0]]));
        close(lo, [-2.0, 0.0, 1.0]);
        close(hi, [2.0, 4.0, 5.0]);
        let [lo, hi] = limited(None);
        close(lo, [-1.0; 3]);
        close(hi, [1.0; 3]);
        // Nothing is inside an empty box.
        let [lo, hi] = limited(Some([[inf; 3], [-inf; 3]]));
        close(hi - lo, [2.0; 3]);
    }
}
