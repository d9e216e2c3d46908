//! Outlines of sections of a scene.

use std::ffi::{CString, c_char, c_void};
use std::path::Path;

use sdfc::{ContourFormat, Plane};
use serde::Deserialize;

use crate::boundary::{Failure, boxed, free, handle, json, pointer_into, text};
use crate::bytes::Bytes;
use crate::mesh::mesh_options;
use crate::options::options;
use crate::progress::{Progress, Reporter};
use crate::scene::Scene;

/// The closed paths around a section of a scene.
#[derive(Debug)]
pub struct Contour {
    contour: sdfc::Contour,
    described: CString,
}

/// The options of a contour.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct ContourKeys {
    normal: Option<[f64; 3]>,
    offset: f64,
    error: Option<f64>,
    error_relative: Option<f64>,
    max_cells: Option<u64>,
    arcs: bool,
}

/// Makes the closed paths around the section of a scene by a plane, on all cores of the machine.
///
/// `options` is a JSON object with the keys of `sdfc_mesh_make` and these, all of them optional;
/// null is the same as `{}`. `normal`: the normal of the plane, of any length, by default
/// `[0, 0, 1]`. `offset`: the coordinate of the plane along its normal, in scene units, by default
/// 0. `arcs`: true if paths may have circular arcs, which are described by their bulges.
///
/// Returns null if the plane meets no inside, and in the cases of `sdfc_mesh_make`. Free the
/// contour with `sdfc_contour_free`.
///
/// # Safety
///
/// As for `sdfc_mesh_make`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_contour_make(
    scene: *const Scene,
    options: *const c_char,
    progress: Progress,
    context: *mut c_void,
) -> *mut Contour {
    boxed(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, keys, reporter) = unsafe {
            let keys = self::options::<ContourKeys>(options)?;
            (handle(scene)?, keys, Reporter::new(progress, context))
        };
        let ContourKeys { normal, offset, error, error_relative, max_cells, arcs } = keys;
        let normal = normal.unwrap_or([0.0, 0.0, 1.0]);
        let no_plane = || {
            let message = format!("no plane has the normal {normal:?} and the offset {offset}");
            Failure::argument(message)
        };
        let plane = Plane::new(normal, offset).ok_or_else(no_plane)?;
        let options = mesh_options(scene, error, error_relative, max_cells)?.has_arcs(arcs);
        let mut report = |at: sdfc::MeshProgress| reporter.report(at.done, at.total);
        let contour = scene.scene.contour(plane, &options, &mut report)?;
        let described = json(&scene.scene.reported(&scene.frame, contour.report(&plane)))?;
        Ok(Contour { contour, described })
    })
}

/// Returns the contour as JSON, as `sdfc contour --json` writes it: its paths in the coordinates of
/// the plane, the position and the directions of these coordinates in space, its area, length and
/// bounds, and the certificate. `left_out` lists the solids or regions that the contour leaves out,
/// as in `sdfc_mesh_describe`. Returns null for null.
///
/// # Safety
///
/// `contour` is null or a valid contour, and is not freed while the string is used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_contour_describe(contour: *const Contour) -> *const c_char {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { pointer_into(contour, |contour| contour.described.as_ptr()) }
}

/// Writes the contour as a file: `svg` or `dxf`.
///
/// Returns null if the format is unknown. Free the result with `sdfc_bytes_free`.
///
/// # Safety
///
/// `contour` is null or a valid contour. `format` ends in a null byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_contour_write(
    contour: *const Contour,
    format: *const c_char,
) -> *mut Bytes {
    boxed(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (contour, format) = unsafe { (handle(contour)?, text(format)?) };
        let format = ContourFormat::of(Path::new(&format!("contour.{format}")));
        let bytes = format.map_err(Failure::argument)?.encode(&contour.contour);
        Ok(Bytes(bytes))
    })
}

/// Frees a contour. Does nothing for null.
///
/// # Safety
///
/// The contour was returned by `sdfc_contour_make` and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_contour_free(contour: *mut Contour) {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { free(contour) }
}
