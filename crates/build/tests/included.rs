//! The generated module compiles as part of a program, and errors name their position.
#![allow(missing_docs, clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::Command;

use sdfc::{Compiler, ShaderOptions, uniform_bytes};
use sdfc_build::Build;

const BOWL: &str = include_str!("../../../examples/embed/bowl.sdf");

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/embed")
}

/// Compiles a program that includes `NAME.rs` of a folder, runs it, and returns its output.
fn run(program: &Path, folder: &Path) -> String {
    run_with(program, folder, &[]).unwrap()
}

/// Does the same as [`run`], with more arguments for the compiler.
fn run_with(program: &Path, folder: &Path, arguments: &[String]) -> Result<String, String> {
    let to = folder.join("program");
    let rustc = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    let compiled = Command::new(rustc)
        .args(["--edition", "2024", "-D", "warnings", "-o"])
        .args([&to, program])
        .args(arguments)
        .env("OUT_DIR", folder)
        .output()
        .unwrap();
    if !compiled.status.success() {
        return Err(String::from_utf8_lossy(&compiled.stderr).into_owned());
    }
    let output = Command::new(&to).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Ok(String::from_utf8(output.stdout).unwrap())
}

/// Returns the arguments with which rustc finds each build of bytemuck beside this test.
fn with_bytemuck() -> Vec<[String; 4]> {
    let beside = std::env::current_exe().unwrap().parent().unwrap().to_owned();
    let built = std::fs::read_dir(&beside).unwrap().map(|entry| entry.unwrap().path());
    let built = built.filter(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("libbytemuck-") && name.ends_with(".rlib")
    });
    let arguments = built.map(|path| {
        let (folder, library) = (beside.display(), path.display());
        [
            "-L".into(),
            format!("dependency={folder}"),
            "--extern".into(),
            format!("bytemuck={library}"),
        ]
    });
    arguments.collect()
}

#[test]
fn the_example_includes_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    let mut read = Vec::new();
    let path = examples().join("bowl.sdf");
    let generated = Build::new().generate(&path, &mut read).unwrap();
    assert_eq!((read, generated.warnings), (vec![path], Vec::<String>::new()));
    std::fs::write(folder.path().join("bowl.rs"), generated.text).unwrap();
    let printed = run(&examples().join("build/src/main.rs"), folder.path());

    let scene = Compiler::new().compile("bowl.sdf", BOWL).unwrap();
    let written = scene.write_shader(&ShaderOptions::default()).unwrap();
    let mut frame = scene.defaults();
    scene.set(&mut frame, "wall", 0.12).unwrap();
    let bytes = uniform_bytes(&written.reflection, &frame);
    assert!(printed.starts_with(&format!("group 0, binding 0: {bytes:?}\n")), "{printed}");
    let sdfc::Code::Text(text) = written.code else { panic!("WGSL is text") };
    assert!(printed.contains(&text));
}

/// A scene with every kind of param, mixed alignments, and names that Rust reserves.
const EVERY_KIND: &str = "param box = 0.5 in 0..2\nparam lid = true\nparam wood = #ff0000\nparam n: int = 3 in 1..9\n\
                          param gen = 10deg in 0deg..45deg\nparam style = \"a\" in [\"b\", \"a\"]\n\
                          let s = if style == \"a\" { sphere(box) } else { cylinder(r: box) }\n\
                          (if lid { s } else { s | torus() }).rotate(y: gen).color(wood)\n\
                          sphere(0.1 * n).translate(y: time)";

/// Writes the module of that scene and a program that includes it. Returns the path of the program.
fn every_kind(build: &Build, folder: &Path, main: &str) -> PathBuf {
    let path = folder.join("all.sdf");
    std::fs::write(&path, EVERY_KIND).unwrap();
    let generated = build.generate(&path, &mut Vec::new()).map_err(|(_, why)| why).unwrap();
    std::fs::write(folder.join("all.rs"), generated.text).unwrap();
    let program = folder.join("main.rs");
    let module = "mod all { include!(concat!(env!(\"OUT_DIR\"), \"/all.rs\")); }";
    std::fs::write(&program, format!("{module}\nfn main() {{ {main} }}")).unwrap();
    program
}

#[test]
fn params_have_the_layout_of_the_buffer() {
    let folder = tempfile::tempdir().unwrap();
    let main = "println!(\"{:?}\", all::Params { time: 0.25, ..Default::default() }.to_bytes());";
    let program = every_kind(&Build::new(), folder.path(), main);
    let printed = run(&program, folder.path());

    let scene = Compiler::new().compile("all.sdf", EVERY_KIND).unwrap();
    let written = scene.write_shader(&ShaderOptions::default()).unwrap();
    let mut frame = scene.defaults();
    frame.time = 0.25;
    let bytes = uniform_bytes(&written.reflection, &frame);
    assert_eq!(written.reflection.members.len(), 7);
    assert_eq!(printed.trim_end(), format!("{bytes:?}"));
}

/// `Pod` can be derived only for structures without padding.
#[test]
fn params_derive_pod_with_the_option() {
    let folder = tempfile::tempdir().unwrap();
    let main = "let params = all::Params { time: 0.25, lid: 0, ..Default::default() };\n\
                assert_eq!(bytemuck::bytes_of(&params), params.to_bytes());\n\
                let zero: all::Params = bytemuck::Zeroable::zeroed();\n\
                assert_eq!(zero.to_bytes(), [0; size_of::<all::Params>()]);\n\
                println!(\"same\");";
    let program = every_kind(&Build::new().bytemuck(true), folder.path(), main);
    // There may be builds with other versions and features.
    let tried = with_bytemuck().into_iter().map(|found| run_with(&program, folder.path(), &found));
    let tried: Vec<_> = tried.collect();
    let ran = tried.iter().flatten().next();
    assert_eq!(ran.map(|text| text.trim_end()), Some("same"), "{tried:#?}");

    // Without the option, `Pod` is not derived.
    let program = every_kind(&Build::new(), folder.path(), main);
    let mut tried =
        with_bytemuck().into_iter().map(|found| run_with(&program, folder.path(), &found));
    assert!(tried.all(|tried| tried.is_err()));
}

#[test]
fn errors_point_into_the_file_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ball.sdf");
    std::fs::write(&path, "import part from \"part.sdf\"\n\nlet a = spere(1)\na | part").unwrap();
    let mut read = Vec::new();
    let (lines, error) = Build::new().generate(&path, &mut read).unwrap_err();
    let path_text = path.display();
    let expected = format!("{path_text}:3:9: E0201: unknown name `spere`");
    assert!(lines.iter().any(|line| line.starts_with(&expected)), "{lines:#?}");
    assert!(format!("{error:?}").contains("did you mean `sphere`?"), "{error:?}");
    // The script runs again when the missing import appears.
    assert_eq!(read, [path.clone(), folder.path().join("part.sdf")]);

    // The path of an imported file, too, is relative to the working folder of Cargo.
    std::fs::write(&path, "import part from \"part.sdf\"\npart()").unwrap();
    std::fs::write(folder.path().join("part.sdf"), "solid part() = lenght(p) - 1").unwrap();
    let (lines, _) = Build::new().generate(&path, &mut Vec::new()).unwrap_err();
    let expected = format!("{}:1:16: E0201", folder.path().join("part.sdf").display());
    assert!(lines.iter().any(|line| line.starts_with(&expected)), "{lines:#?}");

    let missing = folder.path().join("none.sdf");
    let (lines, _) = Build::new().generate(&missing, &mut Vec::new()).unwrap_err();
    assert!(lines[0].contains("none.sdf"), "{lines:?}");
}
