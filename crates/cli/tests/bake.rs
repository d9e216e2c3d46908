//! `sdfc bake`: files, reports and refusals.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn run(folder: &Path, args: &[&str]) -> Output {
    let command = Command::new(env!("CARGO_BIN_EXE_sdfc")).args(args).current_dir(folder).output();
    command.unwrap()
}

#[test]
fn both_formats_hold_the_same_values() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.sdf"), "sphere(1)\n").unwrap();
    let mut values = Vec::new();
    for (name, start) in [("ball.npy", "\u{93}NUMPY"), ("ball.nrrd", "NRRD0005")] {
        let args = ["bake", "ball.sdf", "-o", name, "--resolution", "10", "--json", "ball.json"];
        let output = run(folder.path(), &args);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{message}");
        assert!(message.contains("10 x 10 x 10 samples"), "{message}");
        let file = std::fs::read(folder.path().join(name)).unwrap();
        assert!(file.iter().map(|byte| char::from(*byte)).collect::<String>().starts_with(start));
        values.push(file[file.len() - 4000..].to_vec());
    }
    assert_eq!(values[0], values[1]);
    let report = std::fs::read(folder.path().join("ball.json")).unwrap();
    let report: Value = serde_json::from_slice(&report).unwrap();
    assert_eq!(report["shape"], serde_json::json!([10, 10, 10]));
    assert!(report["interpolation_error"].as_f64().is_some());
}

#[test]
fn a_refused_grid_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.sdf"), "sphere(1)\n").unwrap();
    for (args, words) in [
        (["bake", "ball.sdf", "--resolution", "2"], "at least 4"),
        (["bake", "ball.sdf", "-o", "ball.png"], ".npy or .nrrd"),
    ] {
        let output = run(folder.path(), &args);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(words), "{message}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
