//! A lost device gives a clear error, status 3 and no partial output. The program loses its device
//! on purpose, which needs a build with debug assertions. Without them or without a GPU these tests
//! are ignored. Other tests that need a GPU are here too.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::process::{Command, Stdio};
use std::time::Duration;

use common::{folder, names, run_in, said};
use libtest_mimic::{Arguments, Failed, Trial};
use sdfc_render::testing::{LOSE_DEVICE, without_gpu};

/// A picture of the tests has fewer calls.
const MAX_CALLS: u32 = 100;
const BALL: &str = "sphere(0.8)\nplane(y: -0.8)\n";

fn main() {
    let ignored = without_gpu() || !cfg!(debug_assertions);
    let trials = vec![
        Trial::test("a device lost once at any call draws the same picture", lost_at_each_call),
        Trial::test("a device lost twice leaves no output", no_output),
        Trial::test(
            "a device lost in the middle of a sequence leaves whole frames",
            a_sequence_keeps_whole_frames,
        ),
        Trial::test("a device lost while measuring leaves no output", while_measuring),
    ];
    let mut trials: Vec<Trial> =
        trials.into_iter().map(|trial| trial.with_ignored_flag(ignored)).collect();
    let charts = Trial::test("a folder gets all charts", a_folder_gets_all_charts);
    trials.push(charts.with_ignored_flag(without_gpu()));
    let tuned =
        Trial::test("metrics are written without a result", metrics_are_written_without_a_result);
    trials.push(tuned.with_ignored_flag(without_gpu()));
    let sampled = Trial::test("samples a step apart prove nothing", samples_prove_nothing);
    trials.push(sampled.with_ignored_flag(without_gpu()));
    let stopped =
        Trial::test("stopped measurements keep the scenes before", stopped_measurements_are_kept);
    trials.push(stopped.with_ignored_flag(without_gpu()));
    let steep = Trial::test("too few steps name the steepest shape", too_few_steps_name_a_shape);
    trials.push(steep.with_ignored_flag(without_gpu()));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// A method that takes samples a step apart may miss a part of a certified field, too.
fn samples_prove_nothing() -> Result<(), Failed> {
    let folder = folder(&[("a.sdf", BALL)]);
    let args = "render a.sdf --size 24x16 -o a.png --strict";
    let certified = run_in(folder.path(), args, b"", &[]);
    if certified.status.code() != Some(0) {
        return Err(said(&certified).into());
    }
    let sampled = run_in(folder.path(), &format!("{args} --march fixed"), b"", &[]);
    if sampled.status.code() != Some(1) || !said(&sampled).contains("384 of 384 pixels") {
        return Err(format!("{:?}, {}", sampled.status, said(&sampled)).into());
    }
    Ok(())
}

fn too_few_steps_name_a_shape() -> Result<(), Failed> {
    let scene = "solid steep() lipschitz 8 = 8 * (length(p) - 1)\nsteep()\nmarch(steps: 6)\n";
    let folder = folder(&[("a.sdf", scene)]);
    let args = "render a.sdf --size 24x16 -o a.png --march sphere";
    let said = said(&run_in(folder.path(), args, b"", &[]));
    let advice = "steps are 8 times shorter because of the Lipschitz constant of `steep`";
    if said.contains("ran out of steps") && said.contains(advice) {
        Ok(())
    } else {
        Err(said.into())
    }
}

/// Numbers of calls, from one to the most that a picture takes.
fn calls(from: u32) -> String {
    (from..2000).map(|call| call.to_string()).collect::<Vec<_>>().join(",")
}

/// Runs the program with a device that is lost at these calls, and fails for that. Returns the
/// folder and the names of the files in it.
fn lost(at: &str, args: &str) -> Result<(tempfile::TempDir, Vec<String>), Failed> {
    let folder = folder(&[("a.sdf", BALL)]);
    let output = run_in(folder.path(), args, b"", &[(LOSE_DEVICE, at)]);
    let said = said(&output);
    if output.status.code() != Some(3) || !output.stdout.is_empty() {
        return Err(format!("{args}: {:?}, {said}", output.status).into());
    }
    if !said.contains("the device was lost") || said.contains("panicked") {
        return Err(format!("{args}: {said}").into());
    }
    let names = names(folder.path());
    Ok((folder, names))
}

/// Loses the device at the first call, at the second and so on, until a picture has no more calls.
fn lost_at_each_call() -> Result<(), Failed> {
    let args = "render a.sdf -o a.png --size 48x32 --backend gpu";
    let folder = folder(&[("a.sdf", BALL)]);
    let picture = || -> Result<_, Failed> { Ok(image::open(folder.path().join("a.png"))?) };
    run_in(folder.path(), args, b"", &[]);
    let expected = picture()?;
    let mut was_lost = false;
    for call in 0..MAX_CALLS {
        std::fs::remove_file(folder.path().join("a.png"))?;
        let output = run_in(folder.path(), args, b"", &[(LOSE_DEVICE, &call.to_string())]);
        let said = said(&output);
        if !output.status.success() || said.contains("panicked") || picture()? != expected {
            return Err(format!("call {call}: {:?}, {said}", output.status).into());
        }
        if said.contains("the device was lost once") {
            was_lost = true;
            continue;
        }
        // The first calls compile the shader, and are repeated in silence.
        let is_drawn_at_once = call > 8;
        if is_drawn_at_once {
            return if was_lost { Ok(()) } else { Err("no call lost the device".into()) };
        }
    }
    Err(format!("the device was lost at each of {MAX_CALLS} calls").into())
}

fn no_output() -> Result<(), Failed> {
    for args in [
        "render a.sdf -o a.png --depth z.exr --stats s.json --size 128x80",
        "render a.sdf -o - --size 128x80 --backend gpu",
        "render a.sdf -o a.gif --frames 0..3 --size 128x80 --backend gpu",
    ] {
        for first in [0, 12, 20] {
            let (_, names) = lost(&calls(first), args)?;
            if names != ["a.sdf"] {
                return Err(format!("{args}: left {names:?}").into());
            }
        }
    }
    Ok(())
}

fn a_sequence_keeps_whole_frames() -> Result<(), Failed> {
    let (folder, names) = lost(&calls(100), "render a.sdf -o a.png --frames 0..1000 --size 24x16")?;
    let pictures: Vec<_> = names.iter().filter(|name| name.ends_with(".png")).collect();
    if names.len() != pictures.len() + 1 || !(1..100).contains(&pictures.len()) {
        return Err(format!("left {names:?}").into());
    }
    for name in pictures {
        image::load_from_memory(&std::fs::read(folder.path().join(name))?)?;
    }
    Ok(())
}

/// A page is written, and for each scene both pictures and the metrics.
fn a_folder_gets_all_charts() -> Result<(), Failed> {
    let folder = folder(&[("a.sdf", BALL), ("b.sdf", "box(1)")]);
    std::fs::create_dir(folder.path().join("charts"))?;
    let args =
        "chart a.sdf b.sdf -o charts --size 12x8 --march auto,fixed --note today --cache kept";
    let output = run_in(folder.path(), args, b"", &[]);
    let written = folder.path().join("charts");
    let expected = ["README.md", "a.json", "a.png", "a.svg", "b.json", "b.png", "b.svg"];
    if !output.status.success() || names(&written) != expected {
        return Err(format!("{}: {:?}", said(&output), names(&written)).into());
    }
    let page = std::fs::read_to_string(written.join("README.md"))?;
    let svg = std::fs::read_to_string(written.join("a.svg"))?;
    image::open(written.join("a.png"))?;
    let is_complete = page.contains("12x8") && page.contains("today") && svg.contains("today");
    if is_complete { Ok(()) } else { Err(page.into()) }
}

fn while_measuring() -> Result<(), Failed> {
    let (_, names) = lost("40", "bench a.sdf --size 32x20 --json b.json")?;
    if names != ["a.sdf"] { Err(format!("left {names:?}").into()) } else { Ok(()) }
}

/// Ctrl-C in a later scene leaves the results of the first.
fn stopped_measurements_are_kept() -> Result<(), Failed> {
    let folder = folder(&[("a.sdf", BALL)]);
    let results = folder.path().join("b.json");
    let mut process = Command::new(env!("CARGO_BIN_EXE_sdfc"))
        .args("bench a.sdf --suite --size 24x16 --json b.json".split(' '))
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    while !results.exists() && process.try_wait()?.is_none() {
        std::thread::sleep(Duration::from_millis(20));
    }
    Command::new("kill").args(["-INT", &process.id().to_string()]).status()?;
    let output = process.wait_with_output()?;
    let said = said(&output);
    let is_said = said.contains("stopped after") && said.contains("they are in b.json");
    if output.status.code() != Some(130) || !is_said {
        return Err(format!("{:?}, {said}", output.status).into());
    }
    let report: serde_json::Value = serde_json::from_slice(&std::fs::read(results)?)?;
    let has_first = report["rows"][0]["scene"] == "a.sdf";
    let printed = String::from_utf8_lossy(&output.stdout).contains("a.sdf: ");
    if has_first && printed { Ok(()) } else { Err(report.to_string().into()) }
}

/// The metrics are written even if no method reaches the error.
fn metrics_are_written_without_a_result() -> Result<(), Failed> {
    let folder = folder(&[("a.sdf", "sphere(0.8).twist(90deg)\n")]);
    let args = "tune a.sdf --size 24x16 --max-error 1e-30 --json t.json --no-cache --march sphere";
    let output = run_in(folder.path(), args, b"", &[]);
    let said = said(&output);
    if output.status.code() != Some(2) || !said.contains("no method reaches") {
        return Err(format!("{:?}, {said}", output.status).into());
    }
    let metrics: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("t.json"))?)?;
    if metrics["methods"].as_array().is_none_or(Vec::is_empty) {
        return Err("no metrics".into());
    }
    Ok(())
}
