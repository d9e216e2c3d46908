//! The camera of a session: the scene's own until it is moved by hand.

use sdfc_render::Pose;

use super::Session;
use crate::session::orbit_camera::{CameraState, OrbitCamera};

impl Session {
    /// The camera.
    pub fn camera(&self) -> Option<&OrbitCamera> {
        self.camera.as_ref()
    }

    /// Returns true while the camera is the scene's own.
    pub fn follows_scene(&self) -> bool {
        self.follows_scene
    }

    /// Moves the camera by hand; from then on it does not follow the scene's.
    pub fn move_camera(&mut self, change: impl FnOnce(&mut OrbitCamera)) {
        if let Some(camera) = &mut self.camera {
            change(camera);
            self.follows_scene = false;
        }
    }

    /// Resets the camera to the scene's own.
    pub fn reset_camera(&mut self) {
        self.follows_scene = true;
        self.follow_scene_camera();
    }

    /// Moves the camera so that it sees the whole scene, without turning it.
    pub fn fit_view(&mut self) {
        let Some(model) = &self.model else { return };
        let (values, aspect) = (self.values(model), self.aspect());
        let bounds = model.scene.focus_at(&values);
        self.move_camera(|camera| camera.fit(bounds, aspect));
    }

    /// The camera to store, if it was moved by hand.
    pub fn manual_camera(&self) -> Option<CameraState> {
        self.camera.filter(|_| !self.follows_scene).map(|camera| camera.state())
    }

    /// The pose of the camera, if it was moved by hand.
    pub fn manual_pose(&self) -> Option<Pose> {
        self.camera.filter(|_| !self.follows_scene).map(|camera| camera.pose())
    }

    /// The camera that the scene states, or one that sees all of it.
    fn scene_pose(&self) -> Option<Pose> {
        let model = self.model.as_ref()?;
        let values = self.values(model);
        model.scene.pose(&values, self.aspect()).ok()
    }

    /// Updates the camera from the scene unless it was moved by hand.
    pub(super) fn follow_scene_camera(&mut self) {
        if self.follows_scene
            && let Some(pose) = self.scene_pose()
        {
            self.camera = Some(OrbitCamera::new(&pose));
        }
    }

    fn aspect(&self) -> f64 {
        let [width, height] = self.size;
        f64::from(width) / f64::from(height)
    }
}
