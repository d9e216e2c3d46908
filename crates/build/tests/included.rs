//! What a build script makes of a scene, compiled by rustc as part of a program; and how it fails.
#![allow(missing_docs, clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::Command;

use sdfc::{Scene, ShaderOptions, uniform_bytes};
use sdfc_build::Build;

const BOWL: &str = include_str!("../../../examples/embed/bowl.sdf");

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/embed")
}

/// Compiles a program that includes `NAME.rs` of a folder, runs it, and gives what it prints.
fn run(program: &Path, folder: &Path) -> String {
    let to = folder.join("program");
    let rustc = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    let compiled = Command::new(rustc)
        .args(["--edition", "2024", "-D", "warnings", "-A", "dead_code", "-o"])
        .args([&to, program])
        .env("OUT_DIR", folder)
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let output = Command::new(&to).output().unwrap();
    assert!(output.status.success());
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_example_holds_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    let mut read = Vec::new();
    let path = examples().join("bowl.sdf");
    let made = Build::new().generate(&path, &mut read).unwrap();
    assert_eq!((read, made.warnings), (vec![path], Vec::<String>::new()));
    std::fs::write(folder.path().join("bowl.rs"), made.text).unwrap();
    let printed = run(&examples().join("build/src/main.rs"), folder.path());

    let scene = Scene::from_source("bowl.sdf", BOWL).unwrap();
    let written = scene.write_shader(&ShaderOptions::default()).unwrap();
    let mut frame = scene.defaults();
    scene.set(&mut frame, "wall", 0.12).unwrap();
    let bytes = uniform_bytes(&written.reflection, &frame);
    assert!(printed.starts_with(&format!("group 0, binding 0: {bytes:?}\n")), "{printed}");
    let sdfc::Code::Text(text) = written.code else { panic!("WGSL is text") };
    assert!(printed.contains(&text));
}

/// Every kind of param, between members that want other alignments, under names that Rust reserves.
#[test]
fn a_structure_is_laid_out_as_the_buffer() {
    let scene = "param box = 0.5 in 0..2\nparam lid = true\nparam wood = #ff0000\nparam n: int = 3 in 1..9\n\
                 param gen = 10deg in 0deg..45deg\nparam style = \"a\" in [\"b\", \"a\"]\n\
                 let s = if style == \"a\" { sphere(box) } else { cylinder(r: box) }\n\
                 (if lid { s } else { s | torus() }).rotate(y: gen).color(wood)\n\
                 sphere(0.1 * n).translate(y: time)";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("all.sdf");
    std::fs::write(&path, scene).unwrap();
    let made = Build::new().generate(&path, &mut Vec::new()).map_err(|(_, why)| why).unwrap();
    std::fs::write(folder.path().join("all.rs"), made.text).unwrap();
    let program = folder.path().join("main.rs");
    let main = "mod all { include!(concat!(env!(\"OUT_DIR\"), \"/all.rs\")); }\n\
                fn main() { println!(\"{:?}\", all::Params { time: 0.25, ..Default::default() }.to_bytes()); }";
    std::fs::write(&program, main).unwrap();
    let printed = run(&program, folder.path());

    let scene = Scene::from_source("all.sdf", scene).unwrap();
    let written = scene.write_shader(&ShaderOptions::default()).unwrap();
    let mut frame = scene.defaults();
    frame.time = 0.25;
    let bytes = uniform_bytes(&written.reflection, &frame);
    assert_eq!(written.reflection.members.len(), 7);
    assert_eq!(printed.trim_end(), format!("{bytes:?}"));
}

#[test]
fn errors_point_into_the_file_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ball.sdf");
    std::fs::write(&path, "import part from \"part.sdf\"\n\nlet a = spere(1)\na | part").unwrap();
    let mut read = Vec::new();
    let (lines, error) = Build::new().generate(&path, &mut read).unwrap_err();
    let place = path.display();
    let expected = format!("{place}:3:9: E0201: unknown name `spere`");
    assert!(lines.iter().any(|line| line.starts_with(&expected)), "{lines:#?}");
    assert!(format!("{error:?}").contains("did you mean `sphere`?"), "{error:?}");
    // What it would import is waited for.
    assert_eq!(read, [path.clone(), folder.path().join("part.sdf")]);

    let missing = folder.path().join("none.sdf");
    let (lines, _) = Build::new().generate(&missing, &mut Vec::new()).unwrap_err();
    assert!(lines[0].contains("none.sdf"), "{lines:?}");
}
