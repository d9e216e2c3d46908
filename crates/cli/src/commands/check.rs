//! `sdfc check`: all diagnostics of all files, nothing else.

use crate::args::Check;
use crate::console::Console;
use crate::failure::Failure;
use crate::output;

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
            rows.extend(compiled.rows());
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
