//! An orbit camera as a statement of a scene.

use glam::DVec3;

use super::OrbitCamera;

impl OrbitCamera {
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
    use sdfc_render::Pose;

    use super::super::tests::camera;

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
}
