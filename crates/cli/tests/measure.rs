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
fn measurements_of_a_small_solid_keep_their_digits() {
    let output = run("sphere(0.001)\n", &["--error-relative", "0.01"]);
    let text = String::from_utf8(output.stdout).unwrap();
    for [row, digits] in [["volume ", "e-9 .. 4."], ["inertia xx ", "e-15 .. 1."], ["area ", "e-5"]]
    {
        let line = text.lines().find(|line| line.starts_with(row)).unwrap();
        assert!(line.contains(digits), "{text}");
    }
}

#[test]
fn a_scene_without_a_limit_is_refused() {
    let output = run("plane(y: 0)\n", &[]);
    assert_eq!(output.status.code(), Some(1));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("cut it with a box"), "{message}");
}

#[test]
fn the_thinnest_wall_is_printed() {
    let output =
        run("sphere(1) - sphere(0.75)\n", &["--thinnest-wall", "--error-relative", "0.02"]);
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8(output.stdout).unwrap();
    let words = ["thinnest wall     0.21 .. 0.251\n", "end of the wall   ["];
    assert!(words.iter().all(|word| text.contains(word)), "{text}");
    let args = ["--thinnest-wall", "--error-relative", "0.02", "--json"];
    let output = run("sphere(1) - sphere(0.75)\nplane(y: -1)\n", &args);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(report["thickness"][0].as_f64().unwrap() < 0.25, "{report}");
    assert_eq!(report["left_out"].as_array().unwrap().len(), 1);
}

#[test]
fn a_thinnest_wall_is_not_measured_between_solids() {
    let output = run("let a = sphere(1)\na\n", &["--thinnest-wall", "--between", "a", "a"]);
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("--thinnest-wall") && message.contains("--between"), "{message}");
}
