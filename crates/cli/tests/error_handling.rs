//! Bad input and failures of the machine give a clear error, the right exit status, no panic and no
//! partial output. `device.rs` tests lost devices, and `fault_injection.rs` faults of disk and
//! memory.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::path::Path;

use common::{folder, names, run, run_with, said};

const BALL: &str = "sphere(0.8)\nplane(y: -0.8)\n";

/// Runs the program, and checks its status, words on stderr, and that it neither panicked nor left
/// files behind.
fn ends(folder: &Path, args: &str, stdin: &[u8], status: i32, words: &[&str]) {
    let before = names(folder);
    let output = run_with(folder, args, stdin);
    let said = said(&output);
    assert_eq!(output.status.code(), Some(status), "{args}: {said}");
    assert!(!said.contains("panicked"), "{args}: {said}");
    for word in words {
        assert!(said.contains(word), "{args}: no `{word}` in {said}");
    }
    if status != 0 {
        assert!(output.stdout.is_empty(), "{args}: partial output");
        assert_eq!(names(folder), before, "{args}: files left behind");
    }
}

/// Checks a scene with an error, with every command that reads scenes.
fn wrong(scene: &str, words: &[&str]) {
    let folder = folder(&[]);
    for args in
        ["check -", "compile -", "render - -o out.png --backend cpu", "explain -", "bench -"]
    {
        ends(folder.path(), args, scene.as_bytes(), 1, words);
    }
}

/// Checks an input that is no scene, with every command that reads scenes.
fn unreadable(folder: &Path, name: &str, words: &[&str]) {
    for command in ["check", "compile", "render", "explain", "fmt", "bench"] {
        ends(folder, &format!("{command} {name}"), b"", 3, words);
    }
}

#[test]
fn a_missing_file_is_reported() {
    unreadable(folder(&[]).path(), "none.sdf", &["cannot read none.sdf", "No such file"]);
}

#[test]
fn a_folder_is_reported() {
    let folder = folder(&[]);
    std::fs::create_dir(folder.path().join("scenes.sdf")).unwrap();
    unreadable(folder.path(), "scenes.sdf", &["cannot read scenes.sdf"]);
}

#[test]
fn charts_that_would_overwrite_files_are_refused() {
    let folder = folder(&[("a.sdf", BALL), ("README.md", "# A program of mine\n")]);
    std::fs::create_dir_all(folder.path().join("b")).unwrap();
    std::fs::create_dir_all(folder.path().join("out")).unwrap();
    std::fs::write(folder.path().join("b/a.sdf"), BALL).unwrap();
    let refused = |args: &str, word: &str| ends(folder.path(), args, b"", 2, &[word]);
    // Each says what to write.
    refused("mesh a.sdf --error -1", "expected a number above 0, such as 0.01");
    refused("contour a.sdf --error-relative -1", "expected a number above 0, such as 0.01");
    refused("check a.sdf -q -v", "write one of them");
    refused("explain a.sdf --set opn=", "expected NAME=VALUE, such as wall=0.1");
    refused("chart a.sdf -o .", "README.md is not a page of charts");
    refused("chart a.sdf b/a.sdf -o out", "two of the scenes are called a");
    refused("chart a.sdf -o out --json f.json", "--json is for one scene without a folder");
    assert_eq!(names(&folder.path().join("out")), Vec::<String>::new());
}

#[test]
fn binary_bytes_are_reported() {
    let folder = folder(&[]);
    std::fs::write(folder.path().join("a.sdf"), b"sphere(1)\n\xff\xfe\x00").unwrap();
    unreadable(folder.path(), "a.sdf", &["a.sdf is not UTF-8 text", "offset 10"]);
    // These bytes are UTF-8.
    wrong("sphere(1)\n\0\x01\x02\n", &["2:1"]);
}

#[test]
fn a_file_of_100_mb_is_refused() {
    let folder = folder(&[]);
    std::fs::File::create(folder.path().join("a.sdf")).unwrap().set_len(100 << 20).unwrap();
    unreadable(folder.path(), "a.sdf", &["a.sdf is larger than 64 MiB"]);
    let long = format!("sphere(1)\n{}", "// so it goes\n".repeat(400_000));
    wrong(&long, &["at most 4194304"]);
}

#[test]
fn a_byte_order_mark_and_crlf_are_accepted() {
    let folder = folder(&[]);
    let scene = b"\xef\xbb\xbfsphere(1)\r\nplane(y: -1)\r\n";
    ends(folder.path(), "check -", scene, 0, &[]);
    ends(folder.path(), "render - -o out.png --backend cpu --size 8x8", scene, 0, &[]);
    let scene = b"\xef\xbb\xbfsphere(1)\r\nspere(1)\r\n";
    ends(folder.path(), "check -", scene, 1, &["2:1"]);
}

