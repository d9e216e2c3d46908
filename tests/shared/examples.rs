//! The scenes under `examples/`.

use std::path::{Path, PathBuf};

use libtest_mimic::Failed;
use sdfc::Scene;

/// Name and scene of each example, in order of name.
pub fn examples() -> Result<Vec<(String, Scene)>, Failed> {
    let folder = folder();
    let mut paths = Vec::new();
    scene_files(&folder, &mut paths)?;
    paths.sort();
    let mut found = Vec::new();
    for path in paths {
        let name = path.strip_prefix(&folder)?.display().to_string().replace('\\', "/");
        let scene = example(&name)?;
        found.push((name, scene));
    }
    if found.is_empty() { Err("no examples were found".into()) } else { Ok(found) }
}

/// The example of that name.
pub fn example(name: &str) -> Result<Scene, Failed> {
    let path = folder().join(name);
    let text = std::fs::read_to_string(&path)?.replace("\r\n", "\n");
    let scene = sdfc::compile_with_imports(name, &text, &Beside(&path)).scene;
    Ok(scene.ok_or(format!("{name} does not compile"))?)
}

pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples")
}

/// Files below the folder of a scene.
struct Beside<'a>(&'a Path);

impl sdfc::Resolver for Beside<'_> {
    fn read(&self, path: &str) -> Result<String, String> {
        std::fs::read_to_string(self.0.with_file_name(path)).map_err(|e| e.to_string())
    }
}

fn scene_files(folder: &Path, found: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.ends_with("node_modules") {
            continue;
        } else if path.is_dir() {
            scene_files(&path, found)?;
        } else if path.extension().is_some_and(|e| e == "sdf") {
            found.push(path);
        }
    }
    Ok(())
}
