//! An orbit camera in f64.
//!
//! It has a position, a direction and a pivot, and orbits around the pivot. The direction is stored
//! separately, so the picture does not change when the pivot is set to another point. `up` is
//! fixed: the horizon stays level.

mod motion;
mod state;
mod statement;

use glam::DVec3;
use sdfc_render::Pose;

pub use motion::Side;
pub use state::CameraState;

/// The smallest and greatest distance of the eye from the pivot, in scene units.
const DISTANCE_RANGE: [f64; 2] = [1e-6, 1e9];
/// The tangent of half the field of view (40°) for a camera that was never in perspective.
const DEFAULT_HALF_HEIGHT: f64 = 0.363_970_234_266_202_4;

/// A camera that orbits around a pivot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitCamera {
    eye: DVec3,
    /// A unit vector.
    forward: DVec3,
    /// A unit vector.
    up: DVec3,
    pivot: DVec3,
    parallel: bool,
    /// Half the height of the picture in scene units: at distance 1, or anywhere if `parallel`.
    half_height: f64,
    /// The tangent of half the field of view of the last perspective projection.
    perspective: f64,
    /// True for a planar picture: the camera only pans and zooms.
    planar: bool,
}

impl OrbitCamera {
    /// A camera with the given pose; its pivot is the target.
    pub fn new(pose: &Pose) -> Self {
        let [_, _, forward] = pose.basis();
        let perspective = if pose.parallel { DEFAULT_HALF_HEIGHT } else { pose.half_height };
        let up = pose.up.normalize_or(DVec3::Y);
        let (eye, pivot, parallel, half_height) =
            (pose.eye, pose.target, pose.parallel, pose.half_height);
        Self { eye, forward, up, pivot, parallel, half_height, perspective, planar: false }
    }

    /// The pose.
    pub fn pose(&self) -> Pose {
        Pose {
            eye: self.eye,
            target: self.eye + self.forward * self.depth(),
            up: self.up,
            parallel: self.parallel,
            half_height: self.half_height,
        }
    }

    /// The point it orbits around.
    pub fn pivot(&self) -> DVec3 {
        self.pivot
    }

    /// Returns true for an orthographic projection.
    pub fn is_parallel(&self) -> bool {
        self.parallel
    }

    /// Looks at a planar picture from the front and stays there, or may turn again.
    pub fn set_planar(&mut self, planar: bool) {
        if planar && !self.planar {
            self.set_parallel(true);
            self.look_from(Side::Front);
            self.pivot.z = 0.0;
            self.eye = self.pivot + DVec3::Z;
        }
        self.planar = planar;
    }

    /// Orbits around this point from now on, if it is in front of the camera.
    pub fn set_pivot(&mut self, point: DVec3) {
        if point.is_finite() && (point - self.eye).dot(self.forward) > DISTANCE_RANGE[0] {
            self.pivot = point;
        }
    }

    /// Switches between perspective and orthographic projection. Points at the pivot's depth keep
    /// their size. A planar picture has no perspective.
    pub fn set_parallel(&mut self, parallel: bool) {
        if parallel == self.parallel || self.planar {
            return;
        }
        if parallel {
            self.perspective = self.half_height;
            self.half_height = self.half_height_at_pivot();
        } else {
            let distance = self.half_height / self.perspective;
            self.eye += self.forward * (self.depth() - distance);
            self.half_height = self.perspective;
        }
        self.parallel = parallel;
    }

    /// The vertical field of view in radians; `None` for an orthographic projection.
    pub fn fov(&self) -> Option<f64> {
        (!self.parallel).then(|| 2.0 * self.half_height.atan())
    }

    /// Sets the vertical field of view. Points at the pivot's depth keep their size.
    pub fn set_fov(&mut self, radians: f64) {
        let half = (radians.clamp(0.02, 3.0) / 2.0).tan();
        if !self.parallel {
            let depth = self.depth();
            self.eye += self.forward * (depth - depth * self.half_height / half);
            self.half_height = half;
        }
        self.perspective = half;
    }

    /// The pivot's distance along the direction.
    fn depth(&self) -> f64 {
        (self.pivot - self.eye).dot(self.forward).clamp(DISTANCE_RANGE[0], DISTANCE_RANGE[1])
    }

    fn half_height_at_pivot(&self) -> f64 {
        if self.parallel { self.half_height } else { self.half_height * self.depth() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn camera() -> OrbitCamera {
        OrbitCamera::new(&Pose {
            eye: DVec3::new(4.0, 3.0, 5.0),
            target: DVec3::new(0.0, 0.2, 0.0),
            up: DVec3::Y,
            parallel: false,
            half_height: 0.3,
        })
    }

    /// A point's position in the picture: right and up from the middle, in half heights.
    pub(super) fn project(camera: &OrbitCamera, point: DVec3) -> [f64; 2] {
        let pose = camera.pose();
        let [x, y, z] = pose.basis();
        let from_eye = point - pose.eye;
        let half = pose.half_height * if pose.parallel { 1.0 } else { from_eye.dot(z) };
        [from_eye.dot(x) / half, from_eye.dot(y) / half]
    }

    pub(super) fn assert_near(a: [f64; 2], b: [f64; 2]) {
        assert!((a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9, "{a:?} is not {b:?}");
    }

    #[test]
    fn a_new_camera_has_the_given_pose() {
        let pose = camera().pose();
        assert!((pose.eye - DVec3::new(4.0, 3.0, 5.0)).length() < 1e-12);
        assert!((pose.target - DVec3::new(0.0, 0.2, 0.0)).length() < 1e-12);
    }

    #[test]
    fn switching_the_projection_twice_gives_the_same_camera() {
        let mut camera = camera();
        let before = camera.pose();
        let aside = camera.pivot() + camera.pose().basis()[1] * 0.4;
        let position = project(&camera, aside);
        camera.set_parallel(true);
        assert_near(project(&camera, aside), position);
        camera.set_parallel(false);
        let after = camera.pose();
        assert!((after.eye - before.eye).length() < 1e-9);
        assert_eq!(after.half_height, before.half_height);
    }
}
