//! `sdfc contour`: writes the outlines of a section of a scene, with a proven error.

use std::path::Path;

use sdfc::{Contour, ContourFormat};

use crate::args;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::WithReport;

/// Makes the contour, and prints what is proven.
///
/// # Errors
///
/// The scene cannot be read, has errors, draws nothing or has no limit; a param does not take its
/// value; the plane misses the scene; the error is too small; two of the outputs and the scene are
/// the same file; an output cannot be written; Ctrl-C.
pub fn run(args: &args::Contour, console: &Console) -> Result<(), Failure> {
    let (result, report) = (args.output.as_deref(), args.json.as_deref());
    let output = WithReport::new(&args.file, result, "svg", report)?;
    let format = ContourFormat::of(&output.path).map_err(Failure::Call)?;
    let compiler = super::compiler_of_constants();
    let scene = super::scene_with(&args.file, compiler, &args.values.params.set, console)?;
    let options = super::mesh_options(&scene, &args.exactness, args.values.time);
    let options = options.has_arcs(!args.lines);
    let contour = super::mesh_work("tracing", console, |progress| {
        scene.contour(args.plane, &options, progress)
    })?;
    let reported =
        scene.reported(&super::values(&scene, args.values.time), contour.report(&args.plane));
    super::note_left_out(&reported.left_out, console);
    output.write(&format.encode(&contour), &reported)?;
    print(&output.path, &contour, console);
    Ok(())
}

fn print(path: &Path, contour: &Contour, console: &Console) {
    let Contour { paths, certificate, .. } = contour;
    let bulges = || paths.iter().flat_map(|path| &path.bulges);
    let arcs = bulges().filter(|bulge| **bulge != 0.0).count();
    let lines = bulges().count() - arcs;
    let (name, count) = (path.display(), paths.len());
    let plural = if count == 1 { "" } else { "s" };
    console.note(&format!(
        "{name}: {count} path{plural} of {lines} lines and {arcs} arcs; {certificate}"
    ));
    if let Some([lo, hi]) = certificate.undecided_boxes.first() {
        console.note(&format!("the first undecided box is from {lo:?} to {hi:?}"));
    }
}
