//! An orbit camera in f64.
//!
//! It has a position, a direction and a pivot, and orbits around the pivot. The direction is stored
//! separately, so the picture does not change when the pivot is set to another point. `up` is
//! fixed: the horizon stays level.

use glam::{DQuat, DVec3};
use sdfc_render::{Bounds, Pose};

/// The smallest angle between the direction and `up`, in radians.
const MIN_POLE_ANGLE: f64 = 0.01;
/// The angle in radians for a drag over the height of the picture.
const RADIANS_PER_HEIGHT: f64 = std::f64::consts::PI;
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

/// A camera as it is stored in the settings file.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CameraState {
    /// Its position.
    pub eye: [f64; 3],
    /// The point in the middle of the picture.
    pub target: [f64; 3],
    /// Upward direction.
    pub up: [f64; 3],
    /// The point it orbits around.
    pub pivot: [f64; 3],
    /// True for an orthographic projection.
    pub parallel: bool,
    /// Half the height of the picture in scene units: at distance 1, or anywhere if `parallel`.
    pub half_height: f64,
}

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

    /// The camera as it is stored.
    pub fn state(&self) -> CameraState {
        let Pose { eye, target, up, parallel, half_height } = self.pose();
        let [eye, target, up, pivot] = [eye, target, up, self.pivot].map(|it| it.to_array());
        CameraState { eye, target, up, pivot, parallel, half_height }
    }

    /// Restores a stored camera; `None` if the numbers are not a valid camera.
    pub fn from_state(state: &CameraState) -> Option<Self> {
        let [eye, target, up, pivot] =
            [state.eye, state.target, state.up, state.pivot].map(DVec3::from);
        let (parallel, half_height) = (state.parallel, state.half_height);
        let finite = [eye, target, up, pivot].into_iter().all(DVec3::is_finite);
        let level = (target - eye).cross(up).length_squared() > 0.0;
        let sized = half_height > 0.0 && half_height.is_finite();
        if !(finite && level && sized) {
            return None;
        }
        let mut camera = Self::new(&Pose { eye, target, up, parallel, half_height });
        camera.set_pivot(pivot);
        Some(camera)
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

    /// The `camera(...)` statement that gives this camera in a scene.
    pub fn text(&self) -> String {
        let pose = self.pose();
        let scale = (pose.target - pose.eye).length();
        let point = |v: DVec3| {
            let [x, y, z] = v.to_array().map(|lane| rounded(lane, scale));
            format!("[{x}, {y}, {z}]")
        };
        let up = if self.up.abs_diff_eq(DVec3::Y, 1e-9) {
            String::new()
        } else {
            format!("up: {}, ", point(self.up * scale).replace("-0,", "0,"))
        };
        let lens = match self.fov() {
            Some(fov) => format!("fov: {}deg", rounded(fov.to_degrees(), 10.0)),
            None => format!("height: {}", rounded(2.0 * self.half_height, self.half_height)),
        };
        format!("camera(eye: {}, target: {}, {up}{lens})", point(pose.eye), point(pose.target))
    }

    fn shift(&mut self, by: DVec3) {
        if by.is_finite() {
            self.eye += by;
            self.pivot += by;
        }
    }

    /// The pivot's distance along the direction.
    fn depth(&self) -> f64 {
        (self.pivot - self.eye).dot(self.forward).clamp(DISTANCE_RANGE[0], DISTANCE_RANGE[1])
    }

    fn half_height_at_pivot(&self) -> f64 {
        if self.parallel { self.half_height } else { self.half_height * self.depth() }
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

/// Rounds a number to five significant digits of `scale`, which is invisible at that scale.
fn rounded(value: f64, scale: f64) -> f64 {
    let digits = (4.0 - scale.abs().max(1e-9).log10().floor()).clamp(0.0, 12.0) as i32;
    let unit = 10f64.powi(digits);
    let rounded = (value * unit).round() / unit;
    // Turns -0 into 0.
    rounded + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> OrbitCamera {
        OrbitCamera::new(&Pose {
            eye: DVec3::new(4.0, 3.0, 5.0),
            target: DVec3::new(0.0, 0.2, 0.0),
            up: DVec3::Y,
            parallel: false,
            half_height: 0.3,
        })
    }

    /// A point's position in the picture: right and up from the middle, in half heights.
    fn project(camera: &OrbitCamera, point: DVec3) -> [f64; 2] {
        let pose = camera.pose();
        let [x, y, z] = pose.basis();
        let from_eye = point - pose.eye;
        let half = pose.half_height * if pose.parallel { 1.0 } else { from_eye.dot(z) };
        [from_eye.dot(x) / half, from_eye.dot(y) / half]
    }

    fn assert_near(a: [f64; 2], b: [f64; 2]) {
        assert!((a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9, "{a:?} is not {b:?}");
    }

    #[test]
    fn a_new_camera_has_the_given_pose() {
        let pose = camera().pose();
        assert!((pose.eye - DVec3::new(4.0, 3.0, 5.0)).length() < 1e-12);
        assert!((pose.target - DVec3::new(0.0, 0.2, 0.0)).length() < 1e-12);
    }

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

    #[test]
    fn the_camera_statement_gives_the_same_camera_in_a_scene() {
        let mut camera = camera();
        for step in 0..3 {
            camera.orbit(0.123 * f64::from(step), -0.07);
            camera.set_parallel(step == 2);
            let text = format!("sphere(1)\n{}", camera.text());
            let compiled = sdfc::Compiler::new().compile("a", &text);
            let scene = compiled.unwrap_or_else(|errors| panic!("{text}: {errors}"));
            let frame = sdfc::FrameValues::defaults(scene.params());
            let pose = Pose::new(scene.program(), &frame, None, 1.5).unwrap();
            let own = camera.pose();
            assert!((pose.eye - own.eye).length() < 1e-3, "{text}");
            assert!((pose.target - own.target).length() < 1e-3, "{text}");
            assert_eq!(pose.parallel, own.parallel);
            assert!((pose.half_height / own.half_height - 1.0).abs() < 1e-3, "{text}");
        }
    }

    #[test]
    fn a_stored_camera_is_restored_and_invalid_numbers_are_refused() {
        let pose = Pose::fitted(Some([[-1.0; 3], [1.0; 3]]), 1.5);
        let mut camera = OrbitCamera::new(&pose);
        camera.orbit(0.3, 0.1);
        camera.pan(0.2, 0.1);
        let again = OrbitCamera::from_state(&camera.state()).unwrap();
        assert!((again.pose().eye - camera.pose().eye).length() < 1e-12);
        assert!((again.pivot() - camera.pivot()).length() < 1e-9);
        assert!((again.forward - camera.forward).length() < 1e-9);
        for invalid in [f64::NAN, 0.0, -1.0] {
            assert_eq!(
                OrbitCamera::from_state(&CameraState { half_height: invalid, ..camera.state() }),
                None
            );
        }
        assert_eq!(
            OrbitCamera::from_state(&CameraState { half_height: 1.0, ..CameraState::default() }),
            None
        );
    }
}
