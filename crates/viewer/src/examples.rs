//! Scenes to begin with, embedded in the program: opened, one becomes a file of the user's.

use std::path::{Path, PathBuf};

/// A scene to begin with.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// The name of its file, without the ending.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

macro_rules! examples {
    ($($name:literal)*) => {
        &[$(Example { name: $name, text: include_str!(concat!("../../../examples/", $name, ".sdf")) }),*]
    };
}

/// All of them by name.
pub const EXAMPLES: &[Example] = examples![
    "balloon" "blends" "booleans" "comprehension" "conditions" "gear" "gyroid_lattice" "lambdas" "lettering" "mandelbulb" "materials"
    "menger_sponge" "minimal_surfaces" "own_shapes" "params" "pawn" "pebbles" "polyhedra" "profiles" "recursion" "round"
    "snowman" "solids" "table" "terrain" "time" "transforms" "twist"
];

impl Example {
    /// The example as a file in a folder, which is made. One that is there is left as it is: it may have been edited.
    ///
    /// # Errors
    ///
    /// The folder or the file cannot be made; why, in one line.
    pub fn file_in(&self, folder: &Path) -> Result<PathBuf, String> {
        let path = folder.join(format!("{}.sdf", self.name));
        if path.exists() {
            return Ok(path);
        }
        let made = std::fs::create_dir_all(folder)
            .and_then(|()| sdfc_files::write(&path, self.text.as_bytes()));
        made.map(|()| path.clone())
            .map_err(|error| format!("cannot write {}: {error}", path.display()))
    }

    /// What it is about: its first comment.
    pub fn summary(&self) -> String {
        let comment = self.text.lines().map_while(|line| line.strip_prefix("//"));
        comment.map(|line| line.trim_start_matches('/').trim()).collect::<Vec<_>>().join("\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_of_the_folder_are_there_and_say_what_they_are_about() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
        let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let scenes = paths.filter(|path| path.extension().is_some_and(|it| it == "sdf"));
        let mut names: Vec<_> =
            scenes.map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect();
        names.sort();
        assert_eq!(names, EXAMPLES.iter().map(|example| example.name).collect::<Vec<_>>());
        for example in EXAMPLES {
            assert!(!example.summary().is_empty(), "{}", example.name);
        }
    }

    #[test]
    fn one_that_was_edited_stays_so() {
        let folder = tempfile::tempdir().unwrap();
        let path = EXAMPLES[0].file_in(&folder.path().join("new")).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), EXAMPLES[0].text);
        std::fs::write(&path, "box(1)").unwrap();
        EXAMPLES[0].file_in(&folder.path().join("new")).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "box(1)");
    }
}
