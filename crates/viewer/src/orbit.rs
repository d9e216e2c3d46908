//! The camera as it is moved by hand, in f64.
//!
//! It has a place, a direction and a pivot; turning goes about the pivot, so that what one looks at stays
//! where it is when the pivot is set to another point. `up` is fixed: the horizon stays level.

use glam::{DQuat, DVec3};
use sdfc::render::{Bounds, Pose};

/// The nearest that the direction comes to `up`, in radians.
const POLE: f64 = 0.01;
/// Radians for a drag over the height of the picture.
const TURN: f64 = std::f64::consts::PI;
/// Nearest and farthest that the eye is from the pivot.
const REACH: [f64; 2] = [1e-6, 1e9];
/// Field of view of a camera that was never in perspective, the tangent of half of it.
const USUAL_HALF_HEIGHT: f64 = 0.363_970_234_266_202_4;

/// A camera that is moved by hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    eye: DVec3,
    /// A unit vector.
    forward: DVec3,
    /// A unit vector.
    up: DVec3,
    pivot: DVec3,
    parallel: bool,
    /// Half the height of the picture, at distance 1 unless rays are parallel.
    half_height: f64,
    /// The tangent of half the field of view to come back to.
    perspective: f64,
}

/// A camera as numbers, to be kept in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Kept {
    /// Where it stands.
    pub eye: [f64; 3],
    /// What is in the middle of the picture.
    pub target: [f64; 3],
    /// Upward direction.
    pub up: [f64; 3],
    /// What it turns about.
    pub pivot: [f64; 3],
    /// Whether rays are parallel.
    pub parallel: bool,
    /// Half the height of the picture, at distance 1 unless rays are parallel.
    pub half_height: f64,
}

/// A direction to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Along -z.
    Front,
    /// Along +z.
    Back,
    /// Along -x.
    Right,
    /// Along +x.
    Left,
    /// Along -y.
    Top,
    /// Along +y.
    Bottom,
}

impl Orbit {
    /// Starts as a scene says; the pivot is what is in the middle of the picture.
    pub fn new(pose: &Pose) -> Self {
        let [_, _, forward] = pose.basis();
        let perspective = if pose.parallel { USUAL_HALF_HEIGHT } else { pose.half_height };
        let up = pose.up.normalize_or(DVec3::Y);
        let (eye, pivot, parallel, half_height) =
            (pose.eye, pose.target, pose.parallel, pose.half_height);
        Self { eye, forward, up, pivot, parallel, half_height, perspective }
    }

    /// As numbers.
    pub fn kept(&self) -> Kept {
        let Pose { eye, target, up, parallel, half_height } = self.pose();
        let [eye, target, up, pivot] = [eye, target, up, self.pivot].map(|it| it.to_array());
        Kept { eye, target, up, pivot, parallel, half_height }
    }

    /// From numbers, unless they make no camera.
    pub fn of_kept(kept: &Kept) -> Option<Self> {
        let [eye, target, up, pivot] =
            [kept.eye, kept.target, kept.up, kept.pivot].map(DVec3::from);
        let (parallel, half_height) = (kept.parallel, kept.half_height);
        let finite = [eye, target, up, pivot].into_iter().all(DVec3::is_finite);
        let level = (target - eye).cross(up).length_squared() > 0.0;
        let sized = half_height > 0.0 && half_height.is_finite();
        if !(finite && level && sized) {
            return None;
        }
        let mut orbit = Self::new(&Pose { eye, target, up, parallel, half_height });
        orbit.set_pivot(pivot);
        Some(orbit)
    }

    /// Where it stands and how it looks.
    pub fn pose(&self) -> Pose {
        Pose {
            eye: self.eye,
            target: self.eye + self.forward * self.depth(),
            up: self.up,
            parallel: self.parallel,
            half_height: self.half_height,
        }
    }

    /// What it turns about.
    pub fn pivot(&self) -> DVec3 {
        self.pivot
    }

    /// Whether rays are parallel.
    pub fn is_parallel(&self) -> bool {
        self.parallel
    }

    /// Turns about the pivot: by a drag to the right and downwards, in heights of the picture.
    pub fn turn(&mut self, right: f64, down: f64) {
        let turn = self.turning(-right * TURN, -down * TURN);
        self.eye = self.pivot + turn * (self.eye - self.pivot);
        self.look(turn);
    }

