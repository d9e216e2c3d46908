//! The ways to move an orbit camera.

use glam::{DQuat, DVec3};
use sdfc_render::{Bounds, Pose};

use super::{DISTANCE_RANGE, OrbitCamera};

/// The smallest angle between the direction and `up`, in radians.
const MIN_POLE_ANGLE: f64 = 0.01;
/// The angle in radians for a drag over the height of the picture.
const RADIANS_PER_HEIGHT: f64 = std::f64::consts::PI;

/// A side of the scene to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The camera looks along -z.
    Front,
    /// The camera looks along +z.
    Back,
    /// The camera looks along -x.
    Right,
    /// The camera looks along +x.
    Left,
    /// The camera looks along -y.
    Top,
    /// The camera looks along +y.
    Bottom,
}

impl Side {
    /// The side behind what is seen from this one.
    pub fn opposite(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
            Self::Right => Self::Left,
            Self::Left => Self::Right,
            Self::Top => Self::Bottom,
            Self::Bottom => Self::Top,
        }
    }
}

impl OrbitCamera {
    /// Orbits around the pivot by a drag to the right and down, in heights of the picture. A planar
    /// picture follows the pointer instead.
    pub fn orbit(&mut self, right: f64, down: f64) {
        if self.planar {
            return self.pan(right, down);
        }
        let rotation = self.rotation(-right * RADIANS_PER_HEIGHT, -down * RADIANS_PER_HEIGHT);
        self.eye = self.pivot + rotation * (self.eye - self.pivot);
        self.rotate_direction(rotation);
    }

    /// Turns around its own position by a drag, in heights of the picture. A planar picture follows
    /// the pointer instead.
    pub fn look_around(&mut self, right: f64, down: f64) {
        if self.planar {
            return self.pan(right, down);
        }
        let rotation =
            self.rotation(-right * RADIANS_PER_HEIGHT / 2.0, -down * RADIANS_PER_HEIGHT / 2.0);
        self.pivot = self.eye + rotation * (self.pivot - self.eye);
        self.rotate_direction(rotation);
    }

    /// Moves sideways by a drag, in heights of the picture. Points at the pivot's depth follow the
    /// pointer.
    pub fn pan(&mut self, right: f64, down: f64) {
        let [x, y, _] = self.pose().basis();
        let height = 2.0 * self.half_height_at_pivot();
        self.shift(y * (down * height) - x * (right * height));
    }

    /// Multiplies the distance to the pivot by `factor`, which zooms in below 1. The point under
    /// the pointer at the pivot's depth keeps its position in the picture. The pointer is given
    /// from the middle, right and up, in half heights of the picture.
    pub fn dolly(&mut self, factor: f64, [right, up]: [f64; 2]) {
        if !factor.is_finite() || factor <= 0.0 {
            return;
        }
        let distance = if self.parallel { self.half_height } else { self.depth() };
        let factor = factor.clamp(DISTANCE_RANGE[0] / distance, DISTANCE_RANGE[1] / distance);
        let [x, y, _] = self.pose().basis();
        let half = self.half_height_at_pivot();
        let aside = (x * right + y * up) * half;
        if self.parallel {
            self.half_height *= factor;
            self.shift(aside * (1.0 - factor));
        } else {
            let under = self.eye + self.forward * self.depth() + aside;
            self.eye = under + (self.eye - under) * factor;
            self.pivot = under + (self.pivot - under) * factor;
        }
    }

    /// Multiplies the distance to a point by `factor`, which zooms in below 1. The point keeps its
    /// position in the picture, and the camera never passes it.
    pub fn zoom_at(&mut self, point: DVec3, factor: f64) {
        let in_front = (point - self.eye).dot(self.forward);
        if !factor.is_finite() || factor <= 0.0 || !point.is_finite() || in_front <= 0.0 {
            return;
        }
        let distance = if self.parallel { self.half_height } else { in_front };
        let factor = factor.clamp(DISTANCE_RANGE[0] / distance, DISTANCE_RANGE[1] / distance);
        if self.parallel {
            let [x, y, _] = self.pose().basis();
            let aside = point - self.eye;
            self.half_height *= factor;
            self.shift((x * aside.dot(x) + y * aside.dot(y)) * (1.0 - factor));
        } else {
            self.eye = point + (self.eye - point) * factor;
            self.pivot = point + (self.pivot - point) * factor;
        }
    }

