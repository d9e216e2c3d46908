//! GPU, CPU in f32 and CPU in f64 see the same surface in every scene under `examples`; the test `library` asks
//! the same of every entry of the library.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

mod common;

use common::agree;
use libtest_mimic::{Arguments, Trial};
use sdfc::render::testing;

fn main() {
    let mut trials = Vec::new();
    let without_gpu = testing::without_gpu();
    for (name, text) in scene_files() {
        let (again, source) = (name.clone(), text.clone());
        let cpu = move || agree::precisions(&agree::scene(&again, &source)?).map(drop);
        trials.push(Trial::test(format!("cpu/{name}"), cpu));
        let title = format!("gpu/{name}");
        let gpu = move || agree::devices(&agree::scene(&name, &text)?).map(drop);
        trials.push(Trial::test(title, gpu).with_ignored_flag(without_gpu));
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn scene_files() -> Vec<(String, String)> {
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
