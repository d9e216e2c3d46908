//! `sdfc mesh`: writes a closed mesh of a scene, with a proven error.

use std::path::Path;

use sdfc::{Mesh, MeshFormat, Scene, Shell};

use crate::args;
use crate::console::Console;
use crate::failure::Failure;
use crate::output::WithReport;

/// Makes the mesh, and prints what is proven.
///
/// # Errors
///
/// The scene cannot be read, has errors, draws nothing or has no limit; a param does not take its
/// value; the error is too small; two of the outputs and the scene are the same file; an output
/// cannot be written; Ctrl-C.
pub fn run(args: &args::Mesh, console: &Console) -> Result<(), Failure> {
    let (result, report) = (args.output.as_deref(), args.json.as_deref());
    let output = WithReport::new(&args.file, result, "stl", report)?;
    let format = MeshFormat::of(&output.path).map_err(Failure::Call)?;
    let compiler = super::compiler_of_constants();
    let scene = super::scene_with(&args.file, compiler, &args.values.params.set, console)?;
    let options = super::mesh_options(&scene, &args.exactness, args.values.time);
    let mesh = super::mesh_work("meshing", console, |progress| scene.mesh(&options, progress))?;
    let bytes = format.encode(&mesh).map_err(|error| Failure::Call(error.to_string()))?;
    let reported = scene.reported(&super::values(&scene, args.values.time), mesh.report());
    super::note_left_out(&reported.left_out, console);
    output.write(&bytes, &reported)?;
    print(&output.path, &mesh, console);
    if lies_inside(&scene, &mesh, args.values.time) {
        console.note(
            "this box is inside of the solid: where two parts only share a face, the distance is \
             0; let them overlap a little",
        );
    }
    Ok(())
}

/// True if the first undecided box has the solid on all sides.
fn lies_inside(scene: &Scene, mesh: &Mesh, time: f64) -> bool {
    let Some([lo, hi]) = mesh.certificate.undecided_boxes.first() else { return false };
    let middle: [f64; 3] = std::array::from_fn(|axis| 0.5 * (lo[axis] + hi[axis]));
    let frame = super::values(scene, time);
    let Ok(mut field) = scene.field(&frame) else { return false };
    (0..6).all(|side| {
        let mut point = middle;
        let reach = 2.0 * (hi[side / 2] - lo[side / 2]);
        point[side / 2] += if side % 2 == 0 { -reach } else { reach };
        field.distance(point) <= 0.0
    })
}

fn print(path: &Path, mesh: &Mesh, console: &Console) {
    let certificate = &mesh.certificate;
    let (name, triangles) = (path.display(), mesh.triangles.len());
    let parts = parts(&mesh.shells());
    console.note(&format!("{name}: {triangles} triangles in {parts}; {certificate}"));
    if let Some([lo, hi]) = certificate.undecided_boxes.first() {
        console.note(&format!("the first undecided box is from {lo:?} to {hi:?}"));
    }
}

/// Returns the numbers of parts, cavities and holes, such as `1 part with 2 holes`.
fn parts(shells: &[Shell]) -> String {
    let counted = |count: usize, one: &str, many: &str| match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {many}"),
    };
    let cavities = shells.iter().filter(|shell| shell.is_cavity).count();
    let holes: usize = shells.iter().filter_map(|shell| shell.holes).sum();
    let mut text = counted(shells.len() - cavities, "part", "parts");
    let mut join = " with ";
    for (count, one, many) in [(cavities, "cavity", "cavities"), (holes, "hole", "holes")] {
        if count > 0 {
            text += join;
            text += &counted(count, one, many);
            join = " and ";
        }
    }
    text
}
