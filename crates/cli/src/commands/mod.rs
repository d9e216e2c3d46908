//! The commands, one file each.

pub mod bake;
pub mod bench;
mod chart;
pub mod charts;
pub mod check;
pub mod compile;
pub mod completions;
pub mod contour;
pub mod doc;
pub mod explain;
mod faults;
pub mod format;
pub mod join;
pub mod lsp;
pub mod manual;
pub mod measure;
pub mod mesh;
pub mod new;
pub mod render;
pub mod tune;
pub mod view;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use sdfc::{
    CompileWithError, Compiler, Diagnostics, Error, FrameValues, MeshError, MeshOptions, MeshPhase,
    MeshProgress, MeshSize, Scene,
};
use sdfc_measure::MeasureError;
use sdfc_render::{Gpu, RenderError};

use crate::args::{Assignment, Exactness};
use crate::console::Console;
use crate::failure::Failure;
use crate::farm::provenance::Recorded;
use crate::interrupt::Interrupt;

/// Reads and compiles a scene, and prints its diagnostics.
///
/// # Errors
///
/// The scene cannot be read, or has errors.
fn scene(path: &Path, compiler: Compiler<'_>, console: &Console) -> Result<Scene, Failure> {
    let input = sdfc_files::read(path)?;
    let folder = sdfc_files::Folder::of(path);
    shown(compiler.resolver(&folder).compile(&input.name, &input.text), console)
}

/// Like [`scene`], with values for some params. They are the defaults of the scene.
///
/// # Errors
///
/// The scene cannot be read, or has errors, or a param does not take its value.
fn scene_with(
    path: &Path,
    compiler: Compiler<'_>,
    set: &[Assignment],
    console: &Console,
) -> Result<Scene, Failure> {
    let input = sdfc_files::read(path)?;
    let folder = sdfc_files::Folder::of(path);
    compiled_with(&input, compiler.resolver(&folder), set, console)
}

fn compiled_with(
    input: &sdfc_files::Input,
    compiler: Compiler<'_>,
    set: &[Assignment],
    console: &Console,
) -> Result<Scene, Failure> {
    let set: Vec<_> = set.iter().map(|it| (it.name.as_str(), it.value.as_str())).collect();
    match compiler.compile_with(&input.name, &input.text, &set) {
        Ok(scene) => shown(Ok(scene), console),
        Err(CompileWithError::Scene(errors)) => shown(Err(errors), console),
        Err(error) => Err(Failure::Call(error.to_string())),
    }
}

/// Like [`scene_with`], with the checksum of the scene and of the files that it imports.
///
/// # Errors
///
/// As [`scene_with`].
fn scene_and_checksum(
    path: &Path,
    compiler: Compiler<'_>,
    set: &[Assignment],
    console: &Console,
) -> Result<(Scene, String), Failure> {
    let input = sdfc_files::read(path)?;
    let folder = sdfc_files::Folder::of(path);
    let files = Recorded::new(&folder);
    let scene = compiled_with(&input, compiler.resolver(&files), set, console)?;
    Ok((scene, files.checksum(&input.text)))
}

/// Returns the frame of a time, with the params' defaults.
fn values(scene: &Scene, time: f64) -> FrameValues {
    FrameValues { time, ..scene.defaults() }
}

/// Says which solids or regions a mesh, a contour, measurements or a grid leave out.
fn note_left_out(left_out: &[String], console: &Console) {
    if !left_out.is_empty() {
        let listed = left_out.join(", ");
        console.note(&format!("not included, because it has no limit: {listed}"));
    }
}

/// Returns the options of a mesh or a contour.
fn mesh_options(scene: &Scene, exactness: &Exactness, time: f64) -> MeshOptions {
    let options = MeshOptions::new().frame(values(scene, time));
    let options = match (exactness.error, exactness.error_relative) {
        (Some(length), _) => options.error(MeshSize::Length(length)),
        (None, Some(fraction)) => options.error(MeshSize::Relative(fraction)),
        (None, None) => options,
    };
    exactness.max_cells.map_or(options.clone(), |limit| options.max_cells(limit))
}

