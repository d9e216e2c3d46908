//! `examples/embed/c`: compiled by the C compiler of the machine, its answers compared with the library's own.
#![allow(missing_docs, clippy::unwrap_used, reason = "a test fails by panicking")]

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use sdfc::Scene;

const SOURCE: &str = include_str!("../../../examples/embed/bowl.sdf");

/// The folder of the shared library, which is built beside this test.
fn libraries() -> std::path::PathBuf {
    std::env::current_exe().unwrap().parent().unwrap().to_owned()
}

#[test]
fn a_c_program_calls_the_field() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("field");
    let libraries = libraries();
    let compiled = Command::new("cc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"])
        .arg(env!("CARGO_MANIFEST_DIR"))
        .arg(root.join("examples/embed/c/field.c"))
        .arg("-L")
        .arg(&libraries)
        .args(["-lsdfc_capi", "-lm", "-o"])
        .arg(&program)
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));

    let points = [[0.0, 0.0, 0.0], [0.4, -0.3, 0.7], [1.5, 0.2, -0.1], [-0.3, -1.4, 0.2]];
    let mut child = Command::new(&program)
        .args([root.join("examples/embed/bowl.sdf").as_os_str(), "0.1".as_ref()])
        .env("LD_LIBRARY_PATH", &libraries)
        .env("DYLD_LIBRARY_PATH", &libraries)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let lines = points.map(|[x, y, z]| format!("{x} {y} {z}\n")).concat();
    child.stdin.take().unwrap().write_all(lines.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let (rests, rows) = text.split_once('\n').unwrap();

    let scene = Scene::from_source("bowl.sdf", SOURCE).unwrap();
    let mut frame = scene.defaults();
    scene.set(&mut frame, "wall", 0.1).unwrap();
    let mut field = scene.field(&frame).unwrap();
    let numbers = |line: &str| -> Vec<f64> {
        line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
    };
    let [x, y, z] = numbers(rests)[..] else { panic!("no ball rests: {rests}") };
    assert!((field.distance([x, y, z]) - 0.1).abs() < 1e-8);
    for (line, point) in rows.lines().zip(points) {
        let found = field.gradient(point);
        let [gx, gy, gz] = found.gradient;
        assert_eq!(numbers(line), [found.distance, gx, gy, gz]);
    }
    assert_eq!(rows.lines().count(), points.len());
}
