//! `sdfc explain`: how a scene is compiled.

use crate::args::Explain;
use crate::console::Console;
use crate::failure::Failure;
use crate::output;

/// Prints the explanation to stdout.
///
/// # Errors
///
/// The scene cannot be read, has errors or draws nothing; a param does not take its value.
pub fn run(args: &Explain, console: &Console) -> Result<(), Failure> {
    let scene = super::scene_with(&args.file, super::compiler(), &args.params.set, console)?;
    let explanation = scene.explain().map_err(|e| super::lowering(&e, console))?;
    let bytes =
        if args.json { output::json(&explanation)? } else { explanation.to_string().into_bytes() };
    output::to_stdout(&bytes)
}
