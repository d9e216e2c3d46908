//! The interfaces for C and for web pages.
#![expect(unsafe_code, reason = "the functions of the C interface are unsafe to call")]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ptr::null_mut;

use sdfc_capi::{
    File, Scene, sdfc_bytes_free, sdfc_compile_with_values, sdfc_contour_free, sdfc_contour_make,
    sdfc_contour_write, sdfc_distance, sdfc_file_give, sdfc_gradient, sdfc_mesh_free,
    sdfc_mesh_make, sdfc_mesh_write, sdfc_scene_describe, sdfc_scene_free, sdfc_set, sdfc_set_time,
    sdfc_shader_free, sdfc_shader_write, sdfc_string_free,
};

use crate::parts;

/// Options for a mesh or a contour that is made in milliseconds.
const COARSE: &CStr = c"{\"error_relative\": 0.2, \"max_cells\": 50}";
/// Points, three numbers each.
const POINTS: [f64; 6] = [0.5, 0.5, 0.5, -1e30, 0.0, f64::NAN];

/// Compiles a source with options in JSON, as a page does. The answer must be a JSON object.
pub fn web(bytes: &[u8]) {
    let mut parts = parts(bytes).map(String::from_utf8_lossy);
    let source = parts.next().unwrap_or_default();
    let options = parts.next().unwrap_or("{}".into());
    let answer = sdfc_web::compile(&source, &options);
    let value = serde_json::from_str::<serde_json::Value>(&answer);
    assert!(value.is_ok_and(|it| it.is_object()), "{answer}");
}

/// Calls the functions of `sdfc.h`. The parts are the source, the values of params, the contents of
/// every imported file, a param and its value, a target, a file format, and options of a mesh. An
/// empty part has a default, so that a scene alone reaches all functions.
pub fn capi(bytes: &[u8]) {
    let parts: Vec<&[u8]> = parts(bytes).collect();
    let part = |index: usize| parts.get(index).copied().unwrap_or_default();
    let string = |index: usize| string(part(index));
    let or = |index: usize, default: &CStr| match part(index) {
        [] => default.to_owned(),
        _ => string(index),
    };
    // SAFETY: the scene is null or valid until it is freed, below.
    unsafe {
        let scene = compile(part(0), &or(1, c"{}"), &part(2));
        sdfc_set(scene, string(3).as_ptr(), string(4).as_ptr());
        sdfc_set_time(scene, 0.5, 15.0);
        evaluate(scene);
        write_shader(scene, &or(5, c"wgsl"));
        write_mesh(scene, &or(6, c"obj"), &or(7, c"{}"));
        write_contour(scene);
        sdfc_scene_free(scene);
    }
}

/// Returns a string of C. It is empty if the bytes have a null byte.
fn string(bytes: &[u8]) -> CString {
    CString::new(bytes).unwrap_or_default()
}

/// Compiles a scene. Returns null if it has errors.
///
/// # Safety
///
/// None: it is unsafe because the functions of the interface are.
unsafe fn compile(source: &[u8], values: &CStr, file: &&[u8]) -> *mut Scene {
    let context = (&raw const *file).cast_mut().cast::<c_void>();
    let mut diagnostics: *mut c_char = null_mut();
    // SAFETY: the strings end in a null byte, the length is that of the source, `read` gets the
    // context that it expects, and the diagnostics are freed once.
    unsafe {
        let scene = sdfc_compile_with_values(
            c"a.sdf".as_ptr(),
            source.as_ptr().cast(),
            source.len(),
            values.as_ptr(),
            Some(read),
            context,
            &raw mut diagnostics,
        );
        sdfc_string_free(diagnostics);
        sdfc_string_free(sdfc_scene_describe(scene));
        scene
    }
}

/// Gives every import the same file.
unsafe extern "C" fn read(context: *mut c_void, _: *const c_char, file: *mut File) -> c_int {
    // SAFETY: the context is the slice that `compile` passes, which outlives the call.
    unsafe {
        let bytes = *context.cast::<&[u8]>();
        sdfc_file_give(file, bytes.as_ptr().cast(), bytes.len());
    }
    0
}

/// # Safety
///
/// The scene is null or valid, as for the functions below.
unsafe fn evaluate(scene: *const Scene) {
    let (mut distances, mut gradients) = ([0.0; 2], [0.0; 8]);
    // SAFETY: there are two points, and room for two results.
    unsafe {
        sdfc_distance(scene, POINTS.as_ptr(), 2, distances.as_mut_ptr());
        sdfc_gradient(scene, POINTS.as_ptr(), 2, gradients.as_mut_ptr());
    }
}

unsafe fn write_shader(scene: *const Scene, target: &CStr) {
    // SAFETY: the strings end in a null byte, and the shader is freed once.
    unsafe {
        let (part, prefix) = (c"field".as_ptr(), c"a_".as_ptr());
        sdfc_shader_free(sdfc_shader_write(scene, target.as_ptr(), part, prefix, 1, 2));
    }
}

/// Writes a coarse mesh. With the options of the input, the work is stopped as soon as it reports
/// progress, because they may ask for a mesh that takes hours.
unsafe fn write_mesh(scene: *const Scene, format: &CStr, options: &CStr) {
    // SAFETY: the strings end in a null byte, and what is returned is freed once.
    unsafe {
        let mesh = sdfc_mesh_make(scene, COARSE.as_ptr(), None, null_mut());
        sdfc_bytes_free(sdfc_mesh_write(mesh, format.as_ptr()));
        sdfc_mesh_free(mesh);
        sdfc_mesh_free(sdfc_mesh_make(scene, options.as_ptr(), Some(stop), null_mut()));
    }
}

unsafe extern "C" fn stop(_: *mut c_void, _: u64, _: u64) -> c_int {
    1
}

unsafe fn write_contour(scene: *const Scene) {
    // SAFETY: the strings end in a null byte, and what is returned is freed once.
    unsafe {
        let contour = sdfc_contour_make(scene, COARSE.as_ptr(), None, null_mut());
        sdfc_bytes_free(sdfc_contour_write(contour, c"svg".as_ptr()));
        sdfc_contour_free(contour);
    }
}
