//! The rules of the repository that neither the compiler nor a lint can check.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod architecture;
mod columns;
mod cycles;
mod files;
mod modules;
mod terms;
mod tokens;

/// A check that some areas of the repository do not pass yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Check {
    Columns,
    Cycles,
    Terms,
}

/// The areas that do not pass a check yet.
const TO_DO: &[(Check, &[&str])] = &[
    (Check::Columns, &["crates/cli", "crates/measure", "crates/sdfc"]),
    (Check::Terms, &["crates/cli", "crates/measure", "crates/sdfc"]),
];

/// Fails if a path has a problem and its area is not in [`TO_DO`].
fn report(check: Check, problems: &[(String, String)]) {
    let is_to_do =
        |path: &str| TO_DO.iter().any(|row| row.0 == check && row.1.contains(&files::area(path)));
    let found: Vec<String> = problems
        .iter()
        .filter(|(path, _)| !is_to_do(path))
        .map(|(path, problem)| format!("{path}: {problem}"))
        .collect();
    assert!(found.is_empty(), "{} problems:\n{}", found.len(), found.join("\n"));
}
