//! Every example can be written in every target, is accepted by every installed validator, and is
//! listed in `docs/targets.md`.
//!
//! Tests of tools that are not installed are reported as ignored. After a change to the targets, or
//! a new example, `TARGETS_UPDATE=1 cargo test -p sdfc-tests --test targets` rewrites the table.

mod draw;
mod paste;
mod table;

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{Scene, Target};
use sdfc_render::testing;
use sdfc_tests::compiled_examples;
use sdfc_tests::validators::{PARTS, TOOLS, Tool, is_written, write};

fn main() {
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

/// Draws a scene in two ways and compares the pictures.
type Compared = fn(&draw::Devices, &Scene) -> Result<(), Failed>;

fn every_example_is_drawn(compared: Compared) -> Result<(), Failed> {
    let devices = draw::Devices::open()?;
    for (name, scene) in compiled_examples()? {
        compared(&devices, &scene)
            .map_err(|error| format!("{name}: {}", error.message().unwrap_or("")))?;
    }
    Ok(())
}

fn every_example_is_written(target: Target) -> Result<(), Failed> {
    for (name, scene) in compiled_examples()? {
        for part in PARTS {
            let written = write(&scene, target, part);
            if written.is_ok() != is_written(&scene, target, part) {
                return Err(format!("{name}, {}: {:?}", part.name, written.map(drop)).into());
            }
        }
    }
    Ok(())
}

fn every_example_is_accepted(tool: &Tool) -> Result<(), Failed> {
    for (name, scene) in compiled_examples()? {
        for part in PARTS.into_iter().filter(|part| is_written(&scene, tool.target, *part)) {
            let code = write(&scene, tool.target, part).map_err(|e| e.to_string())?;
            let label = format!("{name}, {}", part.name);
            tool.check(part, &code).map_err(|error| format!("{label}: {error}"))?;
        }
    }
    Ok(())
}

fn the_same_source_gives_the_same_bytes() -> Result<(), Failed> {
    let twins = compiled_examples()?;
    for ((name, scene), (_, twin)) in compiled_examples()?.iter().zip(&twins) {
        for target in Target::ALL {
            for part in PARTS.into_iter().filter(|part| is_written(scene, target, *part)) {
                let [one, other] = [scene, twin].map(|s| write(s, target, part));
                if one.map_err(|e| e.to_string())? != other.map_err(|e| e.to_string())? {
                    return Err(format!("{name} as {}: the sources differ", target.name()).into());
                }
            }
        }
    }
    Ok(())
}
