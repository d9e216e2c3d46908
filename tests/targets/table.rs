//! The table in `docs/targets.md`.

use std::fmt::Write;

use libtest_mimic::Failed;
use sdfc::Target;
use sdfc_tests::repository;
use sdfc_tests::validators::TOOLS;

use crate::written;

const BEGIN: &str = "<!-- The table is written by tests/targets. -->\n";
const END: &str = "<!-- End of the table. -->\n";

/// Returns the programs that validate a target, besides the writer's own validator.
fn validators(target: Target) -> String {
    let tools = TOOLS.iter().filter(|tool| tool.target == target);
    let mut names: Vec<_> = tools.map(|tool| tool.program).collect();
    match target {
        Target::Wgsl | Target::GlslEs | Target::Shadertoy => names.push("Chromium"),
        Target::Glsl | Target::Hlsl | Target::Msl | Target::Spirv => {}
    }
    if names.is_empty() { "nothing else".to_owned() } else { names.join(", ") }
}

/// Returns the table: the validators, and one row for each example with the parts that can be
/// written.
fn table() -> Result<String, Failed> {
    let names = Target::ALL.map(Target::name);
    let mut text =
        format!("| example | {} |\n|---{}|\n", names.join(" | "), "|---".repeat(names.len()));
    writeln!(text, "| *validated by* | {} |", Target::ALL.map(validators).join(" | "))?;
    // The parts of an example are grouped by target.
    for of_example in written::all()?.chunk_by(|a, b| a.example == b.example) {
        let name = of_example.first().map_or("", |first| first.example);
        write!(text, "| {name} |")?;
        for of_target in of_example.chunk_by(|a, b| a.target == b.target) {
            let written = of_target.iter().filter(|written| written.code.is_ok());
            let parts: Vec<_> = written.map(|written| written.part.name).collect();
            write!(text, " {} |", parts.join(" "))?;
        }
        text.push('\n');
    }
    Ok(text)
}

pub fn is_current() -> Result<(), Failed> {
    let path = repository().join("docs/targets.md");
    let page = std::fs::read_to_string(&path)?.replace("\r\n", "\n");
    let parts = page.split_once(BEGIN).and_then(|(head, rest)| {
        let (found, tail) = rest.split_once(END)?;
        Some((head, found, tail))
    });
    let (head, found, tail) = parts.ok_or("docs/targets.md has no comments around its table")?;
    let table = table()?;
    if found == table {
        return Ok(());
    }
    if std::env::var_os("TARGETS_UPDATE").is_some() {
        std::fs::write(&path, format!("{head}{BEGIN}{table}{END}{tail}"))?;
        return Ok(());
    }
    Err("docs/targets.md is out of date; rewrite its table with TARGETS_UPDATE=1".into())
}
