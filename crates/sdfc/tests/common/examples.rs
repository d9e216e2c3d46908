//! The scenes under `examples`.

/// Name and text of each scene, by name.
pub fn scene_files() -> Vec<(String, String)> {
    let mut scenes = Vec::new();
    let mut folders = vec![concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples").into()];
    while let Some(folder) = folders.pop() {
        let folder: std::path::PathBuf = folder;
        let entries = std::fs::read_dir(&folder).expect("examples can be listed");
        for path in entries.map(|entry| entry.expect("an entry").path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "sdf") {
                let text = std::fs::read_to_string(&path).expect("a scene can be read");
                let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                scenes.push((format!("examples/{stem}"), text));
            }
        }
    }
    scenes.sort();
    scenes
}
