//! `sdfc contour`: files, reports and refusals.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn run(folder: &Path, args: &[&str]) -> Output {
    let command = Command::new(env!("CARGO_BIN_EXE_sdfc")).args(args).current_dir(folder).output();
    command.unwrap()
}

#[test]
fn both_formats_are_written_with_holes() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ring.sdf"), "torus(1, 0.3)\n").unwrap();
    for name in ["ring.svg", "ring.dxf"] {
        let args = ["contour", "ring.sdf", "-o", name, "--plane", "y=0", "--json", "ring.json"];
        let output = run(folder.path(), &args);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{message}");
        assert!(message.contains("2 paths"), "{message}");
        let report = std::fs::read(folder.path().join("ring.json")).unwrap();
        let report: Value = serde_json::from_slice(&report).unwrap();
        assert_eq!(report["certificate"]["is_proven"], true);
        assert_eq!(report["paths"].as_array().map(Vec::len), Some(2));
    }
    let svg = std::fs::read_to_string(folder.path().join("ring.svg")).unwrap();
    assert_eq!((svg.matches("<path").count(), svg.matches('Z').count()), (1, 2));
    let dxf = std::fs::read_to_string(folder.path().join("ring.dxf")).unwrap();
    assert_eq!((dxf.matches("POLYLINE").count(), dxf.matches("SEQEND").count()), (2, 2));
}

#[test]
fn a_refused_contour_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.sdf"), "sphere(1)\n").unwrap();
    for (args, words) in [
        (["contour", "ball.sdf", "--plane", "z=2"], "meets no inside"),
        (["contour", "ball.sdf", "--plane", "z=1"], "move it a little"),
        (["contour", "ball.sdf", "--plane", "w=1"], "such as z=0.5"),
        (["contour", "ball.sdf", "-o", "ball.png"], ".svg or .dxf"),
    ] {
        let output = run(folder.path(), &args);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(words), "{message}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
