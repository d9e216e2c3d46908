//! `sdfc compile`: writes the shader of a scene.

use std::path::Path;

use sdfc::{Emit, ShaderOptions, Target};

use crate::args::Compile;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::{self, Output};

/// Writes the shader, and its reflection if asked to.
///
/// # Errors
///
/// The scene cannot be read, has errors or draws nothing; a param does not take its value; the
/// target does not support the options; an output is not writable.
pub fn run(args: &Compile, console: &Console) -> Result<(), Failure> {
    let paths: Vec<&Path> =
        [Some(&args.output), args.reflect.as_ref()].into_iter().flatten().map(|p| &**p).collect();
    output::distinct(&args.file, &paths)?;
    let options = options(args)?;
    let compiler = super::compiler_with(args.live.live_literals);
    let scene = super::scene_with(&args.file, compiler, &args.set, console)?;
    let written = scene.write_shader(&options).map_err(|e| super::lowering(&e, console))?;
    let mut results = Vec::new();
    if let Some(path) = &args.reflect {
        let reflection = scene.reflect(&options, &written);
        results.push((Output::new(path), output::json(&reflection)?));
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

/// Returns the options of the shader. An option without effect is an error.
///
/// # Errors
///
/// An option does not apply to the target or the part.
fn options(args: &Compile) -> Result<ShaderOptions, Failure> {
    let target = args.target;
    let is_toy = target == Target::Shadertoy;
    let emit = args.emit.unwrap_or(Emit::default_for(target));
    let name = target.name();
    let refusals = [
        (
            args.stage.is_some() && emit != Emit::Render,
            "--stage applies to --emit render only; leave it out".to_owned(),
        ),
        (
            args.march.is_some() && emit == Emit::Field,
            "--march applies to --emit march and render only; a field has no ray method".to_owned(),
        ),
        (args.prefix.is_some() && is_toy, format!("{name} has no name prefix; leave out --prefix")),
        (
            args.group.is_some() && !target.has_groups(),
            format!("{name} has no bind groups; leave out --group"),
        ),
        (
            args.binding.is_some() && !target.has_bindings(),
            format!("{name} binds buffers by name and has no bindings; leave out --binding"),
        ),
    ];
    if let Some((_, why)) = refusals.into_iter().find(|refusal| refusal.0) {
        return Err(Failure::Call(why));
    }
    let defaults = ShaderOptions::default();
    Ok(ShaderOptions::new()
        .target(target)
        .emit(emit)
        .stage(args.stage.unwrap_or(target.default_stage()))
        .method(args.march)
        .prefix(args.prefix.clone().unwrap_or(defaults.prefix))
        .group(args.group.unwrap_or(defaults.group))
        .binding(args.binding.unwrap_or(defaults.binding)))
}
