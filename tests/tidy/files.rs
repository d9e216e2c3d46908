//! The files of the repository that the checks read.

use std::path::{Path, PathBuf};

use sdfc_test_support::repository;

/// The most lines of a file.
const MAX_LINES: usize = 800;

/// Returns every file below `folder` whose name ends in `.extension`, sorted.
pub fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            // Hidden folders, and those of build tools such as `target` and `target-wasm`.
            let is_foreign = path.file_name().is_some_and(|name| {
                let name = name.to_string_lossy();
                name.starts_with('.') || name.starts_with("target") || name == "node_modules"
            });
            if path.is_dir() && (!is_foreign || path.ends_with("tests/targets")) {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Returns the path below the repository, with `/`, and the text of every file with one of the
/// extensions.
pub fn texts(extensions: &[&str]) -> Vec<(String, String)> {
    let root = repository();
    let paths = extensions.iter().flat_map(|extension| files(&root, extension));
    let text = |path: PathBuf| {
        let name = path.strip_prefix(&root).unwrap().display().to_string().replace('\\', "/");
        (name, std::fs::read_to_string(&path).unwrap())
    };
    paths.map(text).collect()
}

/// Returns the part of a source file before its tests.
pub fn product(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    text.split("#[cfg(test)]").next().unwrap_or_default().to_owned()
}

#[test]
fn no_file_is_too_long() {
    for (path, text) in texts(&["rs", "wgsl", "sdf", "md"]) {
        let lines = text.lines().count();
        assert!(lines <= MAX_LINES, "{path} has {lines} lines, more than {MAX_LINES}");
    }
}
