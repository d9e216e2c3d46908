//! `sdfc mesh`: files, reports and refusals.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const SCENE: &str = "sphere(1).color(#d94f30)\n";

fn run(folder: &Path, args: &[&str]) -> Output {
    let command = Command::new(env!("CARGO_BIN_EXE_sdfc")).args(args).current_dir(folder).output();
    command.unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn every_format_is_written_with_its_signature() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.sdf"), SCENE).unwrap();
    for (name, start) in [
        ("ball.stl", "sdfc: mesh and surface are proven"),
        ("ball.obj", "# sdfc: "),
        ("ball.ply", "ply\nformat binary_little_endian 1.0\n"),
        ("ball.glb", "glTF"),
        ("ball.3mf", "PK"),
    ] {
        let args = ["mesh", "ball.sdf", "-o", name, "--error", "0.1", "--json", "ball.json"];
        let output = run(folder.path(), &args);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{message}");
        assert!(message.contains("proven to be within 0.1"), "{message}");
        let file = std::fs::read(folder.path().join(name)).unwrap();
        assert!(file.starts_with(start.as_bytes()), "{name}");
        let report = std::fs::read(folder.path().join("ball.json")).unwrap();
        let report: Value = serde_json::from_slice(&report).unwrap();
        assert_eq!(report["certificate"]["is_proven"], true);
        assert_eq!(report["open_edges"], 0);
    }
}

#[test]
fn a_refused_mesh_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("floor.sdf"), "plane(y: 0)\n").unwrap();
    let refused = |args: &[&str], status: i32, words: &str| {
        let output = run(folder.path(), args);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(status), "{message}");
        assert!(message.contains(words), "{message}");
        assert_eq!(names(folder.path()), ["floor.sdf"]);
    };
    refused(&["mesh", "floor.sdf", "--error", "0.1"], 1, "cut it with a box");
    refused(&["mesh", "floor.sdf", "-o", "floor.png"], 2, ".stl, .obj, .ply, .glb or .3mf");
    refused(&["mesh", "floor.sdf", "--error", "0"], 2, "above 0");
}

#[test]
fn an_error_greater_than_the_scene_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.sdf"), "sphere(1)\n").unwrap();
    for error in [["--error", "1e30"], ["--error-relative", "1.01"]] {
        for command in ["mesh", "contour"] {
            let output = run(folder.path(), &[command, "ball.sdf", error[0], error[1]]);
            let message = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(2), "{message}");
            let expected = "whose longest side is 2: state at most 2, such as 0.002";
            assert!(message.contains(expected), "{message}");
        }
    }
    assert_eq!(names(folder.path()), ["ball.sdf"]);
}
