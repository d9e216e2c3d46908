//! `sdfc mesh`: writes a closed mesh of a scene, with a proven error.

use std::path::Path;

use sdfc::{Mesh, MeshCertificate, MeshFormat};
use serde::Serialize;

use crate::args;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::{self, Output};

/// What `--json` writes.
#[derive(Serialize)]
struct Report<'a> {
    vertices: usize,
    triangles: usize,
    open_edges: usize,
    volume: f64,
    area: f64,
    bounds: Option<[[f64; 3]; 2]>,
    certificate: &'a MeshCertificate,
}

/// Makes the mesh, and prints what is proven.
///
/// # Errors
///
/// The scene cannot be read, has errors, draws nothing or has no limit; a param does not take its
/// value; the error is too small; two of the outputs and the scene are the same file; an output
/// cannot be written; Ctrl-C.
pub fn run(args: &args::Mesh, console: &Console) -> Result<(), Failure> {
    let path = args.output.clone().unwrap_or_else(|| output::named_after(&args.file, "stl"));
    let format = MeshFormat::of(&path).map_err(Failure::Call)?;
    let paths = [Some(path.as_path()), args.json.as_deref()];
    output::distinct(&args.file, &paths.into_iter().flatten().collect::<Vec<&Path>>())?;
    let scene = super::scene_with(&args.file, super::compiler(), &args.values.set, console)?;
    let output = Output::new(&path);
    let report = args.json.as_deref().map(Output::new);
    output.check()?;
    report.as_ref().map_or(Ok(()), Output::check)?;
    let error = [args.error, args.error_relative];
    let options = super::mesh_options(&scene, error, args.values.time, args.max_cells);
    let mesh = super::mesh_work("meshing", console, |progress| scene.mesh(&options, progress))?;
    let bytes = format.encode(&mesh).map_err(|error| Failure::Call(error.to_string()))?;
    output.write(&bytes)?;
    if let Some(report) = report {
        report.write(&super::json(&describe(&mesh))?)?;
    }
    print(&path, &mesh, console);
    Ok(())
}

fn describe(mesh: &Mesh) -> Report<'_> {
    Report {
        vertices: mesh.vertices.len(),
        triangles: mesh.triangles.len(),
        open_edges: mesh.open_edges(),
        volume: mesh.volume(),
        area: mesh.area(),
        bounds: mesh.bounds(),
        certificate: &mesh.certificate,
    }
}

fn print(path: &Path, mesh: &Mesh, console: &Console) {
    let certificate = &mesh.certificate;
    let (name, triangles) = (path.display(), mesh.triangles.len());
    console.note(&format!("{name}: {triangles} triangles; {certificate}"));
    if let Some([lo, hi]) = certificate.undecided_boxes.first() {
        console.note(&format!("the first undecided box is from {lo:?} to {hi:?}"));
    }
}