    /// Turns about the eye.
    pub fn look_around(&mut self, right: f64, down: f64) {
        let turn = self.turning(-right * TURN / 2.0, -down * TURN / 2.0);
        self.pivot = self.eye + turn * (self.pivot - self.eye);
        self.look(turn);
    }

    /// Moves sideways by a drag, so that what is at the pivot's depth follows the pointer.
    pub fn pan(&mut self, right: f64, down: f64) {
        let [x, y, _] = self.pose().basis();
        let height = 2.0 * self.half_height_at_pivot();
        self.shift(y * (down * height) - x * (right * height));
    }

    /// Comes nearer (`factor` below 1) or goes away, so that what is under the pointer at the pivot's depth
    /// stays there. The pointer is given from the middle, to the right and upwards, in half heights.
    pub fn dolly(&mut self, factor: f64, [right, up]: [f64; 2]) {
        if !factor.is_finite() || factor <= 0.0 {
            return;
        }
        let reach = if self.parallel { self.half_height } else { self.depth() };
        let factor = factor.clamp(REACH[0] / reach, REACH[1] / reach);
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

    /// Flies: right, up and ahead, in distances to the pivot.
    pub fn fly(&mut self, by: DVec3) {
        let [x, y, z] = self.pose().basis();
        let scale = if self.parallel { self.half_height } else { self.depth() };
        self.shift((x * by.x + y * by.y + z * by.z) * scale);
    }

    /// Sees all of the bounds, from where it looks.
    pub fn frame(&mut self, bounds: Option<Bounds>, aspect: f64) {
        let fitted = Pose::fitted(bounds, aspect);
        let distance = (fitted.target - fitted.eye).length();
        // The fitted distance belongs to its own field of view.
        let half = distance * fitted.half_height;
        self.pivot = fitted.target;
        if self.parallel {
            self.half_height = half;
            self.eye = self.pivot - self.forward * distance;
        } else {
            self.eye = self.pivot - self.forward * (half / self.half_height);
        }
    }

    /// Looks at the pivot from a side, as far away as it is.
    pub fn look_from(&mut self, side: Side) {
        self.up = DVec3::Y;
        self.forward = match side {
            Side::Front => DVec3::NEG_Z,
            Side::Back => DVec3::Z,
            Side::Right => DVec3::NEG_X,
            Side::Left => DVec3::X,
            // A hair off the pole, so that the horizon and the way back are defined.
            Side::Top => DVec3::new(0.0, -1.0, -POLE).normalize(),
            Side::Bottom => DVec3::new(0.0, 1.0, -POLE).normalize(),
        };
        let distance = (self.pivot - self.eye).length();
        self.eye = self.pivot - self.forward * distance;
    }

    /// Turns about this point from now on.
    pub fn set_pivot(&mut self, point: DVec3) {
        if point.is_finite() && (point - self.eye).dot(self.forward) > REACH[0] {
            self.pivot = point;
        }
    }

    /// From perspective to parallel rays and back; what is at the pivot's depth keeps its size.
    pub fn set_parallel(&mut self, parallel: bool) {
        if parallel == self.parallel {
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

    /// The vertical field of view in radians; `None` where rays are parallel.
    pub fn fov(&self) -> Option<f64> {
        (!self.parallel).then(|| 2.0 * self.half_height.atan())
    }

    /// Sets the vertical field of view; what is at the pivot's depth keeps its size.
    pub fn set_fov(&mut self, radians: f64) {
        let half = (radians.clamp(0.02, 3.0) / 2.0).tan();
        if !self.parallel {
            let depth = self.depth();
            self.eye += self.forward * (depth - depth * self.half_height / half);
            self.half_height = half;
        }
        self.perspective = half;
    }

    /// The `camera(...)` that gives this picture in a scene.
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

    /// How far ahead the pivot is.
    fn depth(&self) -> f64 {
        (self.pivot - self.eye).dot(self.forward).clamp(REACH[0], REACH[1])
    }

    fn half_height_at_pivot(&self) -> f64 {
        if self.parallel { self.half_height } else { self.half_height * self.depth() }
    }

    /// A turn about `up` and then about the picture's horizontal, kept off the poles.
    fn turning(&self, yaw: f64, pitch: f64) -> DQuat {
        let angle = self.forward.angle_between(self.up);
        // Pitching up brings the direction nearer to `up`.
        let pitch = angle - (angle - pitch).clamp(POLE, std::f64::consts::PI - POLE);
        let [right, _, _] = self.pose().basis();
        DQuat::from_axis_angle(self.up, yaw) * DQuat::from_axis_angle(right, pitch)
    }

    fn look(&mut self, turn: DQuat) {
        self.forward = (turn * self.forward).normalize_or(self.forward);
    }
}

/// A number with so many digits that at this scale nothing is seen of the rounding.
fn rounded(value: f64, scale: f64) -> f64 {
    let digits = (4.0 - scale.abs().max(1e-9).log10().floor()).clamp(0.0, 12.0) as i32;
    let unit = 10f64.powi(digits);
    let rounded = (value * unit).round() / unit;
    // Not "-0".
    rounded + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit() -> Orbit {
        Orbit::new(&Pose {
            eye: DVec3::new(4.0, 3.0, 5.0),
            target: DVec3::new(0.0, 0.2, 0.0),
            up: DVec3::Y,
            parallel: false,
            half_height: 0.3,
        })
    }

    /// Where a point is in the picture: to the right and upwards, in half heights.
    fn seen(orbit: &Orbit, point: DVec3) -> [f64; 2] {
        let pose = orbit.pose();
        let [x, y, z] = pose.basis();
        let from_eye = point - pose.eye;
        let half = pose.half_height * if pose.parallel { 1.0 } else { from_eye.dot(z) };
        [from_eye.dot(x) / half, from_eye.dot(y) / half]
    }

    fn near(a: [f64; 2], b: [f64; 2]) {
        assert!((a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9, "{a:?} is not {b:?}");
    }

    #[test]
    fn it_starts_as_the_scene_says() {
        let pose = orbit().pose();
        assert!((pose.eye - DVec3::new(4.0, 3.0, 5.0)).length() < 1e-12);
        assert!((pose.target - DVec3::new(0.0, 0.2, 0.0)).length() < 1e-12);
    }

    #[test]
    fn a_turn_keeps_the_pivot_in_place_and_the_horizon_level() {
        let mut orbit = orbit();
        let aside = DVec3::new(0.5, 0.1, 0.7);
        orbit.set_pivot(aside);
        let (before, distance) = (seen(&orbit, aside), (orbit.pose().eye - aside).length());
        for (right, down) in [(0.3, 0.1), (-0.7, -0.4), (0.01, 0.9), (2.5, -3.0)] {
            orbit.turn(right, down);
            near(seen(&orbit, aside), before);
            assert!(((orbit.pose().eye - aside).length() - distance).abs() < 1e-9);
            let [x, y, _] = orbit.pose().basis();
            assert!(x.y.abs() < 1e-9 && y.y > 0.0, "{x} {y}");
        }
    }

    #[test]
    fn dragging_to_the_right_shows_what_is_on_the_left() {
        let mut orbit = orbit();
        let [right, _, _] = orbit.pose().basis();
        let eye = orbit.pose().eye;
        orbit.turn(0.1, 0.0);
        assert!((orbit.pose().eye - eye).dot(right) < 0.0);
        let height = orbit.pose().eye.y;
        orbit.turn(0.0, 0.1);
        assert!(orbit.pose().eye.y > height);
    }

    #[test]
    fn panning_moves_the_pivot_with_the_pointer() {
        for parallel in [false, true] {
            let mut orbit = orbit();
            orbit.set_parallel(parallel);
            let point = orbit.pivot();
            orbit.pan(0.25, -0.1);
            near(seen(&orbit, point), [0.5, 0.2]);
        }
    }

    #[test]
    fn a_dolly_keeps_what_is_under_the_pointer() {
        for parallel in [false, true] {
            let mut orbit = orbit();
            orbit.set_parallel(parallel);
            let pose = orbit.pose();
            let [x, y, _] = pose.basis();
            let half =
                pose.half_height * if parallel { 1.0 } else { (pose.target - pose.eye).length() };
            let under = pose.target + (x * 0.6 + y * -0.3) * half;
            near(seen(&orbit, under), [0.6, -0.3]);
            orbit.dolly(0.5, [0.6, -0.3]);
            near(seen(&orbit, under), [0.6, -0.3]);
            orbit.dolly(1e300, [0.0, 0.0]);
            orbit.dolly(f64::NAN, [0.0, 0.0]);
            orbit.dolly(1e-300, [1.0, 1.0]);
            assert!(orbit.pose().eye.is_finite() && orbit.pose().half_height > 0.0);
        }
    }

    #[test]
    fn parallel_rays_and_back_is_the_same_picture() {
        let mut orbit = orbit();
        let before = orbit.pose();
        let aside = orbit.pivot() + orbit.pose().basis()[1] * 0.4;
        let place = seen(&orbit, aside);
        orbit.set_parallel(true);
        near(seen(&orbit, aside), place);
        orbit.set_parallel(false);
        let after = orbit.pose();
        assert!((after.eye - before.eye).length() < 1e-9);
        assert_eq!(after.half_height, before.half_height);
    }

    #[test]
    fn framing_sees_all_corners() {
        let bounds: Bounds = [[-1.0, -2.0, -0.5], [1.0, 0.5, 3.0]];
        for parallel in [false, true] {
            for aspect in [0.5, 1.0, 2.0] {
                let mut orbit = orbit();
                orbit.set_parallel(parallel);
                orbit.frame(Some(bounds), aspect);
                for corner in 0..8 {
                    let side = |axis: usize| bounds[(corner >> axis) & 1][axis];
                    let [x, y] = seen(&orbit, DVec3::new(side(0), side(1), side(2)));
                    assert!(x.abs() < aspect && y.abs() < 1.0, "{parallel} {aspect} {x} {y}");
                }
            }
        }
    }

    #[test]
    fn sides_look_along_their_axes() {
        let mut orbit = orbit();
        let distance = (orbit.pivot() - orbit.pose().eye).length();
        for (side, from) in [
            (Side::Front, DVec3::Z),
            (Side::Right, DVec3::X),
            (Side::Left, DVec3::NEG_X),
            (Side::Back, DVec3::NEG_Z),
        ] {
            orbit.look_from(side);
            let expected = orbit.pivot() + from * distance;
            assert!((orbit.pose().eye - expected).length() < 1e-9, "{side:?}");
        }
        // Seen from above, x is to the right and z points downwards.
        orbit.look_from(Side::Top);
        let [x, y, _] = orbit.pose().basis();
        assert!(x.x > 0.99 && y.z < -0.99, "{x} {y}");
    }

    #[test]
    fn the_text_gives_the_same_camera_in_a_scene() {
        let mut orbit = orbit();
        for step in 0..3 {
            orbit.turn(0.123 * f64::from(step), -0.07);
            orbit.set_parallel(step == 2);
            let text = format!("sphere(1)\n{}", orbit.text());
            let compiled = sdfc::compile("a", &text);
            let scene =
                compiled.scene.unwrap_or_else(|| panic!("{text}: {:?}", compiled.diagnostics));
            let frame = sdfc::FrameValues::defaults(scene.params());
            let pose = Pose::new(scene.program(), &frame, None, 1.5).unwrap();
            let own = orbit.pose();
            assert!((pose.eye - own.eye).length() < 1e-3, "{text}");
            assert!((pose.target - own.target).length() < 1e-3, "{text}");
            assert_eq!(pose.parallel, own.parallel);
            assert!((pose.half_height / own.half_height - 1.0).abs() < 1e-3, "{text}");
        }
    }

    #[test]
    fn a_kept_camera_is_the_same_and_nonsense_is_none() {
        let pose = Pose::fitted(Some([[-1.0; 3], [1.0; 3]]), 1.5);
        let mut orbit = Orbit::new(&pose);
        orbit.turn(0.3, 0.1);
        orbit.pan(0.2, 0.1);
        let again = Orbit::of_kept(&orbit.kept()).unwrap();
        assert!((again.pose().eye - orbit.pose().eye).length() < 1e-12);
        assert!((again.pivot() - orbit.pivot()).length() < 1e-9);
        assert!((again.forward - orbit.forward).length() < 1e-9);
        for spoilt in [f64::NAN, 0.0, -1.0] {
            assert_eq!(Orbit::of_kept(&Kept { half_height: spoilt, ..orbit.kept() }), None);
        }
        assert_eq!(Orbit::of_kept(&Kept { half_height: 1.0, ..Kept::default() }), None);
    }
}
