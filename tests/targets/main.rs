//! Every example in every target: written, validated by each tool that is here, and listed in
//! `docs/targets.md`.
//!
//! A trial whose tool is not installed is reported as ignored. After a change to what can be written,
//! or a new example, `TARGETS_UPDATE=1 cargo test -p sdfc --test targets` writes the table anew.

mod table;
mod tools;

use std::path::{Path, PathBuf};

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc::{Code, Emit, Scene, ShaderOptions, Target};

/// The parts that are written.
pub const EMITS: [(Emit, &str); 2] = [(Emit::Field, "field"), (Emit::Render, "render")];

fn main() {
    let mut trials = vec![
        Trial::test("the_table_is_current", table::is_current),
        Trial::test("the_same_source_gives_the_same_bytes", the_same_source_gives_the_same_bytes),
    ];
    for target in Target::ALL {
        let name = format!("every_example_is_written_as_{}", target.name());
        trials.push(Trial::test(name, move || every_example_is_written(target)));
    }
    for tool in tools::TOOLS {
        let name = format!("{}_accepts_{}", tool.program, tool.target.name());
        let trial = Trial::test(name, move || every_example_is_accepted(tool));
        trials.push(trial.with_ignored_flag(!tool.is_installed()));
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// Whether a target's language has words for a part.
pub fn is_held(target: Target, emit: Emit) -> bool {
    !(target == Target::GlslEs && emit == Emit::Render)
}

fn write(scene: &Scene, target: Target, emit: Emit) -> Result<Code, sdfc::Error> {
    let options = ShaderOptions { target, emit, ..ShaderOptions::default() };
    Ok(scene.write_shader(&options)?.code)
}

fn every_example_is_written(target: Target) -> Result<(), Failed> {
    for (name, scene) in examples()? {
        for (emit, part) in EMITS {
            let found = write(&scene, target, emit);
            if found.is_ok() != is_held(target, emit) {
                return Err(format!("{name}, {part}: {:?}", found.map(drop)).into());
            }
        }
    }
    Ok(())
}

fn every_example_is_accepted(tool: &tools::Tool) -> Result<(), Failed> {
    for (name, scene) in examples()? {
        for (emit, part) in EMITS.into_iter().filter(|part| is_held(tool.target, part.0)) {
            let code = write(&scene, tool.target, emit).map_err(|e| e.to_string())?;
            tool.check(emit, &code).map_err(|found| format!("{name}, {part}: {found}"))?;
        }
    }
    Ok(())
}

fn the_same_source_gives_the_same_bytes() -> Result<(), Failed> {
    let again = examples()?;
    for ((name, scene), (_, twin)) in examples()?.iter().zip(&again) {
        for target in Target::ALL {
            let [one, other] = [scene, twin].map(|s| write(s, target, Emit::Field));
            if one.map_err(|e| e.to_string())? != other.map_err(|e| e.to_string())? {
                return Err(format!("{name} as {}: two texts", target.name()).into());
            }
        }
    }
    Ok(())
}

/// Name and scene of each example, in order of name.
pub fn examples() -> Result<Vec<(String, Scene)>, Failed> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut paths = Vec::new();
    scene_files(&folder, &mut paths)?;
    paths.sort();
    let mut found = Vec::new();
    for path in paths {
        let name = path.strip_prefix(&folder)?.display().to_string().replace('\\', "/");
        let text = std::fs::read_to_string(&path)?.replace("\r\n", "\n");
        let scene = sdfc::compile_with_imports(&name, &text, &Beside(&path)).scene;
        found.push((name.clone(), scene.ok_or(format!("{name} does not compile"))?));
    }
    if found.is_empty() { Err("no examples were found".into()) } else { Ok(found) }
}

/// Files below the folder of a scene.
struct Beside<'a>(&'a Path);

impl sdfc::Resolver for Beside<'_> {
    fn read(&self, path: &str) -> Result<String, String> {
        std::fs::read_to_string(self.0.with_file_name(path)).map_err(|e| e.to_string())
    }
}

fn scene_files(folder: &Path, found: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            scene_files(&path, found)?;
        } else if path.extension().is_some_and(|e| e == "sdf") {
            found.push(path);
        }
    }
    Ok(())
}
