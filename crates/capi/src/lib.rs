//! The C interface of the compiler, and of the fields, meshes and pictures of its scenes. The
//! header `sdfc.h` in this crate is generated from it.
//!
//! Meshes, contours and measurements need the feature `mesh`, and pictures the feature `render`;
//! both are on by default. Without them the library is the compiler alone.
//!
//! The library opens no files: a callback of the calling program reads the files that a scene
//! imports, otherwise imports are errors. Every function detects null pointers and text that is not
//! UTF-8. On any error, a returned pointer is null, a returned status is not [`Status::Ok`], and
//! [`sdfc_error`] returns the reason.
//!
//! A panic is caught at this boundary and returned as [`Status::Internal`], because nothing may
//! unwind into C. No input is known to cause one; lints and tests with arbitrary input check this.

mod boundary;
#[cfg(any(feature = "mesh", feature = "render"))]
mod bytes;
#[cfg(feature = "mesh")]
mod contour;
mod field;
mod files;
#[cfg(feature = "mesh")]
mod mesh;
mod options;
#[cfg(feature = "render")]
mod picture;
#[cfg(any(feature = "mesh", feature = "render"))]
mod progress;
mod scene;
mod shader;
mod status;

use std::ffi::{CString, c_char};

#[cfg(any(feature = "mesh", feature = "render"))]
pub use bytes::{Bytes, sdfc_bytes_data, sdfc_bytes_free};
#[cfg(feature = "mesh")]
pub use contour::{
    Contour, sdfc_contour_describe, sdfc_contour_free, sdfc_contour_make, sdfc_contour_write,
};
pub use field::{sdfc_bounds, sdfc_distance, sdfc_gradient};
pub use files::{File, Read, sdfc_file_give};
#[cfg(feature = "mesh")]
pub use mesh::{
    Mesh, sdfc_measure, sdfc_mesh_colors, sdfc_mesh_describe, sdfc_mesh_free, sdfc_mesh_make,
    sdfc_mesh_normals, sdfc_mesh_triangles, sdfc_mesh_vertices, sdfc_mesh_write,
};
#[cfg(feature = "render")]
pub use picture::{
    Picture, sdfc_picture_depths, sdfc_picture_describe, sdfc_picture_free, sdfc_picture_png,
    sdfc_picture_rgba, sdfc_picture_size, sdfc_render,
};
#[cfg(any(feature = "mesh", feature = "render"))]
pub use progress::Progress;
pub use scene::{
    Scene, sdfc_compile, sdfc_compile_with_files, sdfc_compile_with_values, sdfc_scene_copy,
    sdfc_scene_describe, sdfc_scene_free, sdfc_set, sdfc_set_number, sdfc_set_time,
};
pub use shader::{
    Shader, sdfc_shader_code, sdfc_shader_free, sdfc_shader_reflection, sdfc_shader_uniform,
    sdfc_shader_write,
};
pub use status::Status;

/// Returns the version of sdfc, such as `0.1.0`. Do not free it.
#[unsafe(no_mangle)]
pub extern "C" fn sdfc_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// Returns the message of the last error of this thread, or an empty string if the last call
/// succeeded. It is valid until the thread's next call. Functions that free an object, and
/// `sdfc_version`, do not change it.
#[unsafe(no_mangle)]
pub extern "C" fn sdfc_error() -> *const c_char {
    boundary::last_error()
}

/// Returns the status of the last call of this thread, also of one that returned a pointer.
#[unsafe(no_mangle)]
pub extern "C" fn sdfc_error_status() -> Status {
    boundary::last_status()
}

/// Frees a string that the caller must free. Does nothing for null.
///
/// # Safety
///
/// The string came from a function whose documentation says so, and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_string_free(string: *mut c_char) {
    if !string.is_null() {
        // SAFETY: the pointer came from a `CString`, and the caller does not use it again.
        drop(unsafe { CString::from_raw(string) });
    }
}
