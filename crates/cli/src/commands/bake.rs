//! `sdfc bake`: writes a grid of distances, with a proven error of interpolation.

use std::path::Path;

use sdfc::{BakeOptions, DistanceGrid, GridFormat};

use crate::args;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::{self, Output};

/// Samples a scene on a grid, and prints the error.
///
/// # Errors
///
/// The scene cannot be read, has errors, draws nothing or has no limit; a param does not take its
/// value; the grid has too many samples; two of the outputs and the scene are the same file; an
/// output cannot be written; Ctrl-C.
pub fn run(args: &args::Bake, console: &Console) -> Result<(), Failure> {
    let path = args.output.clone().unwrap_or_else(|| output::named_after(&args.file, "npy"));
    let format = GridFormat::of(&path).map_err(Failure::Call)?;
    let paths = [Some(path.as_path()), args.json.as_deref()];
    output::distinct(&args.file, &paths.into_iter().flatten().collect::<Vec<&Path>>())?;
    let scene = super::scene_with(&args.file, super::compiler(), &args.values.set, console)?;
    let output = Output::new(&path);
    let report = args.json.as_deref().map(Output::new);
    output.check()?;
    report.as_ref().map_or(Ok(()), Output::check)?;
    let frame = super::values(&scene, args.values.time);
    let options = BakeOptions::new().resolution(args.resolution).frame(frame);
    let grid = super::mesh_work("baking", console, |progress| scene.bake(&options, progress))?;
    output.write(&format.encode(&grid))?;
    if let Some(report) = report {
        report.write(&super::json(&grid)?)?;
    }
    print(&path, &grid, console);
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
