//! `sdfc check`: all diagnostics of all files, nothing else.

use serde::Serialize;

use crate::args::Check;
use crate::console::Console;
use crate::failure::Failure;
use crate::output;

/// A diagnostic for programs. The keys are a promise to other tools: some may be added, none renamed.
#[derive(Serialize)]
struct Row {
    code: &'static str,
    severity: &'static str,
    message: String,
    file: String,
    line: u32,
    column: u32,
    end_line: u32,
    end_column: u32,
    help: String,
}

/// Checks every file, also after one that fails.
///
/// # Errors
///
/// The worst of all files: one has errors, or one cannot be read.
pub fn run(args: &Check, console: &Console) -> Result<(), Failure> {
    let mut rows = Vec::new();
    let result = super::each(&args.files, console, |path| {
        let input = sdfc_files::read(path)?;
        let mut compiled = sdfc::check(&input.name, &input.text, &sdfc_files::Folder::of(path));
        if args.json {
            rows.extend(compiled.located().into_iter().map(row));
        } else {
            super::show(&mut compiled, console);
        }
        compiled.scene.map(drop).ok_or(Failure::Scene)
    });
    if args.json {
        output::to_stdout(&super::json(&rows)?)?;
    }
    result
}

fn row(found: sdfc::diagnostics::Located) -> Row {
    Row {
        code: found.code,
        severity: found.severity,
        message: found.message,
        file: found.file,
        line: found.start.line,
        column: found.start.column,
        end_line: found.end.line,
        end_column: found.end.column,
        help: found.help,
    }
}
