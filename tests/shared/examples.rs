//! The scenes under `examples/`, compiled.

#[path = "scenes.rs"]
mod scenes;

use std::path::Path;

use libtest_mimic::Failed;
use sdfc::Scene;

pub use scenes::folder;

/// Path below the folder of the examples and scene of each, by path.
pub fn examples() -> Result<Vec<(String, Scene)>, Failed> {
    let mut found = Vec::new();
    for (name, _) in scenes::scene_files()? {
        let scene = example(&name)?;
        found.push((name, scene));
    }
    Ok(found)
}

/// The example of that path.
pub fn example(name: &str) -> Result<Scene, Failed> {
    let path = folder().join(name);
    let text = std::fs::read_to_string(&path)?.replace("\r\n", "\n");
    let scene = sdfc::compile_with_imports(name, &text, &Beside(&path)).scene;
    Ok(scene.ok_or(format!("{name} does not compile"))?)
}

/// Files below the folder of a scene.
struct Beside<'a>(&'a Path);

impl sdfc::Resolver for Beside<'_> {
    fn read(&self, path: &str) -> Result<String, String> {
        std::fs::read_to_string(self.0.with_file_name(path)).map_err(|e| e.to_string())
    }
}