#[test]
fn unclosed_brackets_are_reported() {
    wrong("sphere((1\n", &["E01"]);
    wrong("union([sphere(1), box(1)\n", &["E01"]);
    wrong(&"(".repeat(100_000), &["E01"]);
    wrong(&format!("let a = {}1", "[".repeat(50_000)), &["E01"]);
}

#[test]
fn unknown_names_are_reported() {
    wrong("spere(1)\n", &["E0201", "did you mean `sphere`?"]);
    wrong("sphere(radius: 1)\n", &["radius"]);
    wrong("import a from \"none.sdf\"\na\n", &["none.sdf"]);
}

#[test]
fn wrong_types_are_reported() {
    wrong("sphere(\"big\")\n", &["E03"]);
    wrong("sphere(1).rotate(x: 90)\n", &["E0304", "90deg"]);
    wrong("sphere(1) + 1\n", &["E03"]);
}

#[test]
fn numbers_that_are_not_finite_are_reported() {
    wrong("sphere(1e999)\n", &["too large"]);
    wrong("sphere(nan)\n", &["unknown name"]);
    wrong("sphere(sqrt(-1))\n", &["shaders need finite numbers"]);
    wrong("sphere(inf)\n", &["inf"]);
    wrong("sphere(1).translate(inf)\n", &["inf"]);
}

#[test]
fn division_by_a_constant_zero_is_reported() {
    wrong("sphere(1 / 0)\n", &["shaders need finite numbers"]);
    wrong("let a = 0\nsphere(1 % a)\n", &["shaders need finite numbers"]);
}

/// No command accepts a scene that another one refuses.
#[test]
fn a_violated_clause_is_reported() {
    wrong("solid egg() exact = length(p * [1, 0.7, 1]) - 1\negg()\n", &["E0502", "`exact`"]);
}

#[test]
fn settings_without_a_value_are_reported() {
    wrong("sun(direction: [1, 0, 0] / sphere(1)([1, 0, 0]))\nsphere(1)\n", &["E0311", "1:16"]);
    wrong("sun(direction: 0)\nsphere(1)\n", &["E0309", "1:16"]);
    wrong("camera(eye: [0, 0, 1], target: [0, 0, 1])\nsphere(1)\n", &["E0309", "one point"]);
    let spot = "spot_light([0, 2, 0], target: [0, 2, 0])\nsphere(1)\n";
    wrong(spot, &["E0309", "stands at its target"]);
}

#[test]
fn values_that_make_no_shape_are_reported() {
    wrong("plane(normal: [0, 0, 0])\n", &["normal"]);
    wrong("sphere(-1)\n", &["E0309", "`r` is -1"]);
    wrong("sphere(1).scale(0)\n", &["E0"]);
    // Cameras may depend on time, so this is known only when a frame is drawn.
    let blind = b"camera(eye: [0, 0, time], target: [0, 0, 0])\nsphere(1)\n";
    let args = "render - -o out.png --backend cpu";
    ends(folder(&[]).path(), args, blind, 1, &["eye and target are one point"]);
}

#[test]
fn wrong_sizes_of_pictures_are_refused() {
    let folder = folder(&[("a.sdf", BALL)]);
    for (size, words) in [
        ("0x4", "at least 1"),
        ("4x0", "at least 1"),
        ("99999999x1", "at most"),
        ("16384x16384", "at most"),
        ("99999999999999999999x1", "640x400"),
        ("4", "640x400"),
    ] {
        ends(folder.path(), &format!("render a.sdf --size {size}"), b"", 2, &[words]);
    }
}

