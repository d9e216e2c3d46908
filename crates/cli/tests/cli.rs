//! Tests the binary from outside: exit statuses, streams and files.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

const SCENE: &str = "sphere(0.8).color(#d94f30)\nplane(y: -0.8)\nsun(direction: [1, 2, 1])\n";
const WRONG: &str = "spere(0.8)\nbox(1).foo\n";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.sdf"), SCENE).unwrap();
    std::fs::write(folder.path().join("wrong.sdf"), WRONG).unwrap();
    folder
}

fn run_with(folder: &Path, args: &[&str], stdin: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_sdfc"))
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A program that refuses its arguments may exit before it reads.
    let _ = child.stdin.take().unwrap().write_all(stdin);
    child.wait_with_output().unwrap()
}

fn run(folder: &TempDir, args: &[&str]) -> Output {
    run_with(folder.path(), args, b"")
}

fn status(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Returns the names of the files in a folder, including temporary ones.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_check_says_what_it_found() {
    let folder = folder();
    let output = run(&folder, &["check", "scene.sdf"]);
    let said = text(&output.stderr);
    assert_eq!((status(&output), output.stdout), (0, vec![]));
    assert_eq!(said, "scene.sdf: no errors, no warnings\n");
    let said = text(&run(&folder, &["check", "wrong.sdf"]).stderr);
    assert!(said.ends_with("wrong.sdf: 2 errors, no warnings\n"), "{said}");
    let output = run(&folder, &["check", "-q", "scene.sdf"]);
    assert_eq!(text(&output.stderr), "");
}

#[test]
fn a_new_scene_is_correct_and_replaces_nothing() {
    let folder = folder();
    let output = run(&folder, &["new", "house"]);
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    assert_eq!(text(&run(&folder, &["check", "house.sdf"]).stderr).lines().count(), 1);
    assert_eq!(status(&run(&folder, &["fmt", "--check", "house.sdf"])), 0);
    let again = run(&folder, &["new", "scene.sdf"]);
    assert_eq!(status(&again), 2, "{}", text(&again.stderr));
    assert_eq!(std::fs::read_to_string(folder.path().join("scene.sdf")).unwrap(), SCENE);
}

#[test]
fn a_scene_without_a_command_is_drawn() {
    let folder = folder();
    let output = run(&folder, &["scene.sdf", "--size", "8x8", "--backend", "cpu"]);
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    assert!(names(folder.path()).contains(&"scene.png".to_owned()));
}

#[test]
fn the_command_line_can_replace_the_camera() {
    let folder = folder();
    let scene = "let r = 0.8\nsphere(r)\ncamera(eye: [0, 0, 5])\n";
    std::fs::write(folder.path().join("scene.sdf"), scene).unwrap();
    let size = ["--size", "16x16", "--backend", "cpu"];
    let draw = |out: &str, camera: &[&str]| {
        let args = [&["render", "scene.sdf", "-o", out], &size[..], camera].concat();
        run(&folder, &args)
    };
    assert_eq!(status(&draw("a.png", &[])), 0);
    assert_eq!(status(&draw("b.png", &["--camera", "eye: [0, 0, 5 * r]"])), 0);
    assert_eq!(status(&draw("c.png", &["--camera", "eye: [0, 0, 5]"])), 0);
    let pixels = |name: &str| image::open(folder.path().join(name)).unwrap();
    assert_ne!(pixels("a.png"), pixels("b.png"));
    assert_eq!(pixels("a.png"), pixels("c.png"));
    let wrong = draw("d.png", &["--camera", "position: [0, 0, 5]"]);
    assert_eq!(status(&wrong), 1);
    assert!(text(&wrong.stderr).contains("`camera` has no parameter `position`"));
}

#[test]
fn a_watched_scene_is_drawn_again_when_a_file_changes() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("part.sdf"), "let r = 0.5\n").unwrap();
    std::fs::write(path("scene.sdf"), "import r from \"part.sdf\"\nsphere(r)\n").unwrap();
    let args = ["render", "scene.sdf", "--watch", "--size", "16x16", "--backend", "cpu"];
    let mut child = Command::new(env!("CARGO_BIN_EXE_sdfc"))
        .args(args)
        .current_dir(folder.path())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut seen = vec![];
    let mut next = |what: &str| {
        let is_new = (0..600).any(|_| {
            std::thread::sleep(std::time::Duration::from_millis(50));
            let now = std::fs::read(path("scene.png")).unwrap_or_default();
            let is_new = now != seen;
            seen = now;
            is_new
        });
        assert!(is_new, "{what}");
    };
    next("the first picture");
    // An error ends nothing.
    std::fs::write(path("scene.sdf"), "spere(1)\n").unwrap();
    std::thread::sleep(std::time::Duration::from_millis(500));
    std::fs::write(path("scene.sdf"), "import r from \"part.sdf\"\nbox(2 * r)\n").unwrap();
    next("the scene changed");
    std::fs::write(path("part.sdf"), "let r = 0.25 // smaller\n").unwrap();
    next("the import changed");
    // A file that is missing is watched too.
    std::fs::write(path("scene.sdf"), "import r from \"later.sdf\"\nsphere(3 * r)\n").unwrap();
    std::thread::sleep(std::time::Duration::from_millis(500));
    std::fs::write(path("later.sdf"), "let r = 0.1\n").unwrap();
    next("the missing import was written");
    if cfg!(unix) {
        let interrupted = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(interrupted.unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
    } else {
        child.kill().unwrap();
        child.wait().unwrap();
    }
}

