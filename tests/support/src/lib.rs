//! Paths of the repository, the source text of the example scenes, and the resources of a process.
//!
//! This crate has no dependencies, so that the tests of every crate can use it.

mod resources;

use std::io;
use std::path::{Path, PathBuf};

pub use resources::Resources;

/// Returns the root folder of the repository.
pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap_or(Path::new("")).to_owned()
}

/// Returns the folder `examples`.
pub fn examples_folder() -> PathBuf {
    repository().join("examples")
}

/// Returns the path and the source of each scene below [`examples_folder`], sorted by path.
///
/// Paths are relative to that folder and use `/`; lines end in `\n`.
///
/// # Errors
///
/// A file cannot be read, or there are no scenes.
pub fn example_sources() -> io::Result<Vec<(String, String)>> {
    let folder = examples_folder();
    let mut paths = Vec::new();
    find_scenes(&folder, &mut paths)?;
    paths.sort();
    let mut scenes = Vec::new();
    for path in paths {
        let name = path.strip_prefix(&folder).map_err(io::Error::other)?;
        let name = name.display().to_string().replace('\\', "/");
        scenes.push((name, std::fs::read_to_string(&path)?.replace("\r\n", "\n")));
    }
    if scenes.is_empty() { Err(io::Error::other("there are no examples")) } else { Ok(scenes) }
}

fn find_scenes(folder: &Path, found: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.ends_with("node_modules") {
            continue;
        } else if path.is_dir() {
            find_scenes(&path, found)?;
        } else if path.extension().is_some_and(|ending| ending == "sdf") {
            found.push(path);
        }
    }
    Ok(())
}
