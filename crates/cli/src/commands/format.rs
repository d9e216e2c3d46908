//! `sdfc fmt`: scenes in the one layout.

use crate::args::Format;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::Output;

/// Formats every file in place, stdin to stdout; with `--check` changes nothing and names those that would change.
///
/// # Errors
///
/// The worst of all files: one does not parse, or would change under `--check`; one cannot be read or written.
pub fn run(args: &Format, console: &Console) -> Result<(), Failure> {
    super::each(&args.files, console, |path| {
        let input = sdfc_files::read(path)?;
        let formatted = sdfc::format(&input.name, &input.text, console.color).map_err(|found| {
            console.text(&found);
            Failure::Scene
        })?;
        let output = Output::new(path);
        let changes = formatted != input.text;
        if args.check && changes {
            console.error(&format!("{} is not formatted", input.name));
            return Err(Failure::Scene);
        }
        if !args.check && (changes || output == Output::Stdout) {
            output.write(formatted.as_bytes())?;
        }
        Ok(())
    })
}
