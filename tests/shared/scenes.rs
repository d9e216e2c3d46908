//! The scenes under `examples/`, as text.

use std::path::{Path, PathBuf};

/// The folder of the examples.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples")
}

/// Path below that folder, with `/`, and text of each scene, by path; lines end in `\n`. An error if there is none.
pub fn scene_files() -> std::io::Result<Vec<(String, String)>> {
    let folder = folder();
    let mut paths = Vec::new();
    find(&folder, &mut paths)?;
    paths.sort();
    let mut scenes = Vec::new();
    for path in paths {
        let name = path.strip_prefix(&folder).map_err(std::io::Error::other)?;
        let name = name.display().to_string().replace('\\', "/");
        scenes.push((name, std::fs::read_to_string(&path)?.replace("\r\n", "\n")));
    }
    if scenes.is_empty() { Err(std::io::Error::other("there are no examples")) } else { Ok(scenes) }
}

fn find(folder: &Path, found: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.ends_with("node_modules") {
            continue;
        } else if path.is_dir() {
            find(&path, found)?;
        } else if path.extension().is_some_and(|ending| ending == "sdf") {
            found.push(path);
        }
    }
    Ok(())
}
