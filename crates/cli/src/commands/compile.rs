//! `sdfc compile`: the shader of a scene as text.

use sdfc::FieldOptions;
use sdfc::lang::Options;

use crate::args::{Compile, Emit, Target};
use crate::console::Console;
use crate::failure::Failure;
use crate::output::{self, Output};

/// Writes the shader.
///
/// # Errors
///
/// The scene cannot be read, has errors or draws nothing; the output is not writable.
pub fn run(args: &Compile, console: &Console) -> Result<(), Failure> {
    output::distinct(&args.file, &[&args.output])?;
    let scene = super::scene(&args.file, Options { slots: args.slots }, console)?;
    let shader = match args.emit {
        Emit::Field => scene.field_shader(&FieldOptions::default()),
        Emit::Render => scene.picture_shader(scene.method()),
    };
    let shader = shader.map_err(|e| super::lowering(&e, console))?;
    let text = match args.target {
        Target::Wgsl => shader.wgsl().map_err(|e| super::lowering(&e.into(), console))?,
    };
    let output = Output::new(&args.output);
    output.write(text.as_bytes())?;
    if let Output::File(path) = &output {
        console.detail(|| format!("{}: {} bytes", path.display(), text.len()));
    }
    Ok(())
}