/// Runs work on a mesh or a contour, with a progress bar, until it is done or Ctrl-C is pressed.
///
/// # Errors
///
/// The work failed or was stopped.
fn mesh_work<T>(
    name: &str,
    console: &Console,
    work: impl FnOnce(&mut dyn FnMut(MeshProgress) -> ControlFlow<()>) -> Result<T, Error>,
) -> Result<T, Failure> {
    let interrupt = Interrupt::watch("stopped; nothing was written", console);
    let progress = console.progress(name);
    // A proof that leaves boxes undecided is followed by another pass, with smaller boxes there.
    let (mut phase, mut pass) = (None, 1);
    let done = work(&mut |part| {
        if phase.replace(part.phase) != Some(part.phase) {
            progress.rename(&format!("{name}, {}", step(part.phase, pass)));
            pass += u32::from(part.phase == MeshPhase::Proving);
        }
        progress.set(part.done, part.total);
        interrupt.flow()
    });
    drop(progress);
    done.map_err(|error| {
        if matches!(error, Error::Mesh(MeshError::Cancelled)) {
            return interrupt.failure();
        }
        lowering(&error, console)
    })
}

/// A step of a pass, as the progress shows it.
fn step(phase: MeshPhase, pass: u32) -> String {
    let step = match phase {
        MeshPhase::Refining => "dividing boxes",
        MeshPhase::Placing => "placing points",
        MeshPhase::Proving => "proving the error",
        MeshPhase::Measuring => "adding up",
    };
    if pass == 1 { step.to_owned() } else { format!("pass {pass}, {step}") }
}

/// Returns the compiler that all commands use. It tests the clauses of the scene's own shapes, so
/// that no command accepts a scene that another one refuses.
fn compiler() -> Compiler<'static> {
    Compiler::new().verify(true)
}

/// Returns the compiler of commands that work with one set of params.
fn compiler_of_constants() -> Compiler<'static> {
    compiler().constant_params(true)
}

/// Returns the compiler, with live literals if asked for.
fn compiler_with(live_literals: bool) -> Compiler<'static> {
    if live_literals { compiler().live_literals(None) } else { compiler() }
}

/// Prints the diagnostics of a compilation and returns its scene.
///
/// # Errors
///
/// The scene has errors.
fn shown(compiled: Result<Scene, Diagnostics>, console: &Console) -> Result<Scene, Failure> {
    match compiled {
        Ok(scene) => {
            show(scene.diagnostics(), console);
            Ok(scene)
        }
        Err(errors) => {
            show(&errors, console);
            Err(Failure::Scene)
        }
    }
}

/// Converts an error that occurred after the scene compiled. A command that Ctrl-C stopped says
/// more by [`Interrupt::explained`].
fn lowering(error: &Error, console: &Console) -> Failure {
    let message = error.to_string();
    if error.is_machine() {
        return Failure::Machine(message);
    }
    if matches!(error, Error::Render(RenderError::Cancelled)) {
        return Failure::Interrupted("stopped".to_owned());
    }
    if error.is_call() {
        return Failure::Call(message);
    }
    console.error(&message);
    Failure::Scene
}

/// Opens the GPU.
///
/// # Errors
///
/// There is no GPU.
fn gpu(console: &Console) -> Result<Gpu, Failure> {
    Gpu::new().map_err(|error| lowering(&error.into(), console))
}

/// Converts an error of a measurement.
fn measuring(error: &MeasureError, console: &Console) -> Failure {
    if let MeasureError::Scene(error) = error {
        return lowering(error, console);
    }
    console.error(&error.to_string());
    Failure::Scene
}

/// Runs `act` on every file, also after one that fails.
///
/// # Errors
///
/// The worst failure of all files; the others have been printed.
fn each(
    files: &[PathBuf],
    console: &Console,
    mut act: impl FnMut(&Path) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut worst = Ok(());
    for path in files {
        let Err(failure) = act(path) else { continue };
        let (printed, kept) = match worst {
            Err(before) if before > failure => (Some(failure), before),
            Err(before) => (Some(before), failure),
            Ok(()) => (None, failure),
        };
        printed.iter().for_each(|failure| console.failure(failure));
        worst = Err(kept);
    }
    worst
}

/// Prints diagnostics to stderr; errors only with `-q`.
fn show(diagnostics: &Diagnostics, console: &Console) {
    let text = match console.shows_warnings() {
        true => diagnostics.render(console.color),
        false => diagnostics.without_warnings().render(console.color),
    };
    console.text(&text);
}
