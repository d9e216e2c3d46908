//! `sdfc bake`: writes a grid of distances, with a proven error of interpolation.

use std::path::Path;

use sdfc::{BakeOptions, DistanceGrid, GridFormat};

use crate::args;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::WithReport;

/// Samples a scene on a grid, and prints the error.
///
/// # Errors
///
/// The scene cannot be read, has errors, draws nothing or has no limit; a param does not take its
/// value; the grid has too many samples; two of the outputs and the scene are the same file; an
/// output cannot be written; Ctrl-C.
pub fn run(args: &args::Bake, console: &Console) -> Result<(), Failure> {
    let (result, report) = (args.output.as_deref(), args.json.as_deref());
    let output = WithReport::new(&args.file, result, "npy", report)?;
    let format = GridFormat::of(&output.path).map_err(Failure::Call)?;
    let compiler = super::compiler_of_constants();
    let scene = super::scene_with(&args.file, compiler, &args.values.params.set, console)?;
    let frame = super::values(&scene, args.values.time);
    let options = BakeOptions::new().resolution(args.resolution).frame(frame.clone());
    let grid = super::mesh_work("baking", console, |progress| scene.bake(&options, progress))?;
    let reported = scene.reported(&frame, &grid);
    super::note_left_out(&reported.left_out, console);
    output.write(&format.encode(&grid), &reported)?;
    print(&output.path, &grid, console);
    Ok(())
}

fn print(path: &Path, grid: &DistanceGrid, console: &Console) {
    let DistanceGrid { shape: [x, y, z], origin, spacing, .. } = grid;
    let DistanceGrid { interpolation_error, surface_error, .. } = grid;
    console.note(&format!(
        "{}: {x} x {y} x {z} samples, {spacing} apart from {origin:?}; interpolation is proven to \
         be within {interpolation_error:.3e} of the field, and within {surface_error:.3e} near \
         the surface",
        path.display()
    ));
    if interpolation_error.is_infinite() {
        console.warning("nothing is proven about interpolation in some cells of the grid");
    }
}