#[test]
fn outputs_that_cannot_be_written_are_reported() {
    let folder = folder(&[("a.sdf", BALL)]);
    std::fs::create_dir(folder.path().join("taken.png")).unwrap();
    for args in [
        "render a.sdf -o none/a.png",
        "render a.sdf -o taken.png",
        "render a.sdf -o none/a.png --frames 0..3",
        "render a.sdf -o none/a.gif --frames 0..3",
        "render a.sdf --depth none/z.exr",
        "render a.sdf --stats none/a.json",
        "compile a.sdf -o none/a.wgsl",
        "compile a.sdf -o a.sdf/a.wgsl",
    ] {
        ends(folder.path(), args, b"", 3, &["cannot write"]);
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_reported() {
    let folder = folder(&[("a.sdf", BALL)]);
    for args in [
        "render a.sdf -o /dev/full --backend cpu --size 8x8",
        "render a.sdf -o a.png --backend cpu --size 8x8 --stats /dev/full",
        "compile a.sdf -o /dev/full",
    ] {
        let output = run(&folder, args);
        assert_eq!(output.status.code(), Some(3), "{args}: {}", said(&output));
        assert!(said(&output).contains("No space left"), "{args}: {}", said(&output));
    }
    for args in ["compile a.sdf", "explain a.sdf --json", "render a.sdf -o - --backend cpu"] {
        let output = shell(&folder, &format!("{args} > /dev/full"));
        assert_eq!(output.status.code(), Some(3), "{args}: {}", said(&output));
        assert!(said(&output).contains("cannot write to stdout: No space left"), "{args}");
    }
}

/// Runs the program by the shell, which splits the arguments and redirects.
#[cfg(target_os = "linux")]
fn shell(folder: &tempfile::TempDir, args: &str) -> std::process::Output {
    let binary = env!("CARGO_BIN_EXE_sdfc");
    std::process::Command::new("sh")
        .args(["-c", &format!("exec '{binary}' {args}")])
        .current_dir(folder.path())
        .output()
        .unwrap()
}

/// Sends Ctrl-C when the first file of a sequence exists.
#[test]
#[cfg(unix)]
fn ctrl_c_leaves_whole_frames_of_a_sequence() {
    use std::process::{Command, Stdio};
    let folder = folder(&[("a.sdf", BALL)]);
    let frames =
        "render a.sdf -o a.png --depth z.exr --backend cpu --size 64x40 --frames 0..100000";
    let child = Command::new(env!("CARGO_BIN_EXE_sdfc"))
        .args(frames.split(' '))
        .current_dir(folder.path())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    while !folder.path().join("z.0001.exr").exists() {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    assert!(said(&output).contains("of 100000 frames"), "{}", said(&output));
    let names = names(folder.path());
    let pictures: Vec<_> = names.iter().filter(|name| name.starts_with("a.0")).collect();
    assert_eq!(names.len(), 1 + 2 * pictures.len(), "{names:?}");
    for name in pictures {
        let file = std::fs::read(folder.path().join(name)).unwrap();
        assert!(image::load_from_memory(&file).is_ok(), "{name} is not whole");
    }
}

/// An animation is one file, which is not written if it is interrupted.
#[test]
#[cfg(unix)]
fn ctrl_c_leaves_no_partial_animation() {
    use std::process::{Command, Stdio};
    let folder = folder(&[("a.sdf", BALL)]);
    let frames =
        "render a.sdf -o a.gif --depth z.exr --backend cpu --size 64x40 --frames 0..100000";
    let child = Command::new(env!("CARGO_BIN_EXE_sdfc"))
        .args(frames.split(' '))
        .current_dir(folder.path())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !folder.path().join("z.0000.exr").exists() {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130));
    assert!(names(folder.path()).iter().all(|name| name == "a.sdf" || name.starts_with("z.0")));
}

#[test]
fn a_misspelt_param_is_answered_with_its_name() {
    let folder = folder(&[("door.sdf", "param open = 0.5 in 0..1\nsphere(open)\n")]);
    let words = ["the scene has no param `opn`; did you mean `open`?"];
    ends(folder.path(), "explain door.sdf --set opn=1", b"", 2, &words);
}

#[test]
fn names_of_openscad_are_answered() {
    wrong("module foo() = 1\nsphere(1)\n", &["`fn foo(x) = ...`", "`solid foo() = ...`"]);
    wrong("include <a.scad>\nsphere(1)\n", &["`import name from \"file.sdf\"`"]);
    wrong("hull(box(1))\n", &["there is no convex hull", "`round_cone(a, b, r1, r2)`"]);
    wrong("minkowski(box(1), sphere(1))\n", &["`a.round(0.1)`"]);
    wrong("round_cone(ra: 1, rb: 2)\n", &["did you mean `r1`?", "did you mean `r2`?"]);
}

#[test]
fn copies_without_limits_are_cut() {
    let scene = |cut: &str| {
        format!(
            "region wave(k: number) = p.y - 0.1 * k * sin(p.x)\n\
             repeat(fn(c) = wave(hash(1, c)){cut}, spacing: 1)\n"
        )
    };
    wrong(&scene(""), &["cut them with `& circle(0.2)`"]);
    let folder = folder(&[]);
    ends(folder.path(), "check -", scene(" & circle(0.2)").as_bytes(), 0, &[]);
    wrong("repeat(plane(), spacing: 1)\n", &["cut them with `& sphere(0.2)`"]);
}
