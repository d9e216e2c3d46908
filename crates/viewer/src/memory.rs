//! What the window remembers from one time to the next, in a file of the user's.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::orbit::Kept;

/// Scenes that are remembered.
const MOST_SCENES: usize = 40;
/// Files larger than this are none of ours.
const MAX_BYTES: u64 = 1 << 20;

/// All that is remembered.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Memory {
    /// Whether the window is light.
    pub light: bool,
    /// Width and height of the window in points.
    pub window: Option<[f32; 2]>,
    /// Scenes by their absolute paths, the last one first.
    pub scenes: Vec<Remembered>,
}

/// A scene as it was left.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Remembered {
    /// Its absolute path.
    pub path: String,
    /// The camera, where it had been moved.
    pub camera: Option<Kept>,
    /// Params that had been moved.
    pub params: BTreeMap<String, [f64; 4]>,
}

impl Memory {
    /// From a file; one that is missing or spoilt is as if there were none.
    pub fn read(place: &Path) -> Self {
        let small = std::fs::metadata(place).is_ok_and(|found| found.len() <= MAX_BYTES);
        let text = small.then(|| std::fs::read_to_string(place).ok()).flatten();
        text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default()
    }

    /// Into a file. What cannot be written is forgotten.
    pub fn write(&self, place: &Path) {
        if let (Some(folder), Ok(text)) = (place.parent(), serde_json::to_string_pretty(self)) {
            let _ = std::fs::create_dir_all(folder);
            let _ = sdfc_files::write(place, text.as_bytes());
        }
    }

    /// A scene as it was left.
    pub fn scene(&self, path: &Path) -> Option<&Remembered> {
        let path = absolute(path)?;
        self.scenes.iter().find(|scene| scene.path == path)
    }

    /// Remembers a scene as the last one.
    pub fn note(&mut self, path: &Path, camera: Option<Kept>, params: BTreeMap<String, [f64; 4]>) {
        let Some(path) = absolute(path) else { return };
        self.scenes.retain(|scene| scene.path != path);
        self.scenes.insert(0, Remembered { path, camera, params });
        self.scenes.truncate(MOST_SCENES);
    }
}

/// `None` where it is no text, which a file of text cannot keep.
fn absolute(path: &Path) -> Option<String> {
    std::path::absolute(path).ok()?.to_str().map(str::to_owned)
}

/// The file that is used unless a test says otherwise: below the folder for settings that the system has.
pub fn usual_place() -> Option<PathBuf> {
    folder("XDG_CONFIG_HOME", ".config").map(|folder| folder.join("sdfc").join("view.json"))
}

/// The folder for examples that have been opened.
pub fn examples_folder() -> Option<PathBuf> {
    folder("XDG_DATA_HOME", ".local/share").map(|folder| folder.join("sdfc").join("examples"))
}

/// By the variable, where it is set; below the home of the user; on Windows in the data of programs.
fn folder(variable: &str, below_home: &str) -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    let chosen = set(variable).or_else(|| set("APPDATA")).map(PathBuf::from);
    chosen
        .or_else(|| set("HOME").map(|home| Path::new(&home).join(below_home)))
        .filter(|folder| folder.is_absolute())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_noted_is_read_again_and_a_spoilt_file_is_none() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("new").join("view.json");
        let mut memory = Memory { light: true, ..Memory::read(&place) };
        let kept = Kept { eye: [1.0, 2.0, 1.0 / 3.0], half_height: 0.25, ..Kept::default() };
        let params = BTreeMap::from([("r".to_owned(), [0.1 + 0.2, 0.0, 0.0, 0.0])]);
        for number in 0..50 {
            memory.note(Path::new(&format!("{number}.sdf")), Some(kept), params.clone());
        }
        memory.note(Path::new("48.sdf"), Some(kept), params);
        memory.write(&place);
        let again = Memory::read(&place);
        assert_eq!(again, memory);
        assert_eq!(again.scenes.len(), MOST_SCENES);
        assert!(
            again.scenes[0].path.ends_with("48.sdf") && again.scenes[1].path.ends_with("49.sdf")
        );
        assert_eq!(again.scene(Path::new("48.sdf")).unwrap().camera, Some(kept));
        std::fs::write(&place, "{").unwrap();
        assert_eq!(Memory::read(&place), Memory::default());
    }
}
