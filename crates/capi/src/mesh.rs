//! Closed meshes of a scene, and measurements.

use std::ffi::{CString, c_char, c_void};
use std::path::Path;

use sdfc::{MeasureOptions, MeshFormat, MeshOptions, MeshSize};
use serde::Deserialize;

use crate::boundary::{
    Failure, boxed, free, guarded, handle, json, pointer_into, store, string, text,
};
use crate::bytes::Bytes;
use crate::options::options;
use crate::progress::{Progress, Reporter};
use crate::scene::Scene;

/// A closed mesh of triangles.
#[derive(Debug)]
pub struct Mesh {
    mesh: sdfc::Mesh,
    described: CString,
}

/// The options of a mesh.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct MeshKeys {
    error: Option<f64>,
    error_relative: Option<f64>,
    max_cells: Option<u64>,
}

/// The options of a measurement.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct MeasureKeys {
    error_relative: Option<f64>,
    max_cells: Option<u64>,
}

/// Returns the options of a mesh or a contour of a scene.
pub(crate) fn mesh_options(
    scene: &Scene,
    error: Option<f64>,
    error_relative: Option<f64>,
    max_cells: Option<u64>,
) -> Result<MeshOptions, Failure> {
    let options = MeshOptions::new().frame(scene.frame.clone());
    let options = match (error, error_relative) {
        (Some(_), Some(_)) => {
            let message = "the options state `error` and `error_relative`: state one of them";
            return Err(Failure::argument(message));
        }
        (Some(length), None) => options.error(MeshSize::Length(length)),
        (None, Some(fraction)) => options.error(MeshSize::Relative(fraction)),
        (None, None) => options,
    };
    Ok(match max_cells {
        Some(limit) => options.max_cells(limit),
        None => options,
    })
}

/// Makes a closed mesh of the scene's surface, on all cores of the machine.
///
/// `options` is a JSON object with these keys, all of them optional; null is the same as `{}`.
/// `error`: the greatest distance between mesh and surface, in scene units. `error_relative`: the
/// same as a fraction of the longest side of the scene's bounds, by default 0.001. `max_cells`: the
/// most cells that are examined, by default 50000000, which take some gigabytes of memory.
///
/// `progress` is called with `context`; it may be null.
///
/// Returns null if the scene has no limit or no inside, the error is too small or greater than the
/// scene, or `progress` stops the work. Free the mesh with `sdfc_mesh_free`.
///
/// # Safety
///
/// `scene` is null or a valid scene. `options` is null or ends in a null byte. `progress` may be
/// called with `context`, and returns normally.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_mesh_make(
    scene: *const Scene,
    options: *const c_char,
    progress: Progress,
    context: *mut c_void,
) -> *mut Mesh {
    boxed(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, keys, reporter) = unsafe {
            (handle(scene)?, self::options::<MeshKeys>(options)?, Reporter::new(progress, context))
        };
        let MeshKeys { error, error_relative, max_cells } = keys;
        let options = mesh_options(scene, error, error_relative, max_cells)?;
        let mut report = |at: sdfc::MeshProgress| reporter.report(at.done, at.total);
        let mesh = scene.scene.mesh(&options, &mut report)?;
        let described = json(&scene.scene.reported(&scene.frame, mesh.report()))?;
        Ok(Mesh { mesh, described })
    })
}

/// Returns the positions of the vertices in scene units, x, y, z for each, and stores the number of
/// vertices in `count`.
///
/// # Safety
///
/// `mesh` is null or a valid mesh, and is not freed while the numbers are used. `count` is null or
/// valid for a write.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_mesh_vertices(mesh: *const Mesh, count: *mut usize) -> *const f64 {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { rows(mesh, count, |mesh| &mesh.vertices) }
}

/// Returns the normals at the vertices, x, y, z for each, of length 1, and stores the number of
/// vertices in `count`. On a sharp edge the normal is that of one side.
///
/// # Safety
///
/// As for `sdfc_mesh_vertices`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_mesh_normals(mesh: *const Mesh, count: *mut usize) -> *const f64 {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { rows(mesh, count, |mesh| &mesh.normals) }
}

