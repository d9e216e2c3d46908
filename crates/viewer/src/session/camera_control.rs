//! The camera of a session: the scene's own until it is moved by hand.

use std::sync::Arc;

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

    /// Resets the camera to the scene's own; without one, to a camera that sees the whole scene.
    pub fn reset_camera(&mut self) {
        (self.follows_scene, self.fitted) = (true, None);
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

    /// The camera that the scene states, or one that sees all of the scene as it was when the
    /// camera was last reset. So the camera rests while a scene without a camera is edited, and an
    /// edit that makes a part larger looks like that.
    fn scene_pose(&mut self) -> Option<Pose> {
        let model = Arc::clone(self.model.as_ref()?);
        let values = self.values(&model);
        if model.scene.program().settings.camera.is_some() {
            self.fitted = None;
            return model.scene.pose(&values, self.aspect()).ok();
        }
        let aspect = self.aspect();
        let now = || (Arc::clone(&model.scene), values);
        let (scene, values) = self.fitted.get_or_insert_with(now);
        scene.pose(values, aspect).ok()
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