#[test]
fn a_wrong_scene_exits_with_1_and_shows_all_errors() {
    let folder = folder();
    let output = run(&folder, &["check", "wrong.sdf"]);
    let shown = text(&output.stderr);
    assert_eq!(status(&output), 1);
    assert!(output.stdout.is_empty());
    assert!(shown.contains("wrong.sdf:1:1") && shown.contains("wrong.sdf:2:"), "{shown}");
    assert!(shown.contains("did you mean `sphere`?"), "{shown}");
    assert!(!shown.contains('\x1b'), "no colour where no terminal is");
}

#[test]
fn json_diagnostics_have_all_keys() {
    let folder = folder();
    let output = run(&folder, &["check", "--json", "wrong.sdf", "scene.sdf"]);
    assert_eq!(status(&output), 1);
    let rows: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    assert!(rows.len() >= 2);
    let mut keys: Vec<_> = rows[0].as_object().unwrap().keys().cloned().collect();
    keys.sort();
    let expected = "code column end_column end_line file fixes help line message severity"
        .split(' ')
        .collect::<Vec<_>>();
    assert_eq!(keys, expected);
    assert_eq!(rows[0]["code"], "E0201");
    assert_eq!(rows[0]["file"], "wrong.sdf");
    assert_eq!((&rows[0]["line"], &rows[0]["column"]), (&1.into(), &1.into()));
    let edit = &rows[0]["fixes"][0]["edits"][0];
    assert_eq!((&edit["end_column"], &edit["text"]), (&rows[0]["end_column"], &"sphere".into()));
}

#[test]
fn a_missing_file_exits_with_3_and_other_files_are_checked() {
    let folder = folder();
    let output = run(&folder, &["check", "missing.sdf", "wrong.sdf"]);
    let shown = text(&output.stderr);
    assert_eq!(status(&output), 3);
    assert!(shown.contains("missing.sdf") && shown.contains("wrong.sdf:1:1"), "{shown}");
}

#[test]
fn a_file_that_is_no_text_exits_with_3() {
    let folder = folder();
    std::fs::write(folder.path().join("picture.sdf"), b"\x89PNG\xff").unwrap();
    let output = run(&folder, &["check", "picture.sdf"]);
    assert_eq!(status(&output), 3);
    assert!(text(&output.stderr).contains("not UTF-8"));
}

