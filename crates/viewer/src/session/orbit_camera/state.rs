//! An orbit camera in the settings file.

use glam::DVec3;
use sdfc_render::Pose;

use super::OrbitCamera;

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

impl OrbitCamera {
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
}

#[cfg(test)]
mod tests {
    use super::*;

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
