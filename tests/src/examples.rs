//! The scenes under `examples/`, compiled.

use std::path::Path;
use std::sync::OnceLock;

use libtest_mimic::Failed;
use rayon::prelude::*;
use sdfc::Scene;
use sdfc_test_support::{example_sources, examples_folder};

/// Returns the path below `examples` and the scene of each example, sorted by path. They are
/// compiled once for all tests of a program.
///
/// # Errors
///
/// An example cannot be read or does not compile.
pub fn compiled_examples() -> Result<&'static [(String, Scene)], Failed> {
    static EXAMPLES: OnceLock<Result<Vec<(String, Scene)>, String>> = OnceLock::new();
    let compile =
        || compile_examples().map_err(|error| error.message().unwrap_or_default().to_owned());
    EXAMPLES.get_or_init(compile).as_deref().map_err(|error| error.as_str().into())
}

/// Compiles all examples anew, on all threads.
///
/// # Errors
///
/// An example cannot be read or does not compile.
pub fn compile_examples() -> Result<Vec<(String, Scene)>, Failed> {
    let names = example_sources()?.into_par_iter().map(|(name, _)| name);
    names.map(|name| Ok((name.clone(), compiled_example(&name)?))).collect()
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
