//! One file a command.

pub mod bench;
pub mod chart;
mod charts;
pub mod check;
pub mod compile;
pub mod doc;
pub mod explain;
mod faults;
pub mod format;
pub mod render;
pub mod tune;
pub mod view;

use std::path::{Path, PathBuf};

use sdfc::Error;
use sdfc::lang::Options;
use sdfc::render::RenderError;

use crate::console::Console;
use crate::failure::Failure;

/// Reads and compiles a scene and shows what was found.
///
/// # Errors
///
/// The scene cannot be read, or has errors.
fn scene(path: &Path, options: Options, console: &Console) -> Result<sdfc::Scene, Failure> {
    let mut compiled = compiled_with(path, options)?;
    show(&mut compiled, console);
    compiled.scene.ok_or(Failure::Scene)
}

/// Why a scene that has compiled could not be lowered or drawn.
fn lowering(error: &Error, console: &Console) -> Failure {
    let message = error.to_string();
    if error.is_machine() {
        return Failure::Machine(message);
    }
    if matches!(error, Error::Render(RenderError::Cancelled)) {
        return Failure::Interrupted("stopped; no picture is written".to_owned());
    }
    if error.is_call() {
        return Failure::Call(message);
    }
    console.error(&message);
    Failure::Scene
}

fn compiled(path: &Path) -> Result<sdfc::Compiled, Failure> {
    compiled_with(path, Options::default())
}

fn compiled_with(path: &Path, options: Options) -> Result<sdfc::Compiled, Failure> {
    let input = sdfc_files::read(path)?;
    Ok(sdfc::compile_with(&input.name, &input.text, &sdfc_files::Folder::of(path), options))
}

/// Does the same to every file, also after one that fails.
///
/// # Errors
///
/// The worst of all files' failures; the others have been told.
fn each(
    files: &[PathBuf],
    console: &Console,
    mut act: impl FnMut(&Path) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut worst = Ok(());
    for path in files {
        let Err(failure) = act(path) else { continue };
        let (told, kept) = match worst {
            Err(before) if before > failure => (Some(failure), before),
            Err(before) => (Some(before), failure),
            Ok(()) => (None, failure),
        };
        told.iter().for_each(|failure| console.failure(failure));
        worst = Err(kept);
    }
    worst
}

/// The diagnostics on stderr; with `-q` errors only.
fn show(compiled: &mut sdfc::Compiled, console: &Console) {
    if !console.shows_warnings() {
        compiled.diagnostics.retain(|found| found.is_error());
    }
    console.text(&compiled.diagnostics_text(console.color));
}

/// A value as JSON text with a final line end.
///
/// # Errors
///
/// None for the plain data that commands write.
fn json(value: &impl serde::Serialize) -> Result<Vec<u8>, Failure> {
    let text = serde_json::to_vec_pretty(value);
    let mut bytes = text.map_err(|e| Failure::Machine(format!("cannot write JSON: {e}")))?;
    bytes.push(b'\n');
    Ok(bytes)
}
