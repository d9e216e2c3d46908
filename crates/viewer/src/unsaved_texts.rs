//! The file of texts that were not saved when the window was lost.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::json_file;
use crate::settings::absolute;

/// The most scenes whose texts are stored.
const MAX_SCENES: usize = 20;
/// A larger file was not written by the viewer and is ignored.
const MAX_BYTES: u64 = 64 << 20;

/// An edited text, and the text of the file that it replaces.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct UnsavedText {
    /// The edited text.
    pub text: String,
    /// The text of its file when the edit began.
    pub base: String,
}

/// The edited texts of a scene and its imports.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct UnsavedScene {
    /// The absolute path of the scene.
    pub path: String,
    /// The text of the scene.
    pub scene: Option<UnsavedText>,
    /// The texts of imported files, by their path beside the scene.
    pub imports: BTreeMap<String, UnsavedText>,
}

impl UnsavedScene {
    /// Returns true if there is no text.
    pub fn is_empty(&self) -> bool {
        self.scene.is_none() && self.imports.is_empty()
    }
}

/// The file, which is beside that of the settings.
#[derive(Clone, Debug)]
pub struct UnsavedTexts(PathBuf);

impl UnsavedTexts {
    /// The file beside the settings at this path.
    pub fn beside(settings: &Path) -> Self {
        Self(settings.with_file_name("unsaved.json"))
    }

    /// The stored texts of a scene.
    pub fn of(&self, scene: &Path) -> Option<UnsavedScene> {
        let path = absolute(scene)?;
        self.read().into_iter().find(|stored| stored.path == path)
    }

    /// Stores the texts of a scene, or forgets them if there are none. Errors are ignored: the
    /// texts are then lost.
    pub fn store(&self, scene: &Path, unsaved: UnsavedScene) {
        let Some(path) = absolute(scene) else { return };
        let before = self.read();
        let mut scenes: Vec<_> = before.iter().filter(|it| it.path != path).cloned().collect();
        if !unsaved.is_empty() {
            scenes.insert(0, UnsavedScene { path, ..unsaved });
        }
        scenes.truncate(MAX_SCENES);
        if scenes != before {
            json_file::write(&self.0, &scenes);
        }
    }

    fn read(&self) -> Vec<UnsavedScene> {
        json_file::read(&self.0, MAX_BYTES)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stored_texts_are_read_again_and_forgotten() {
        let folder = tempfile::tempdir().unwrap();
        let texts = UnsavedTexts::beside(&folder.path().join("sdfc").join("view.json"));
        let [one, other] = ["one.sdf", "other.sdf"].map(|name| folder.path().join(name));
        let text = |text: &str| UnsavedText { text: text.to_owned(), base: "base".to_owned() };
        let imports = BTreeMap::from([("a.sdf".to_owned(), text("import"))]);
        let unsaved = UnsavedScene { scene: Some(text("ü\r\n")), imports, ..Default::default() };
        texts.store(&other, UnsavedScene::default());
        assert!(!texts.0.exists());
        texts.store(&one, unsaved.clone());
        texts.store(&other, UnsavedScene { scene: Some(text("b")), ..Default::default() });
        let found = texts.of(&one).unwrap();
        assert_eq!((found.scene, found.imports), (unsaved.scene, unsaved.imports));
        texts.store(&one, UnsavedScene::default());
        assert_eq!(texts.of(&one), None);
        assert_eq!(texts.of(&other).and_then(|it| it.scene), Some(text("b")));
    }
}
