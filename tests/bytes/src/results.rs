//! Results in files: pictures, meshes, contours and grids.

use std::ops::ControlFlow;

use sdfc::{
    BakeOptions, Compiler, ContourFormat, GridFormat, MeshFormat, MeshOptions, MeshSize, Plane,
    Scene,
};
use sdfc_render::Raster;

use crate::NAME;

/// The largest number of operations of a scene that is meshed.
const MAX_OPERATIONS: usize = 200;
/// The error of a mesh, as a fraction of the scene's size.
const ERROR: f64 = 0.1;
/// The largest number of cells of a mesh.
const MAX_CELLS: u64 = 2000;
/// The largest number of pixels of a picture that is written again.
const MAX_PIXELS: u64 = 1 << 16;

/// Reads a picture. Written and read again, it must be the same.
pub fn picture(bytes: &[u8]) {
    let Ok((raster, note)) = Raster::from_file(bytes) else { return };
    let [width, height] = raster.size();
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return;
    }
    let file = raster.to_file([0, 0], raster.size(), note.as_deref());
    let file = file.unwrap_or_else(|error| panic!("{error}"));
    let (again, noted) = Raster::from_file(&file).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((again.bytes(), noted), (raster.bytes(), note), "read again");
    let mut larger = raster.blank([width + 1, height + 1]).unwrap_or_else(|e| panic!("{e}"));
    assert!(larger.put([1, 1], &raster), "it fits");
    assert!(!larger.put([2, 1], &raster), "it is one column too wide there");
}

/// Meshes, cuts and samples a scene, and writes the results in every format.
pub fn mesh(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(scene) = Compiler::new().compile(NAME, text) else { return };
    if !scene.draws() || scene.report().distance_cost.operations > MAX_OPERATIONS {
        return;
    }
    let options = MeshOptions::new().error(MeshSize::Relative(ERROR)).max_cells(MAX_CELLS);
    write_mesh(&scene, &options);
    write_contour(&scene, &options);
    write_grid(&scene);
}

fn write_mesh(scene: &Scene, options: &MeshOptions) {
    let Ok(mesh) = scene.mesh(options, &mut |_| ControlFlow::Continue(())) else { return };
    for format in ["a.stl", "a.obj", "a.ply", "a.glb", "a.3mf"] {
        let format = MeshFormat::of(format.as_ref()).expect("the extension of a format");
        // Some formats cannot hold every mesh, and say so.
        let _ = format.encode(&mesh);
    }
}

fn write_contour(scene: &Scene, options: &MeshOptions) {
    let plane = Plane::new([0.3, 0.2, 1.0], 0.1).expect("a plane");
    let Ok(contour) = scene.contour(plane, options, &mut |_| ControlFlow::Continue(())) else {
        return;
    };
    for format in ["a.svg", "a.dxf"] {
        let format = ContourFormat::of(format.as_ref()).expect("the extension of a format");
        format.encode(&contour);
    }
}

fn write_grid(scene: &Scene) {
    let options = BakeOptions::new().resolution(4);
    let Ok(grid) = scene.bake(&options, &mut |_| ControlFlow::Continue(())) else { return };
    for format in ["a.npy", "a.nrrd"] {
        let format = GridFormat::of(format.as_ref()).expect("the extension of a format");
        format.encode(&grid);
    }
}
