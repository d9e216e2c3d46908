//! The scenes under `examples/`, compiled.

use std::path::Path;

use libtest_mimic::Failed;
use sdfc::Scene;
use sdfc_test_support::{example_sources, examples_folder};

/// Returns the path below `examples` and the scene of each example, sorted by path.
///
/// # Errors
///
/// An example cannot be read or does not compile.
pub fn compiled_examples() -> Result<Vec<(String, Scene)>, Failed> {
    let mut scenes = Vec::new();
    for (name, _) in example_sources()? {
        let scene = compiled_example(&name)?;
        scenes.push((name, scene));
    }
    Ok(scenes)
}

/// Compiles the example with this path below `examples`.
///
/// # Errors
///
/// The example cannot be read or does not compile.
pub fn compiled_example(name: &str) -> Result<Scene, Failed> {
    let path = examples_folder().join(name);
    let text = std::fs::read_to_string(&path)?.replace("\r\n", "\n");
    let folder = SameFolder(&path);
    let scene = sdfc::Compiler::new().resolver(&folder).compile(name, &text);
    Ok(scene?)
}

/// Resolves imports in the folder of the scene at this path.
struct SameFolder<'a>(&'a Path);

impl sdfc::Resolver for SameFolder<'_> {
    fn read(&self, path: &str) -> Result<String, String> {
        std::fs::read_to_string(self.0.with_file_name(path)).map_err(|e| e.to_string())
    }
}
