//! The compiler's field functions have no more instructions than hand-written ones. README.md
//! explains what is counted.
//!
//! Without `spirv-opt`, the tests that count are reported as ignored.

mod run;
mod spirv;
mod thirty;

use libtest_mimic::{Arguments, Failed, Trial};
use sdfc_tests::repository;

/// The scenes that have a hand-written field.
const SCENES: [(&str, &str); 2] =
    [("blend", "examples/course/blend.sdf"), ("thirty", "examples/bench/thirty.sdf")];

/// The entry point that the hand-written files have, for the compiler's function.
const ENTRY: &str = "
@group(0) @binding(0) var<storage, read_write> sample: vec4f;

@compute @workgroup_size(1)
fn main() {
    sample.w = sdf_distance(sample.xyz);
}
";

/// The hand-written fields and their arithmetic instructions, as the table in README.md has them.
const HAND_WRITTEN: [(&str, usize); 4] =
    [("blend", 21), ("thirty", 421), ("tight/blend", 19), ("tight/thirty", 371)];

fn main() {
    let countable = spirv::has_optimizer();
    let counting = |name: String, run: fn(&str) -> Result<(), Failed>, of: &'static str| {
        Trial::test(name, move || run(of)).with_ignored_flag(!countable)
    };
    let mut trials = vec![Trial::test("generated_files_are_current", generated_files_are_current)];
    for (name, _) in HAND_WRITTEN {
        trials.push(counting(
            format!("hand_written_{name}_has_the_stated_count"),
            has_stated_count,
            name,
        ));
    }
    for name in ["blend", "thirty"] {
        trials.push(counting(
            format!("tight_{name}_is_the_same_field"),
            tight_form_is_the_same_field,
            name,
        ));
    }
    for (name, _) in SCENES {
        trials.push(counting(
            format!("emitted_{name}_has_no_more_instructions"),
            emitted_is_no_longer,
            name,
        ));
        trials.push(counting(
            format!("emitted_{name}_is_the_same_field"),
            emitted_is_the_same,
            name,
        ));
    }
    trials.push(counting(
        "hand_written_blend_is_its_formula".into(),
        blend_is_its_formula,
        "blend",
    ));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn generated_files_are_current() -> Result<(), Failed> {
    for (path, text) in thirty::files() {
        if std::env::var_os("HAND_WRITTEN_UPDATE").is_some() {
            std::fs::write(repository().join(path), &text)?;
        }
        if std::fs::read_to_string(repository().join(path))?.replace("\r\n", "\n") != text {
            return Err(
                format!("{path} is out of date; rewrite it with HAND_WRITTEN_UPDATE=1").into()
            );
        }
    }
    Ok(())
}

fn hand_written(name: &str) -> Result<spirv::Words, Failed> {
    let wgsl =
        std::fs::read_to_string(repository().join(format!("tests/hand_written/{name}.wgsl")))?;
    Ok(spirv::optimize(&spirv::compile(&wgsl)?)?)
}

fn has_stated_count(name: &str) -> Result<(), Failed> {
    let stated = HAND_WRITTEN.iter().find(|row| row.0 == name).map(|row| row.1);
    let counted = spirv::arithmetic(&hand_written(name)?);
    if stated != Some(counted) {
        return Err(format!("{name}: {counted} arithmetic instructions, stated {stated:?}").into());
    }
    let row = format!("| {counted} |");
    let readme = std::fs::read_to_string(repository().join("tests/hand_written/README.md"))?;
    let start = format!("| `{name}.wgsl` |");
    if !readme.lines().any(|line| line.starts_with(&start) && line.ends_with(&row)) {
        return Err(format!("README.md has no row for {name} with {counted}").into());
    }
    Ok(())
}

/// Returns the field that the compiler emits for a scene, optimised.
fn emitted(name: &str) -> Result<spirv::Words, Failed> {
    let path = SCENES.iter().find(|row| row.0 == name).map_or("", |row| row.1);
    let text = std::fs::read_to_string(repository().join(path))?;
    let scene = sdfc::Compiler::new().compile(path, &text)?;
    let options =
        sdfc::FieldOptions { gradient: false, material: false, ..sdfc::FieldOptions::default() };
    let wgsl = scene.field_shader(&options)?.wgsl()? + ENTRY;
    Ok(spirv::optimize(&spirv::compile(&wgsl)?)?)
}

#[allow(clippy::print_stdout, reason = "the margin is worth seeing")]
fn emitted_is_no_longer(name: &str) -> Result<(), Failed> {
    let by_hand = spirv::arithmetic(&hand_written(name)?);
    let by_compiler = spirv::arithmetic(&emitted(name)?);
    println!("{name}: {by_compiler} arithmetic instructions emitted, {by_hand} by hand");
    if by_compiler > by_hand {
        return Err(format!("{name}: {by_compiler} emitted, {by_hand} by hand").into());
    }
    Ok(())
}

fn emitted_is_the_same(name: &str) -> Result<(), Failed> {
    let (by_hand, by_compiler) = (hand_written(name)?, emitted(name)?);
    compare(name, |p| Ok((run::field(&by_hand, p)?, run::field(&by_compiler, p)?)))
}

/// Returns points in and around the scenes, from a lattice that avoids their symmetries.
fn points() -> impl Iterator<Item = [f32; 3]> {
    // The plastic number's powers spread points evenly (Roberts 2018).
    const STEP: [f64; 3] = [0.819_172_5, 0.671_043_6, 0.549_700_5];
    (0..2000).map(|i| STEP.map(|step| ((0.5 + step * f64::from(i)).fract() * 6.0 - 3.0) as f32))
}

fn compare(
    name: &str,
    mut values: impl FnMut([f32; 3]) -> Result<(f32, f32), String>,
) -> Result<(), Failed> {
    for point in points() {
        let (a, b) = values(point)?;
        // A few roundings of numbers below 8, after another order of operations.
        if (a - b).abs() > 1e-5 {
            return Err(format!("{name} at {point:?}: {a} and {b}").into());
        }
    }
    Ok(())
}

fn tight_form_is_the_same_field(name: &str) -> Result<(), Failed> {
    let (plain, tight) = (hand_written(name)?, hand_written(&format!("tight/{name}"))?);
    compare(name, |p| Ok((run::field(&plain, p)?, run::field(&tight, p)?)))
}

/// Compares the interpreter and the hand-written field with the formula in f64.
fn blend_is_its_formula(name: &str) -> Result<(), Failed> {
    let words = hand_written(name)?;
    compare(name, |p| Ok((run::field(&words, p)?, blend(p.map(f64::from)) as f32)))
}

fn blend([x, y, z]: [f64; 3]) -> f64 {
    let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    let ball = length([x - 0.4, y - 0.7, z - 0.4]) - 0.8;
    let q = [x.abs() - 0.8, y.abs() - 0.5, z.abs() - 0.8];
    let block = length(q.map(|c| c.max(0.0))) + q[0].max(q[1]).max(q[2]).min(0.0);
    let h = (0.5 + 0.5 * (block - ball) / 0.4).clamp(0.0, 1.0);
    (block * (1.0 - h) + ball * h - 0.4 * h * (1.0 - h)).min(y + 0.5)
}
