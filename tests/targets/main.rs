//! Every example can be written in every target, is accepted by every installed validator, and is
//! listed in `docs/targets.md`.
//!
//! Tests of tools that are not installed are reported as ignored. After a change to the targets, or
//! a new example, `TARGETS_UPDATE=1 cargo test -p sdfc-tests --test targets` rewrites the table.

mod draw;
mod paste;
mod table;
mod written;

use std::collections::BTreeMap;

use libtest_mimic::{Arguments, Failed, Trial};
use rayon::prelude::*;
use sdfc::{Scene, Target};
use sdfc_render::testing;
use sdfc_tests::validators::{TOOLS, Tool, is_written, write};
use sdfc_tests::{compile_examples, compiled_examples};
use written::Written;

/// What makes Mesa's software drivers compile without optimisation. The tests draw small pictures
/// with hundreds of shaders, and compiling takes nearly all of their time: half as long this way.
const UNOPTIMISED: (&str, &str) = ("GALLIVM_PERF", "nopt");

fn main() {
    if std::env::var_os(UNOPTIMISED.0).is_none()
        && let Some(code) = unoptimised()
    {
        std::process::exit(code);
    }
    let mut trials = vec![
        Trial::test("two_prefixes_go_into_one_file", paste::two_prefixes_go_into_one_file),
        Trial::test("the_table_is_current", table::is_current),
        Trial::test("the_same_source_gives_the_same_bytes", the_same_source_gives_the_same_bytes),
    ];
    for target in Target::ALL {
        let name = format!("every_example_is_written_as_{}", target.name());
        trials.push(Trial::test(name, move || every_example_is_written(target)));
    }
    for tool in TOOLS {
        let name = format!("{}_accepts_{}", tool.program, tool.target.name());
        let trial = Trial::test(name, move || every_example_is_accepted(tool));
        trials.push(trial.with_ignored_flag(!tool.is_installed()));
    }
    let forms: [(&str, Compared); 3] =
        [("compute", draw::compute), ("fragment", draw::fragment), ("shadertoy", draw::shadertoy)];
    for (name, form) in forms {
        let name = format!("every_example_is_drawn_as_{name}");
        let trial = Trial::test(name, move || every_example_is_drawn(form));
        trials.push(trial.with_ignored_flag(testing::without_gpu()));
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// Runs this program with the variable set, which drivers read once; `None` if that fails.
fn unoptimised() -> Option<i32> {
    let (name, value) = UNOPTIMISED;
    let mut command = std::process::Command::new(std::env::current_exe().ok()?);
    command.args(std::env::args_os().skip(1)).env(name, value).status().ok()?.code()
}

/// Draws a scene in two ways and compares the pictures.
type Compared = fn(&draw::Devices, &Scene) -> Result<(), Failed>;

fn every_example_is_drawn(compared: Compared) -> Result<(), Failed> {
    let devices = draw::Devices::open()?;
    for (name, scene) in compiled_examples()? {
        compared(&devices, scene)
            .map_err(|error| format!("{name}: {}", error.message().unwrap_or("")))?;
    }
    Ok(())
}

fn every_example_is_written(target: Target) -> Result<(), Failed> {
    for Written { example, scene, part, code, .. } in of_target(target)? {
        if code.is_ok() != is_written(scene, target, *part) {
            return Err(format!("{example}, {}: {:?}", part.name, code.as_ref().map(drop)).into());
        }
    }
    Ok(())
}

fn every_example_is_accepted(tool: &Tool) -> Result<(), Failed> {
    let mut codes = Vec::new();
    for Written { example, scene, part, code, .. } in of_target(tool.target)? {
        if is_written(scene, tool.target, *part) {
            let label = format!("{example}, {}", part.name);
            codes.push((label, *part, code.as_ref()?));
        }
    }
    Ok(tool.check_all(codes)?)
}

fn of_target(target: Target) -> Result<impl Iterator<Item = &'static Written>, Failed> {
    Ok(written::all()?.iter().filter(move |written| written.target == target))
}

fn the_same_source_gives_the_same_bytes() -> Result<(), Failed> {
    let twins: BTreeMap<String, Scene> = compile_examples()?.into_iter().collect();
    let differs = |written: &&Written| {
        let twin = write(&twins[written.example], written.target, written.part);
        twin.map_err(|e| e.to_string()) != written.code
    };
    match written::all()?.par_iter().find_any(differs) {
        Some(Written { example, target, .. }) => {
            Err(format!("{example} as {}: the sources differ", target.name()).into())
        }
        None => Ok(()),
    }
}