/// Returns the colours at the vertices, linear red, green and blue for each, and stores their
/// number in `count`: 0 if the scene has no materials.
///
/// # Safety
///
/// As for `sdfc_mesh_vertices`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_mesh_colors(mesh: *const Mesh, count: *mut usize) -> *const f32 {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { rows(mesh, count, |mesh| &mesh.colors) }
}

/// Returns the triangles as indices of vertices, three for each, counter-clockwise as seen from
/// outside, and stores the number of triangles in `count`.
///
/// # Safety
///
/// As for `sdfc_mesh_vertices`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_mesh_triangles(mesh: *const Mesh, count: *mut usize) -> *const u32 {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { rows(mesh, count, |mesh| &mesh.triangles) }
}

/// Returns rows of three numbers of a mesh, and stores the number of rows.
///
/// # Safety
///
/// As for `sdfc_mesh_vertices`.
unsafe fn rows<T>(
    mesh: *const Mesh,
    count: *mut usize,
    of: impl FnOnce(&sdfc::Mesh) -> &[[T; 3]],
) -> *const T {
    let mut first = std::ptr::null();
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        unsafe {
            let rows = of(&handle(mesh)?.mesh);
            store(count, &[rows.len()])?;
            first = rows.as_ptr().cast();
        }
        Ok(())
    });
    first
}

/// Returns what is known about the mesh as JSON, as `sdfc mesh --json` writes it: the numbers of
/// its vertices and triangles, its volume, area and bounds, its connected parts, and the
/// certificate. `left_out` lists the solids that have no limit, such as a floor, which the mesh
/// leaves out because others of the scene have limits; it is empty if there are none. Returns null
/// for null.
///
/// # Safety
///
/// `mesh` is null or a valid mesh, and is not freed while the string is used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_mesh_describe(mesh: *const Mesh) -> *const c_char {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { pointer_into(mesh, |mesh| mesh.described.as_ptr()) }
}

/// Writes the mesh as a file: `stl`, `obj`, `ply`, `glb` or `3mf`.
///
/// Returns null if the format is unknown or cannot hold the mesh. Free the result with
/// `sdfc_bytes_free`.
///
/// # Safety
///
/// `mesh` is null or a valid mesh. `format` ends in a null byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_mesh_write(mesh: *const Mesh, format: *const c_char) -> *mut Bytes {
    boxed(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (mesh, format) = unsafe { (handle(mesh)?, text(format)?) };
        let format = MeshFormat::of(Path::new(&format!("mesh.{format}")));
        let format = format.map_err(Failure::argument)?;
        let bytes = format.encode(&mesh.mesh).map_err(Failure::argument)?;
        Ok(Bytes(bytes))
    })
}

/// Frees a mesh. Does nothing for null.
///
/// # Safety
///
/// The mesh was returned by `sdfc_mesh_make` and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_mesh_free(mesh: *mut Mesh) {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { free(mesh) }
}

/// Measures the scene, on all cores of the machine: volume, center of mass, inertia and extent as
/// intervals that are proven to hold the truth, as `sdfc measure --json` writes them. `left_out`
/// lists the solids that are not measured, as in `sdfc_mesh_describe`.
///
/// `options` is a JSON object with these keys, all of them optional; null is the same as `{}`.
/// `error_relative`: how exact the volume is, as a fraction of itself, by default 0.001.
/// `max_cells`: the most boxes that are examined, by default 4000000.
///
/// Returns null if the scene has no limit, or `progress` stops the work. Free the string with
/// `sdfc_string_free`.
///
/// # Safety
///
/// As for `sdfc_mesh_make`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_measure(
    scene: *const Scene,
    options: *const c_char,
    progress: Progress,
    context: *mut c_void,
) -> *mut c_char {
    string(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, keys, reporter) = unsafe {
            let keys = self::options::<MeasureKeys>(options)?;
            (handle(scene)?, keys, Reporter::new(progress, context))
        };
        let options = MeasureOptions::new().frame(scene.frame.clone());
        let relative = keys.error_relative.unwrap_or(options.relative);
        let max_cells = keys.max_cells.unwrap_or(options.max_cells);
        let options = options.relative(relative).max_cells(max_cells);
        let mut report = |at: sdfc::MeshProgress| reporter.report(at.done, at.total);
        let found = scene.scene.measure(&options, &mut report)?;
        json(&scene.scene.reported(&scene.frame, found))
    })
}
