//! `examples/embed/c`, compiled with the C compiler of the machine, computes the same values as the
//! library.
#![allow(missing_docs, clippy::unwrap_used, reason = "a test fails by panicking")]

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use sdfc::Compiler;

const SOURCE: &str = include_str!("../../../examples/embed/bowl.sdf");

/// Returns the folder of the shared library, which is built beside this test.
fn libraries() -> PathBuf {
    std::env::current_exe().unwrap().parent().unwrap().to_owned()
}

/// Compiles `field.c` to a program in the folder.
fn compiled(folder: &Path) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let program = folder.join("field");
    let compiled = Command::new("cc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"])
        .arg(env!("CARGO_MANIFEST_DIR"))
        .arg(root.join("examples/embed/c/field.c"))
        .arg("-L")
        .arg(libraries())
        .args(["-lsdfc_capi", "-lm", "-o"])
        .arg(&program)
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    program
}

/// Runs the program with a scene and points, and returns its output.
fn run(program: &Path, scene: &Path, points: &[[f64; 3]]) -> Output {
    let mut child = Command::new(program)
        .args([scene.as_os_str(), "0.1".as_ref()])
        .env("LD_LIBRARY_PATH", libraries())
        .env("DYLD_LIBRARY_PATH", libraries())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let lines: String = points.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
    // A program that ends early does not read them.
    let _ = child.stdin.take().unwrap().write_all(lines.as_bytes());
    child.wait_with_output().unwrap()
}

#[test]
fn the_c_example_computes_the_distances_of_the_library() {
    let folder = tempfile::tempdir().unwrap();
    let program = compiled(folder.path());
    let points = [[0.0, 0.0, 0.0], [0.4, -0.3, 0.7], [1.5, 0.2, -0.1], [-0.3, -1.4, 0.2]];
    let bowl = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/embed/bowl.sdf");
    let output = run(&program, &bowl, &points);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let (rests, rows) = text.split_once('\n').unwrap();

    let scene = Compiler::new().compile("bowl.sdf", SOURCE).unwrap();
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

    // A scene of two files; the second does not exist at first.
    let path = folder.path().join("two.sdf");
    std::fs::write(&path, "import ball from \"parts/ball.sdf\"\nball()").unwrap();
    let output = run(&program, &path, &points);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && said.contains("the program has no such file"), "{said}");
    std::fs::create_dir(folder.path().join("parts")).unwrap();
    let ball = "solid ball() = length(p) - 0.25";
    std::fs::write(folder.path().join("parts/ball.sdf"), ball).unwrap();
    let output = run(&program, &path, &points);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.starts_with("rests ") && text.contains("\n-0.25 "), "{text}");
}
