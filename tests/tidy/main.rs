//! The rules of the repository that neither the compiler nor a lint can check.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod architecture;
mod columns;
mod cycles;
mod files;
mod modules;
mod terms;
mod tokens;

/// Fails if there are problems, each with the path of its file.
fn report(problems: &[(String, String)]) {
    let lines: Vec<String> =
        problems.iter().map(|(path, problem)| format!("{path}: {problem}")).collect();
    assert!(lines.is_empty(), "{} problems:\n{}", lines.len(), lines.join("\n"));
}
