//! The settings file: window size, theme, and the camera and params of recent scenes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::json_file;
use crate::session::orbit_camera::CameraState;

/// The most scenes that are stored.
const MAX_SCENES: usize = 40;
/// A larger file was not written by the viewer and is ignored.
const MAX_BYTES: u64 = 1 << 20;

/// All settings.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// True for the light theme.
    pub light: bool,
    /// True if a text is formatted when it is saved.
    pub format_on_save: bool,
    /// True if a drag with the middle button turns the camera, as in Blender.
    pub middle_turns: bool,
    /// Width and height of the window in points.
    pub window: Option<[f32; 2]>,
    /// Recent scenes, the last one first.
    pub scenes: Vec<SceneSettings>,
}

/// The settings of one scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SceneSettings {
    /// Its absolute path.
    pub path: String,
    /// The camera, if it was moved by hand.
    pub camera: Option<CameraState>,
    /// Changed params by name.
    pub params: BTreeMap<String, [f64; 4]>,
}

impl Settings {
    /// Reads a settings file. A missing or invalid file gives the defaults.
    pub fn read(path: &Path) -> Self {
        json_file::read(path, MAX_BYTES)
    }

    /// Writes a settings file. Errors are ignored: the settings are then lost.
    pub fn write(&self, path: &Path) {
        json_file::write(path, self);
    }

    /// The stored settings of a scene.
    pub fn scene(&self, path: &Path) -> Option<&SceneSettings> {
        let path = absolute(path)?;
        self.scenes.iter().find(|scene| scene.path == path)
    }

    /// Stores a scene as the most recent one.
    pub fn record(
        &mut self,
        path: &Path,
        camera: Option<CameraState>,
        params: BTreeMap<String, [f64; 4]>,
    ) {
        let Some(path) = absolute(path) else { return };
        self.scenes.retain(|scene| scene.path != path);
        self.scenes.insert(0, SceneSettings { path, camera, params });
        self.scenes.truncate(MAX_SCENES);
    }
}

/// An absolute path; `None` if it is not UTF-8, which JSON cannot store.
pub fn absolute(path: &Path) -> Option<String> {
    std::path::absolute(path).ok()?.to_str().map(str::to_owned)
}

/// The settings file of the user: `sdfc/view.json` in the system's folder for settings.
pub fn default_path() -> Option<PathBuf> {
    folder("XDG_CONFIG_HOME", ".config").map(|folder| folder.join("sdfc").join("view.json"))
}

/// The folder to which examples are copied when they are opened.
pub fn examples_folder() -> Option<PathBuf> {
    folder("XDG_DATA_HOME", ".local/share").map(|folder| folder.join("sdfc").join("examples"))
}

/// The folder that `variable` names, else `%APPDATA%`, else `below_home` in the home folder.
fn folder(variable: &str, below_home: &str) -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    let named = set(variable).or_else(|| set("APPDATA")).map(PathBuf::from);
    named
        .or_else(|| set("HOME").map(|home| Path::new(&home).join(below_home)))
        .filter(|folder| folder.is_absolute())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stored_settings_are_read_again_and_an_invalid_file_gives_the_defaults() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new").join("view.json");
        let mut settings = Settings { light: true, ..Settings::read(&path) };
        let camera =
            CameraState { eye: [1.0, 2.0, 1.0 / 3.0], half_height: 0.25, ..CameraState::default() };
        let params = BTreeMap::from([("r".to_owned(), [0.1 + 0.2, 0.0, 0.0, 0.0])]);
        for number in 0..50 {
            settings.record(Path::new(&format!("{number}.sdf")), Some(camera), params.clone());
        }
        settings.record(Path::new("48.sdf"), Some(camera), params);
        settings.write(&path);
        let again = Settings::read(&path);
        assert_eq!(again, settings);
        assert_eq!(again.scenes.len(), MAX_SCENES);
        assert!(
            again.scenes[0].path.ends_with("48.sdf") && again.scenes[1].path.ends_with("49.sdf")
        );
        assert_eq!(again.scene(Path::new("48.sdf")).unwrap().camera, Some(camera));
        std::fs::write(&path, "{").unwrap();
        assert_eq!(Settings::read(&path), Settings::default());
    }
}
