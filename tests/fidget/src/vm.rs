//! Fidget's text format for models, as a scene.
//!
//! A line is a name, an operation, and names or a number: `_1f add _3 _1e`. The last line is the
//! model.

use std::fmt::Write;

use anyhow::{Context, Result, bail};

/// A scene that shows the model of a `.vm` file in the cube from -1 to 1. Without `var-z` the
/// model is a region.
pub fn scene(text: &str) -> Result<String> {
    let lines = || text.lines().map(str::trim).filter(|l| !l.is_empty() && !l.starts_with('#'));
    let is_solid = lines().any(|line| line.ends_with("var-z"));
    let mut scene = format!("{} model() = {{\n", if is_solid { "solid" } else { "region" });
    let mut last = None;
    for line in lines() {
        let mut words = line.split_whitespace();
        let name = words.next().with_context(|| format!("`{line}` has no name"))?;
        let value = value(words.next().unwrap_or(""), &words.collect::<Vec<_>>())
            .with_context(|| format!("in `{line}`"))?;
        writeln!(scene, "let v{name} = {value}")?;
        last = Some(name);
    }
    let last = last.context("the model is empty")?;
    let shown = if is_solid { "model() & box(2)\nambient(strength: 1)" } else { "model()" };
    writeln!(scene, "v{last}\n}}\n{shown}\ncamera(eye: [0, 0, 1], height: 2)")?;
    Ok(scene)
}

fn value(operation: &str, arguments: &[&str]) -> Result<String> {
    let a = arguments.first().copied().unwrap_or("");
    Ok(match (operation, arguments) {
        ("var-x", []) => "p.x".to_owned(),
        ("var-y", []) => "p.y".to_owned(),
        ("var-z", []) => "p.z".to_owned(),
        ("const", [number]) => number.parse::<f64>()?.to_string(),
        ("neg", [a]) => format!("-v{a}"),
        ("square", [a]) => format!("v{a} * v{a}"),
        ("abs" | "sqrt" | "sin" | "cos" | "tan" | "asin" | "acos" | "atan" | "exp", [_])
        | ("floor" | "ceil" | "round", [_]) => format!("{operation}(v{a})"),
        ("ln", [_]) => format!("log(v{a})"),
        ("recip", [_]) => format!("1 / v{a}"),
        ("add", [a, b]) => format!("v{a} + v{b}"),
        ("sub", [a, b]) => format!("v{a} - v{b}"),
        ("mul", [a, b]) => format!("v{a} * v{b}"),
        ("div", [a, b]) => format!("v{a} / v{b}"),
        ("min" | "max", [a, b]) => format!("{operation}(v{a}, v{b})"),
        _ => bail!("`{operation}` with {} arguments is not supported", arguments.len()),
    })
}
