//! The shaders of two scenes can be pasted into one file.

use std::collections::BTreeSet;

use libtest_mimic::Failed;
use rayon::prelude::*;
use sdfc::{Code, Compiler, Emit, Scene, ShaderOptions, Stage, Target};
use sdfc_tests::compiled_examples;

use sdfc_tests::validators::{Part, Tool};

const TEXT_TARGETS: [Target; 5] =
    [Target::Wgsl, Target::Glsl, Target::GlslEs, Target::Hlsl, Target::Msl];

/// Lists of numbers and points that are short enough to be constants of the shader. No example has
/// such.
const SHORT_LISTS: &str = "let heights = [for i in 0..9: 0.05 * i * i]
let places = [for i in 0..5: [i, 0.1 * i * i, 0]]
solid steps() = 0.5 * (p.y - heights[floor(clamp(p.x, 0, 8))])
solid dots() = length(p - places[floor(clamp(p.x, 0, 4))]) - 0.2
(steps() & box(4)) | dots()";

/// Writes every example twice with different prefixes and bindings. No name is declared by both,
/// and installed validators accept them in one file.
pub fn two_prefixes_go_into_one_file() -> Result<(), Failed> {
    let lists = Compiler::new().compile("short lists", SHORT_LISTS).map_err(|e| e.to_string())?;
    let examples = compiled_examples()?.iter().map(|(name, scene)| (name.as_str(), scene));
    let scenes: Vec<(&str, &Scene)> = examples.chain([("short lists", &lists)]).collect();
    for target in TEXT_TARGETS {
        let pasted = scenes.par_iter().flat_map_iter(|(name, scene)| pasted(name, scene, target));
        let pasted: Vec<(String, Part, Code)> = pasted.collect::<Result<_, Failed>>()?;
        if let Some(tool) = Tool::of(target) {
            tool.check_all(pasted.iter().map(|(name, part, code)| (name.clone(), *part, code)))?;
        }
    }
    Ok(())
}

/// Returns the functions of a scene twice in one file, for each part that has a prefix, with a name
/// for messages.
fn pasted(
    name: &str,
    scene: &Scene,
    target: Target,
) -> impl Iterator<Item = Result<(String, Part, Code), Failed>> {
    // Regions have no rays to march.
    let emits = [Emit::Field, Emit::March].into_iter();
    let emits = emits.filter(|emit| *emit != Emit::March || !scene.is_planar());
    emits.map(move |emit| {
        let label = format!("{name} as {}, {emit:?}", target.name());
        let [one, other] = [("one_", 0), ("other_", 1)]
            .map(|(prefix, binding)| text(scene, target, emit, prefix, binding));
        let (one, other) = (one?, other?);
        let both = declared(&one).intersection(&declared(&other)).cloned().collect::<Vec<_>>();
        if !both.is_empty() {
            return Err(format!("{label}: both declare {}", both.join(", ")).into());
        }
        let part = Part { name: "both", emit, stage: Stage::Fragment };
        Ok((label, part, Code::Text(format!("{one}{}", pasteable(&other, target)))))
    })
}

fn text(
    scene: &Scene,
    target: Target,
    emit: Emit,
    prefix: &str,
    binding: u32,
) -> Result<String, Failed> {
    let prefix = prefix.to_owned();
    let options = ShaderOptions::new().target(target).emit(emit).prefix(prefix).binding(binding);
    match scene.write_shader(&options)?.code {
        Code::Text(text) => Ok(text),
        Code::Words(_) => Err("no text".into()),
    }
}

/// Returns the source without the lines that a file has once: in GLSL the version and the empty
/// stage, as `docs/targets.md` explains.
fn pasteable(text: &str, target: Target) -> &str {
    match target {
        Target::Glsl | Target::GlslEs => {
            let text = text.split_once('\n').map_or(text, |(_version, rest)| rest);
            text.rfind("void main()").map_or(text, |end| &text[..end])
        }
        Target::Wgsl | Target::Hlsl | Target::Msl | Target::Spirv | Target::Shadertoy => text,
    }
}

/// Returns the names before `(`, `{` or `=` in lines that begin a declaration, except the stage.
fn declared(text: &str) -> BTreeSet<String> {
    let heads = text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_alphabetic()));
    let names = heads.filter_map(|line| {
        let head = line.split(['(', '{', '=', ':', ';']).next()?.trim_end();
        let name = head.split_whitespace().next_back()?;
        (name != "main" && head.contains(' ')).then(|| name.to_owned())
    });
    let shared = ["using metal", "using", "metal", "precision highp float", "float", "int"];
    names.filter(|name| !shared.contains(&name.as_str())).collect()
}
