//! `sdfc check`: all diagnostics of all files.

use sdfc::Diagnostics;

use crate::args::Check;
use crate::console::Console;
use crate::failure::Failure;
use crate::output;

/// Checks every file, also after one that fails.
///
/// # Errors
///
/// The worst failure of all files: one has errors, or cannot be read.
pub fn run(args: &Check, console: &Console) -> Result<(), Failure> {
    let mut rows = Vec::new();
    let result = super::each(&args.files, console, |path| {
        let input = sdfc_files::read(path)?;
        let folder = sdfc_files::Folder::of(path);
        let compiler = super::compiler().resolver(&folder);
        let diagnostics = compiler.check(&input.name, &input.text);
        if args.json {
            rows.extend(diagnostics.rows());
        } else {
            super::show(&diagnostics, console);
            console.note(&summary(&input.name, &diagnostics));
        }
        if diagnostics.has_errors() { Err(Failure::Scene) } else { Ok(()) }
    });
    if args.json {
        output::to_stdout(&output::json(&rows)?)?;
    }
    result
}

/// Says what was found in a scene.
fn summary(name: &str, diagnostics: &Diagnostics) -> String {
    let errors = diagnostics.iter().filter(|it| it.is_error()).count();
    let warnings = diagnostics.len() - errors;
    let count = |count: usize, what: &str| match count {
        0 => format!("no {what}s"),
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    };
    format!("{name}: {}, {}", count(errors, "error"), count(warnings, "warning"))
}