#[test]
fn wrong_command_lines_exit_with_2() {
    let folder = folder();
    for args in [
        &["check"][..],
        &["paint", "scene.sdf"],
        &["render", "scene.sdf", "--size", "0x10"],
        &["render", "scene.sdf", "--size", "big"],
        &["render", "scene.sdf", "--march", "magic"],
        &["render", "scene.sdf", "--backend", "abacus"],
        &["compile", "scene.sdf", "--target", "cobol"],
        &["compile", "scene.sdf", "--target", "glsl-es", "--emit", "render", "--stage", "compute"],
        &["compile", "scene.sdf", "--target", "shadertoy", "--emit", "field"],
        &["compile", "scene.sdf", "--target", "shadertoy", "--prefix", "a_"],
        &["compile", "scene.sdf", "--target", "shadertoy", "--binding", "1"],
        &["compile", "scene.sdf", "--target", "glsl-es", "--binding", "1"],
        &["compile", "scene.sdf", "--target", "msl", "--group", "1"],
        &["compile", "scene.sdf", "--stage", "fragment"],
        &["compile", "scene.sdf", "--march", "sphere"],
        &["compile", "scene.sdf", "--emit", "march", "--prefix", "9x"],
        &["compile", "scene.sdf", "--emit", "render", "--prefix", "9x"],
        &["compile", "scene.sdf", "--prefix", "9x"],
        &["compile", "scene.sdf", "--reflect", "-", "-o", "-"],
        &["compile", "scene.sdf", "--binding", "-1"],
        &["check", "-q", "-v", "scene.sdf"],
        &["render", "scene.sdf", "-o", "scene.sdf"],
        &["render", "scene.sdf", "-o", "-", "--stats", "-"],
        &["bench", "--suite", "--only", "no such scene"],
    ] {
        let output = run(&folder, args);
        assert_eq!(status(&output), 2, "{args:?}: {}", text(&output.stderr));
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{args:?}");
    }
    assert_eq!(names(folder.path()), ["scene.sdf", "wrong.sdf"]);
}

#[test]
fn stdin_is_a_scene_like_any_other() {
    let folder = folder();
    let output = run_with(folder.path(), &["check", "-"], WRONG.as_bytes());
    assert_eq!(status(&output), 1);
    assert!(text(&output.stderr).contains("<stdin>:1:1"));
}

#[test]
fn colours_are_used_on_request() {
    let folder = folder();
    let output = run(&folder, &["--color", "always", "check", "wrong.sdf"]);
    assert!(text(&output.stderr).contains("\x1b["));
}

#[test]
fn a_reflection_is_written_beside_its_shader() {
    let folder = folder();
    let args = ["compile", "scene.sdf", "--target", "spirv", "-o", "a.spv", "--reflect", "a.json"];
    let output = run(&folder, &args);
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    let reflection = std::fs::read(folder.path().join("a.json")).unwrap();
    let reflection: Value = serde_json::from_slice(&reflection).unwrap();
    for key in "sdfc source_hash prefix target functions params uniform certificate".split(' ') {
        assert!(reflection.get(key).is_some(), "{key}");
    }
    let words = std::fs::read(folder.path().join("a.spv")).unwrap();
    assert_eq!(words[..4], 0x0723_0203_u32.to_le_bytes(), "SPIR-V's first word");

    let args = ["compile", "scene.sdf", "-o", "b.wgsl", "--reflect", "none/b.json"];
    assert_eq!(status(&run(&folder, &args)), 3);
    assert_eq!(names(folder.path()), ["a.json", "a.spv", "scene.sdf", "wrong.sdf"]);
}

#[test]
fn shaders_are_written_to_stdout_or_to_a_complete_file() {
    let folder = folder();
    let streamed = run(&folder, &["compile", "scene.sdf"]);
    assert_eq!(status(&streamed), 0, "{}", text(&streamed.stderr));
    assert!(text(&streamed.stdout).contains("fn "));
    let written = run(&folder, &["compile", "scene.sdf", "-o", "scene.wgsl"]);
    assert_eq!(status(&written), 0);
    assert!(written.stdout.is_empty());
    assert_eq!(std::fs::read(folder.path().join("scene.wgsl")).unwrap(), streamed.stdout);
    assert!(text(&streamed.stdout).starts_with("// sdfc "));
    assert_eq!(names(folder.path()), ["scene.sdf", "scene.wgsl", "wrong.sdf"]);
}

