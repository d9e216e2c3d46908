//! `sdfc measure`: tables, JSON and refusals.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::process::{Command, Output};

use serde_json::Value;

fn run(source: &str, args: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.sdf"), source).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_sdfc"));
    command.args(["measure", "scene.sdf"]).args(args).current_dir(folder.path()).output().unwrap()
}

#[test]
fn a_table_or_json_is_printed() {
    let output = run("sphere(1)\n", &["--error-relative", "0.01"]);
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8(output.stdout).unwrap();
    for word in ["volume", "center of mass x", "inertia xy", "lowest z", "an estimate"] {
        assert!(text.contains(word), "{text}");
    }
    let output = run("sphere(1)\n", &["--error-relative", "0.01", "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let ends = [0, 1].map(|index| report["volume"][index].as_f64().unwrap());
    assert!(ends[0] < 4.1888 && 4.1887 < ends[1], "{report}");
}

#[test]
fn a_scene_without_a_limit_is_refused() {
    let output = run("plane(y: 0)\n", &[]);
    assert_eq!(output.status.code(), Some(1));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("cut it with a box"), "{message}");
}
