//! `sdfc mesh`: writes a closed mesh of a scene, with a proven error.

use std::path::{Path, PathBuf};

use sdfc::{Error, FrameValues, Mesh, MeshCertificate, MeshError, MeshFormat, MeshOptions};
use sdfc::{MeshSize, Scene};
use serde::Serialize;

use crate::args;
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
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
    let path = args.output.clone().unwrap_or_else(|| default_output(&args.file));
    let format = MeshFormat::of(&path).map_err(Failure::Call)?;
    let paths = [Some(path.as_path()), args.json.as_deref()];
    output::distinct(&args.file, &paths.into_iter().flatten().collect::<Vec<&Path>>())?;
    let scene = super::scene(&args.file, super::compiler(), console)?;
    let output = Output::new(&path);
    let report = args.json.as_deref().map(Output::new);
    output.check()?;
    report.as_ref().map_or(Ok(()), Output::check)?;
    let options = MeshOptions::new().error(size(args)).frame(values(&scene, args)?);
    let options = args.max_cells.map_or(options.clone(), |limit| options.max_cells(limit));
    let mesh = make(&scene, &options, console)?;
    let bytes = format.encode(&mesh).map_err(|error| Failure::Call(error.to_string()))?;
    output.write(&bytes)?;
    if let Some(report) = report {
        report.write(&super::json(&describe(&mesh))?)?;
    }
    print(&path, &mesh, console);
    Ok(())
}

fn size(args: &args::Mesh) -> MeshSize {
    match (args.error, args.error_relative) {
        (Some(length), _) => MeshSize::Length(length),
        (None, Some(part)) => MeshSize::Relative(part),
        (None, None) => MeshOptions::new().error,
    }
}

fn values(scene: &Scene, args: &args::Mesh) -> Result<FrameValues, Failure> {
    let mut values = scene.defaults();
    for set in &args.set {
        let done = scene.set_param(&mut values, &set.name, &set.value);
        done.map_err(|error| Failure::Call(error.to_string()))?;
    }
    values.time = args.time;
    Ok(values)
}

fn make(scene: &Scene, options: &MeshOptions, console: &Console) -> Result<Mesh, Failure> {
    let interrupt = Interrupt::watch();
    let progress = console.progress("meshing");
    let mesh = scene.mesh(options, &mut |part| {
        progress.set(part.done, part.total);
        interrupt.flow()
    });
    drop(progress);
    mesh.map_err(|error| {
        if matches!(error, Error::Mesh(MeshError::Cancelled)) {
            return Failure::Interrupted("stopped; no mesh was written".to_owned());
        }
        super::lowering(&error, console)
    })
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
    let error = certificate.error;
    let name = path.display();
    let triangles = mesh.triangles.len();
    if certificate.is_proven {
        console.note(&format!(
            "{name}: {triangles} triangles; mesh and surface are proven to be within {error} of \
             each other"
        ));
        return;
    }
    let [count, volume] = [certificate.undecided as f64, certificate.undecided_volume];
    console.note(&format!(
        "{name}: {triangles} triangles; mesh and surface are within {error} of each other, except \
         in {count} undecided boxes with a volume of {volume:.3e}"
    ));
    if let Some([lo, hi]) = certificate.undecided_boxes.first() {
        console.note(&format!("the first undecided box is from {lo:?} to {hi:?}"));
    }
}

/// Returns the default output: `ball.stl` in the current folder for `scenes/ball.sdf`.
fn default_output(scene: &Path) -> PathBuf {
    let stem = scene.file_stem().filter(|stem| *stem != "-");
    let mut name = stem.map_or_else(|| "scene".into(), ToOwned::to_owned);
    name.push(".stl");
    PathBuf::from(name)
}