    /// Flies right, up and forward, in distances to the pivot.
    pub fn fly(&mut self, by: DVec3) {
        let [x, y, z] = self.pose().basis();
        let scale = if self.parallel { self.half_height } else { self.depth() };
        let forward = if self.planar { 0.0 } else { by.z };
        self.shift((x * by.x + y * by.y + z * forward) * scale);
    }

    /// Moves so that it sees all of the bounds, without turning.
    pub fn fit(&mut self, bounds: Option<Bounds>, aspect: f64) {
        let fitted = Pose::fitted_from(bounds, aspect, -self.forward, self.up);
        let distance = (fitted.target - fitted.eye).length();
        // The fitted distance is that of the fitted pose's field of view.
        let half = distance * fitted.half_height;
        self.pivot = fitted.target;
        if self.parallel {
            self.half_height = half;
            self.eye = self.pivot - self.forward * distance;
        } else {
            self.eye = self.pivot - self.forward * (half / self.half_height);
        }
    }

    /// Looks at the pivot from a side, at the same distance. A planar picture has no other side.
    pub fn look_from(&mut self, side: Side) {
        if self.planar {
            return;
        }
        self.up = DVec3::Y;
        self.forward = match side {
            Side::Front => DVec3::NEG_Z,
            Side::Back => DVec3::Z,
            Side::Right => DVec3::NEG_X,
            Side::Left => DVec3::X,
            // Slightly off the pole, where the horizon would be undefined.
            Side::Top => DVec3::new(0.0, -1.0, -MIN_POLE_ANGLE).normalize(),
            Side::Bottom => DVec3::new(0.0, 1.0, -MIN_POLE_ANGLE).normalize(),
        };
        let distance = (self.pivot - self.eye).length();
        self.eye = self.pivot - self.forward * distance;
    }

    fn shift(&mut self, by: DVec3) {
        if by.is_finite() {
            self.eye += by;
            self.pivot += by;
        }
    }

    /// A rotation around the picture's horizontal axis and then around `up`, kept off the poles.
    fn rotation(&self, yaw: f64, pitch: f64) -> DQuat {
        let angle = self.forward.angle_between(self.up);
        // Pitching up brings the direction nearer to `up`.
        let pitch =
            angle - (angle - pitch).clamp(MIN_POLE_ANGLE, std::f64::consts::PI - MIN_POLE_ANGLE);
        let [right, _, _] = self.pose().basis();
        DQuat::from_axis_angle(self.up, yaw) * DQuat::from_axis_angle(right, pitch)
    }