#[test]
fn a_wrong_scene_does_not_change_an_older_output() {
    let folder = folder();
    std::fs::write(folder.path().join("out.wgsl"), "older").unwrap();
    let output = run(&folder, &["compile", "wrong.sdf", "-o", "out.wgsl"]);
    assert_eq!(status(&output), 1);
    assert_eq!(std::fs::read(folder.path().join("out.wgsl")).unwrap(), b"older");
}

#[test]
fn an_output_in_a_missing_folder_exits_with_3() {
    let folder = folder();
    for args in [
        ["compile", "scene.sdf", "-o", "none/out.wgsl"],
        ["render", "scene.sdf", "-o", "none/out.png"],
        ["render", "scene.sdf", "--stats", "none/out.json"],
    ] {
        let output = run(&folder, &args);
        assert_eq!(status(&output), 3, "{args:?}: {}", text(&output.stderr));
    }
    assert_eq!(names(folder.path()), ["scene.sdf", "wrong.sdf"]);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_exits_with_3() {
    let folder = folder();
    let output = run(&folder, &["compile", "scene.sdf", "-o", "/dev/full"]);
    assert_eq!(status(&output), 3, "{}", text(&output.stderr));
}

#[test]
#[cfg(unix)]
fn output_to_a_link_is_written_to_its_target() {
    let folder = folder();
    std::fs::write(folder.path().join("target.wgsl"), "older").unwrap();
    std::os::unix::fs::symlink("target.wgsl", folder.path().join("link.wgsl")).unwrap();
    assert_eq!(status(&run(&folder, &["compile", "scene.sdf", "-o", "link.wgsl"])), 0);
    assert!(folder.path().join("link.wgsl").is_symlink());
    assert_ne!(std::fs::read(folder.path().join("target.wgsl")).unwrap(), b"older");
}

#[test]
fn the_cpu_draws_and_writes_metrics() {
    let folder = folder();
    let args =
        ["render", "scene.sdf", "--backend", "cpu", "--size", "40x24", "--stats", "stats.json"];
    let output = run(&folder, &args);
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("scene.png"), "it says where the picture is");
    let png = std::fs::read(folder.path().join("scene.png")).unwrap();
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    assert_eq!((&png[16..20], &png[20..24]), (&[0, 0, 0, 40][..], &[0, 0, 0, 24][..]));
    let stats = std::fs::read(folder.path().join("stats.json")).unwrap();
    let stats: Value = serde_json::from_slice(&stats).unwrap();
    assert_eq!(stats["size"], serde_json::json!([40, 24]));
    let pixels = &stats["pixels"];
    let count = |key: &str| pixels[key].as_u64().unwrap();
    assert_eq!(count("hit") + count("miss") + count("capped") + count("nan"), 40 * 24);
    assert!(count("hit") > 100, "{pixels}");
    for key in "adapter driver backend method frame_ms compile_ms first_picture_ms evals_per_pixel \
                leaf_evals_per_pixel"
        .split_whitespace()
    {
        assert!(stats.get(key).is_some(), "{key}");
    }
}

#[test]
fn a_picture_streams_to_stdout() {
    let folder = folder();
    let args = ["render", "-", "-o", "-", "--backend", "cpu", "--size", "8x8"];
    let output = run_with(folder.path(), &args, SCENE.as_bytes());
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    assert_eq!(&output.stdout[..8], b"\x89PNG\r\n\x1a\n");
}

