//! Example scenes, embedded in the program. Opening one copies it to a file of the user.

use std::path::{Path, PathBuf};

use sdfc_examples::BASICS;

use crate::small_pictures::PictureKey;

/// The most edited versions of an example that are kept.
const MAX_VERSIONS: u32 = 1000;

/// An example scene.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// The file name without its extension.
    pub name: &'static str,
    /// Its source.
    pub source: &'static str,
}

/// The scene that is shown if no file is named.
pub const WELCOME: Example = Example { name: "welcome", source: include_str!("welcome.sdf") };

/// The welcome scene, and all other examples by name.
pub const EXAMPLES: &[Example] = &{
    let mut examples = [WELCOME; BASICS.len() + 1];
    let mut index = 0;
    while index < BASICS.len() {
        let (name, source) = BASICS[index];
        index += 1;
        examples[index] = Example { name, source };
    }
    examples
};

/// One of [`EXAMPLES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ExampleId(usize);

impl ExampleId {
    /// All examples, in order.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..EXAMPLES.len()).map(Self)
    }

    /// The example.
    pub fn example(self) -> Example {
        EXAMPLES.get(self.0).copied().unwrap_or(WELCOME)
    }
}

impl PictureKey for ExampleId {
    fn scene(&self) -> (&str, &str) {
        let Example { name, source } = self.example();
        (name, source)
    }
}

impl Example {
    /// Copies the example to a folder, which is created. An existing file is kept: the user may
    /// have edited it.
    ///
    /// # Errors
    ///
    /// The folder or the file cannot be written. The message is one line.
    pub fn file_in(&self, folder: &Path) -> Result<PathBuf, String> {
        let path = folder.join(format!("{}.sdf", self.name));
        if path.exists() {
            return Ok(path);
        }
        let written = std::fs::create_dir_all(folder)
            .and_then(|()| sdfc_files::write(&path, self.source.as_bytes()));
        written
            .map(|()| path.clone())
            .map_err(|error| format!("cannot write {}: {error}", path.display()))
    }

    /// Writes the example as it was. The user's version is renamed to `NAME-edited.sdf`, or with a
    /// number if there is such a file.
    ///
    /// # Errors
    ///
    /// A file cannot be renamed or written. The message is one line.
    pub fn restore_in(&self, folder: &Path) -> Result<PathBuf, String> {
        let path = folder.join(format!("{}.sdf", self.name));
        let named = |number: u32| {
            let suffix = if number == 0 { String::new() } else { format!("-{number}") };
            folder.join(format!("{}-edited{suffix}.sdf", self.name))
        };
        if let Some(kept) = (0..MAX_VERSIONS).map(named).find(|kept| !kept.exists()) {
            std::fs::rename(&path, &kept)
                .map_err(|error| format!("cannot rename {}: {error}", path.display()))?;
        } else {
            let name = self.name;
            return Err(format!(
                "not restored: there are {MAX_VERSIONS} edited versions of {name}"
            ));
        }
        self.file_in(folder)
    }

    /// The description: the comment at the start of the source.
    pub fn summary(&self) -> String {
        let comment = self.source.lines().map_while(|line| line.strip_prefix("//"));
        comment.map(|line| line.trim_start_matches('/').trim()).collect::<Vec<_>>().join("\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::model;

    #[test]
    fn every_scene_of_the_examples_folder_is_included_and_has_a_description() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
        let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let scenes = paths.filter(|path| path.extension().is_some_and(|it| it == "sdf"));
        let mut names: Vec<_> =
            scenes.map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect();
        // The scene that sdfc new writes is no example of one feature.
        names.retain(|name| name != "new");
        names.sort();
        let (first, others) = EXAMPLES.split_first().unwrap();
        assert_eq!(names, others.iter().map(|example| example.name).collect::<Vec<_>>());
        assert_eq!(first.name, WELCOME.name);
        for example in EXAMPLES {
            assert!(!example.summary().is_empty(), "{}", example.name);
        }
    }

    #[test]
    fn the_welcome_scene_has_sliders() {
        let model = model(WELCOME.source);
        let names: Vec<_> = model.declared().iter().map(|param| param.name.clone()).collect();
        assert_eq!(names, ["hole", "soft", "paint"]);
    }

    #[test]
    fn opening_an_example_again_keeps_its_edits() {
        let folder = tempfile::tempdir().unwrap();
        let path = EXAMPLES[0].file_in(&folder.path().join("new")).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), EXAMPLES[0].source);
        std::fs::write(&path, "box(1)").unwrap();
        EXAMPLES[0].file_in(&folder.path().join("new")).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "box(1)");
    }

    #[test]
    fn a_restored_example_keeps_the_edited_version() {
        let folder = tempfile::tempdir().unwrap();
        let path = EXAMPLES[0].file_in(folder.path()).unwrap();
        for edited in ["box(1)", "box(2)"] {
            std::fs::write(&path, edited).unwrap();
            assert_eq!(EXAMPLES[0].restore_in(folder.path()).unwrap(), path);
            assert_eq!(std::fs::read_to_string(&path).unwrap(), EXAMPLES[0].source);
        }
        let kept = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        let name = EXAMPLES[0].name;
        assert_eq!(kept(&format!("{name}-edited.sdf")), "box(1)");
        assert_eq!(kept(&format!("{name}-edited-1.sdf")), "box(2)");
    }
}
