//! `sdfc compile`: the shader of a scene.

use std::path::Path;

use sdfc::ShaderOptions;
use sdfc::lang::Options;

use crate::args::Compile;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::{self, Output};

/// Writes the shader, and what it offers if asked to.
///
/// # Errors
///
/// The scene cannot be read, has errors or draws nothing; the target cannot hold what is asked for; an
/// output is not writable.
pub fn run(args: &Compile, console: &Console) -> Result<(), Failure> {
    let paths: Vec<&Path> =
        [Some(&args.output), args.reflect.as_ref()].into_iter().flatten().map(|p| &**p).collect();
    output::distinct(&args.file, &paths)?;
    let mut compiled = super::compiled_with(&args.file, Options { slots: args.slots })?;
    super::show(&mut compiled, console);
    let scene = compiled.scene.ok_or(Failure::Scene)?;
    let options = ShaderOptions {
        target: args.target.into(),
        emit: args.emit.into(),
        prefix: args.prefix.clone(),
        group: args.group,
        binding: args.binding,
    };
    let written = scene.write_shader(&options).map_err(|e| super::lowering(&e, console))?;
    let mut results = Vec::new();
    if let Some(path) = &args.reflect {
        let reflection = scene.reflect(&compiled.sources, &options, &written);
        results.push((Output::new(path), super::json(&reflection)?));
    }
    results.push((Output::new(&args.output), written.code.into_bytes()));
    for (output, _) in &results {
        output.check()?;
    }
    for (output, bytes) in &results {
        output.write(bytes)?;
        if let Output::File(path) = output {
            console.detail(|| format!("{}: {} bytes", path.display(), bytes.len()));
        }
    }
    Ok(())
}