#[test]
fn explain_describes_the_scene() {
    let folder = folder();
    let output = run(&folder, &["explain", "--json", "scene.sdf"]);
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    let explained: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(explained["leaves"], 2);
    for key in
        "nodes ops_per_eval spirv_instructions features method step_scale certified bounds quality"
            .split_whitespace()
    {
        assert!(explained.get(key).is_some(), "{key}");
    }
    assert!(text(&run(&folder, &["explain", "scene.sdf"]).stdout).contains("leaves"));
    // A field that is stepped by its bound needs no constant; the constant of a twist depends on
    // its param.
    let constant = |scene: &[u8]| {
        let output = run_with(folder.path(), &["explain", "-"], scene);
        let page = text(&output.stdout);
        let row = page.lines().last().unwrap().split("  ").filter(|cell| !cell.is_empty());
        row.map(str::trim).nth(4).unwrap().to_owned()
    };
    assert_eq!(constant(b"ellipsoid_fast([1, 0.5, 0.4])\n"), "none");
    assert_eq!(constant(b"param k = 30deg in 0deg..60deg\nbox(1).twist(rate: k)\n"), "per frame");
}

#[test]
fn a_scene_that_draws_nothing_is_checked_but_not_rendered() {
    let folder = folder();
    let check = run_with(folder.path(), &["check", "-"], b"let a = sphere(1)\n");
    assert_eq!(status(&check), 0, "{}", text(&check.stderr));
    let args = ["render", "-", "-o", "out.png", "--backend", "cpu"];
    let render = run_with(folder.path(), &args, b"let a = sphere(1)\n");
    assert_eq!(status(&render), 1, "{}", text(&render.stderr));
    assert!(!render.stderr.is_empty());
    assert!(!folder.path().join("out.png").exists());
}

#[test]
fn scenes_are_formatted_in_place_or_only_checked() {
    let folder = folder();
    let ragged = folder.path().join("ragged.sdf");
    std::fs::write(&ragged, "sphere( 1 ) // ball\n").unwrap();
    assert_eq!(status(&run(&folder, &["fmt", "--check", "ragged.sdf"])), 1);
    assert_eq!(std::fs::read(&ragged).unwrap(), b"sphere( 1 ) // ball\n");
    assert_eq!(status(&run(&folder, &["fmt", "ragged.sdf"])), 0);
    assert_eq!(std::fs::read(&ragged).unwrap(), b"sphere(1)  // ball\n");
    assert_eq!(status(&run(&folder, &["fmt", "--check", "ragged.sdf"])), 0);
    let streamed = run_with(folder.path(), &["fmt", "-"], b"box( 2 )\n");
    assert_eq!((status(&streamed), text(&streamed.stdout).as_str()), (0, "box(2)\n"));
    std::fs::write(&ragged, "sphere( 1\n").unwrap();
    assert_eq!(status(&run(&folder, &["fmt", "ragged.sdf"])), 1);
    assert_eq!(std::fs::read(&ragged).unwrap(), b"sphere( 1\n");
}

#[test]
fn imports_are_read_from_the_folder_of_the_scene() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("parts")).unwrap();
    std::fs::write(folder.path().join("parts/knob.sdf"), "let knob = sphere(0.2)\n").unwrap();
    let importing = b"import knob from \"parts/knob.sdf\"\nknob\n";
    std::fs::write(folder.path().join("main.sdf"), importing).unwrap();
    let above = folder.path().parent().unwrap().to_owned();
    let name = folder.path().file_name().unwrap().to_str().unwrap();
    let output = run_with(&above, &["check", &format!("{name}/main.sdf")], b"");
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    std::fs::write(folder.path().join("parts/knob.sdf"), "let knob = spere(0.2)\n").unwrap();
    let output = run_with(&above, &["check", &format!("{name}/main.sdf")], b"");
    let said = text(&output.stderr);
    assert!(said.contains(&format!("{name}/parts/knob.sdf:1:")), "{said}");
    let missing =
        run_with(folder.path(), &["check", "-"], b"import knob from \"none.sdf\"\nknob\n");
    assert_eq!(status(&missing), 1);
    assert!(text(&missing.stderr).contains("E0209"), "{}", text(&missing.stderr));
}