    fn rotate_direction(&mut self, rotation: DQuat) {
        self.forward = (rotation * self.forward).normalize_or(self.forward);
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{assert_near, camera, project};
    use super::*;

    #[test]
    fn orbiting_keeps_the_pivot_in_place_and_the_horizon_level() {
        let mut camera = camera();
        let aside = DVec3::new(0.5, 0.1, 0.7);
        camera.set_pivot(aside);
        let (before, distance) = (project(&camera, aside), (camera.pose().eye - aside).length());
        for (right, down) in [(0.3, 0.1), (-0.7, -0.4), (0.01, 0.9), (2.5, -3.0)] {
            camera.orbit(right, down);
            assert_near(project(&camera, aside), before);
            assert!(((camera.pose().eye - aside).length() - distance).abs() < 1e-9);
            let [x, y, _] = camera.pose().basis();
            assert!(x.y.abs() < 1e-9 && y.y > 0.0, "{x} {y}");
        }
    }

    #[test]
    fn dragging_right_moves_the_camera_left() {
        let mut camera = camera();
        let [right, _, _] = camera.pose().basis();
        let eye = camera.pose().eye;
        camera.orbit(0.1, 0.0);
        assert!((camera.pose().eye - eye).dot(right) < 0.0);
        let height = camera.pose().eye.y;
        camera.orbit(0.0, 0.1);
        assert!(camera.pose().eye.y > height);
    }

    #[test]
    fn panning_moves_the_pivot_with_the_pointer() {
        for parallel in [false, true] {
            let mut camera = camera();
            camera.set_parallel(parallel);
            let point = camera.pivot();
            camera.pan(0.25, -0.1);
            assert_near(project(&camera, point), [0.5, 0.2]);
        }
    }

    #[test]
    fn zooming_keeps_the_point_under_the_pointer() {
        for parallel in [false, true] {
            let mut camera = camera();
            camera.set_parallel(parallel);
            let pose = camera.pose();
            let [x, y, _] = pose.basis();
            let half =
                pose.half_height * if parallel { 1.0 } else { (pose.target - pose.eye).length() };
            let under = pose.target + (x * 0.6 + y * -0.3) * half;
            assert_near(project(&camera, under), [0.6, -0.3]);
            camera.dolly(0.5, [0.6, -0.3]);
            assert_near(project(&camera, under), [0.6, -0.3]);
            camera.dolly(1e300, [0.0, 0.0]);
            camera.dolly(f64::NAN, [0.0, 0.0]);
            camera.dolly(1e-300, [1.0, 1.0]);
            assert!(camera.pose().eye.is_finite() && camera.pose().half_height > 0.0);
        }
    }

    #[test]
    fn zooming_at_a_point_never_passes_it() {
        for parallel in [false, true] {
            let mut camera = camera();
            camera.set_parallel(parallel);
            // In front of the pivot, so that zooming at the pivot's depth would pass it.
            let point = camera.pose().eye + camera.forward * 2.0 + DVec3::new(0.2, 0.1, 0.0);
            let before = project(&camera, point);
            for _ in 0..100 {
                camera.zoom_at(point, 0.8);
                assert!((point - camera.pose().eye).dot(camera.forward) > 0.0);
            }
            let after = project(&camera, point);
            assert!((after[0] - before[0]).abs() < 1e-6 && (after[1] - before[1]).abs() < 1e-6);
            let at = camera.pose();
            camera.zoom_at(at.eye - camera.forward, 0.5);
            camera.zoom_at(point, f64::NAN);
            assert_eq!(camera.pose(), at);
        }
    }

    #[test]
    fn a_fitted_camera_sees_all_corners() {
        let bounds: Bounds = [[-1.0, -2.0, -0.5], [1.0, 0.5, 3.0]];
        for parallel in [false, true] {
            for aspect in [0.5, 1.0, 2.0] {
                let mut camera = camera();
                camera.set_parallel(parallel);
                camera.fit(Some(bounds), aspect);
                for corner in 0..8 {
                    let side = |axis: usize| bounds[(corner >> axis) & 1][axis];
                    let [x, y] = project(&camera, DVec3::new(side(0), side(1), side(2)));
                    assert!(x.abs() < aspect && y.abs() < 1.0, "{parallel} {aspect} {x} {y}");
                }
            }
        }
    }

    #[test]
    fn sides_look_along_their_axes() {
        let mut camera = camera();
        let distance = (camera.pivot() - camera.pose().eye).length();
        for (side, from) in [
            (Side::Front, DVec3::Z),
            (Side::Right, DVec3::X),
            (Side::Left, DVec3::NEG_X),
            (Side::Back, DVec3::NEG_Z),
        ] {
            camera.look_from(side);
            let expected = camera.pivot() + from * distance;
            assert!((camera.pose().eye - expected).length() < 1e-9, "{side:?}");
        }
        // From the top, x points right and z points down.
        camera.look_from(Side::Top);
        let [x, y, _] = camera.pose().basis();
        assert!(x.x > 0.99 && y.z < -0.99, "{x} {y}");
    }
}
