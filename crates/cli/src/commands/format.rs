//! `sdfc fmt`: formats scenes.

use crate::args::Format;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::Output;

/// Formats every file in place, and stdin to stdout. With `--check`, prints which files are not
/// formatted and changes nothing.
///
/// # Errors
///
/// The worst failure of all files: one does not parse, is not formatted under `--check`, or cannot
/// be read or written.
pub fn run(args: &Format, console: &Console) -> Result<(), Failure> {
    super::each(&args.files, console, |path| {
        let input = sdfc_files::read(path)?;
        let formatted = sdfc::format(&input.name, &input.text).map_err(|errors| {
            console.text(&errors.render(console.color));
            Failure::Scene
        })?;
        let output = Output::new(path);
        let changes = formatted != input.text;
        if args.check && changes {
            console.error(&format!("{} is not formatted; run `sdfc fmt {0}`", input.name));
            return Err(Failure::Scene);
        }
        if args.check || !(changes || output == Output::Stdout) {
            return Ok(());
        }
        output.write_unless_changed(input.text.as_bytes(), formatted.as_bytes())
    })
}
