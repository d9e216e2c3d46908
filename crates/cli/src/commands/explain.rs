//! `sdfc explain`: what was modelled and why.

use crate::args::Explain;
use crate::console::Console;
use crate::failure::Failure;
use crate::output;

/// Writes the explanation to stdout.
///
/// # Errors
///
/// The scene cannot be read, has errors or draws nothing.
pub fn run(args: &Explain, console: &Console) -> Result<(), Failure> {
    let mut compiled = super::compiled(&args.file)?;
    super::show(&mut compiled, console);
    let scene = compiled.scene.ok_or(Failure::Scene)?;
    let explanation = scene.explain().map_err(|e| super::lowering(&e, console))?;
    let bytes =
        if args.json { super::json(&explanation)? } else { explanation.to_string().into_bytes() };
    output::to_stdout(&bytes)
}
