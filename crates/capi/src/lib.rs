//! The C interface of the compiler and of the fields of its scenes. The header `sdfc.h` in this
//! crate is generated from it.
//!
//! The library opens no files: a callback of the calling program reads the files that a scene
//! imports, otherwise imports are errors. Every function detects null pointers and text that is not
//! UTF-8. On any error, a returned pointer is null, a returned status is not [`Status::Ok`], and
//! [`sdfc_error`] returns the reason.
//!
//! A panic is caught at this boundary and returned as [`Status::Internal`], because nothing may
//! unwind into C. No input is known to cause one; lints and tests with arbitrary input check this.

mod boundary;
mod files;
mod status;

use std::ffi::{CString, c_char, c_void};

use sdfc::{Compiler, Emit, FrameValues, Reflection, ShaderOptions, Target, uniform_bytes};

use boundary::{Failure, fill, guarded, handle, handle_mut, slice, slice_mut, text};
use files::CallbackResolver;
pub use files::{File, Read, sdfc_file_give};
pub use status::Status;

/// A compiled scene, and values of its params.
///
/// Functions that take the scene as `const` may run in any number of threads at once, but not while
/// another function changes the scene.
#[derive(Debug)]
pub struct Scene {
    scene: sdfc::Scene,
    frame: FrameValues,
}

/// A scene written as a shader.
#[derive(Debug)]
pub struct Shader {
    /// The code with a null byte behind it.
    code: Vec<u8>,
    reflection: Reflection,
    described: CString,
}

/// Returns the version of sdfc, such as `0.1.0`. Do not free it.
#[unsafe(no_mangle)]
pub extern "C" fn sdfc_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// Returns the message of the last error of this thread, or an empty string if the last call
/// succeeded. It is valid until the thread's next call.
#[unsafe(no_mangle)]
pub extern "C" fn sdfc_error() -> *const c_char {
    boundary::last_error()
}

/// Compiles a scene from `length` bytes of UTF-8 source. Messages use `name` as its file name.
///
/// If `diagnostics` is not null, a JSON array of all diagnostics is stored there, as `sdfc check
/// --json` writes it. Free it with `sdfc_string_free`.
///
/// Returns null if the source has errors or imports a file. Free the scene with `sdfc_scene_free`.
///
/// # Safety
///
/// `name` ends in a null byte. `source` is valid for `length` bytes. `diagnostics` is null or valid
/// for a write.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_compile(
    name: *const c_char,
    source: *const c_char,
    length: usize,
    diagnostics: *mut *mut c_char,
) -> *mut Scene {
    let (read, context) = (None, std::ptr::null_mut());
    // SAFETY: guaranteed by the caller; without a callback nothing is called.
    unsafe { sdfc_compile_with_files(name, source, length, read, context, diagnostics) }
}

/// Compiles a scene like `sdfc_compile`, but `read` provides the files that it imports. `read` is
/// called with `context`, in this thread, before this function returns. If `read` is null, imports
/// are errors.
///
/// # Safety
///
/// The conditions of `sdfc_compile` hold. `read` may be called with `context`, and returns
/// normally: no exceptions and no jumps out of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_compile_with_files(
    name: *const c_char,
    source: *const c_char,
    length: usize,
    read: Read,
    context: *mut c_void,
    diagnostics: *mut *mut c_char,
) -> *mut Scene {
    let mut made = std::ptr::null_mut();
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (name, source) = unsafe { (text(name)?, slice(source.cast::<u8>(), length)?) };
        let source = std::str::from_utf8(source).map_err(|_| Failure::not_utf8("source"))?;
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let files = unsafe { CallbackResolver::new(read, context) };
        let compiled = Compiler::new().resolver(&files).compile(name, source);
        if !diagnostics.is_null() {
            let rows = match &compiled {
                Ok(scene) => scene.diagnostics().rows(),
                Err(errors) => errors.rows(),
            };
            let rows = c_string(serde_json::to_string(&rows).map_err(Failure::internal)?)?;
            // SAFETY: the pointer is not null, and the caller guarantees that it may be written.
            unsafe { *diagnostics = rows.into_raw() };
        }
        let scene = compiled.map_err(Failure::scene)?;
        let frame = scene.defaults();
        made = Box::into_raw(Box::new(Scene { scene, frame }));
        Ok(())
    });
    made
}

/// Frees a scene. Does nothing for null.
///
/// # Safety
///
/// The scene was returned by `sdfc_compile` or `sdfc_compile_with_files` and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_scene_free(scene: *mut Scene) {
    if !scene.is_null() {
        // SAFETY: the pointer came from a `Box`, and the caller does not use it again.
        drop(unsafe { Box::from_raw(scene) });
    }
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

/// Sets the param with a name. The value is written as in a scene: `0.5`, `90deg`, `true`,
/// `#d94f30`; a choice by its name.
///
/// A param that decides what the scene consists of, such as a number of copies, cannot change in a
/// compiled scene: that is an error.
///
/// # Safety
///
/// `scene` is null or a valid scene. Both strings end in a null byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_set(
    scene: *mut Scene,
    param: *const c_char,
    value: *const c_char,
) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, param, value) = unsafe { (handle_mut(scene)?, text(param)?, text(value)?) };
        scene.scene.set_param(&mut scene.frame, param, value).map_err(Failure::argument)
    })
}

/// Sets a param that is a number, an integer or an angle in radians.
///
/// # Safety
///
/// `scene` is null or a valid scene. The name ends in a null byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_set_number(
    scene: *mut Scene,
    param: *const c_char,
    value: f64,
) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, param) = unsafe { (handle_mut(scene)?, text(param)?) };
        scene.scene.set(&mut scene.frame, param, value).map_err(Failure::argument)
    })
}

/// Sets the values of `time`, in seconds, and `frame`, an integer, in the scene.
///
/// # Safety
///
/// `scene` is null or a valid scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_set_time(scene: *mut Scene, time: f64, frame: f64) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let scene = unsafe { handle_mut(scene)? };
        (scene.frame.time, scene.frame.frame) = (time, frame);
        Ok(())
    })
}

/// Computes the signed distances at `count` points, each given as x, y, z. If the scene is
/// certified, they never exceed the true distances.
///
/// # Safety
///
/// `scene` is null or a valid scene. `points` has 3 numbers for each point, `distances` has room
/// for 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_distance(
    scene: *const Scene,
    points: *const f64,
    count: usize,
    distances: *mut f64,
) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, points, to) =
            unsafe { (handle(scene)?, slice(points.cast(), count)?, slice_mut(distances, count)?) };
        let mut field = scene.scene.field(&scene.frame).map_err(Failure::scene)?;
        to.copy_from_slice(&field.distances(points));
        Ok(())
    })
}

/// Computes the gradient of the distance and the distance at `count` points: x, y, z, distance for
/// each.
///
/// # Safety
///
/// `scene` is null or a valid scene. `points` has 3 numbers for each point, `gradients` has room
/// for 4.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_gradient(
    scene: *const Scene,
    points: *const f64,
    count: usize,
    gradients: *mut f64,
) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, points, to) = unsafe {
            (handle(scene)?, slice(points.cast(), count)?, slice_mut(gradients.cast(), count)?)
        };
        let mut field = scene.scene.field(&scene.frame).map_err(Failure::scene)?;
        for (to, point) in to.iter_mut().zip(points) {
            let found = field.gradient(*point);
            let [x, y, z] = found.gradient;
            *to = [x, y, z, found.distance];
        }
        Ok(())
    })
}

/// Computes the lowest and the highest corner of a box that contains the surface, three numbers
/// each. A number is infinite if the surface has no bound on that side.
///
/// # Safety
///
/// `scene` is null or a valid scene. `lowest` and `highest` have room for 3 numbers each.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_bounds(
    scene: *const Scene,
    lowest: *mut f64,
    highest: *mut f64,
) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, lowest, highest) =
            unsafe { (handle(scene)?, slice_mut(lowest, 3)?, slice_mut(highest, 3)?) };
        let bounds = scene.scene.bounds_at(&scene.frame);
        let [lo, hi] = bounds.ok_or_else(|| Failure::scene(sdfc::Error::NothingDrawn))?;
        lowest.copy_from_slice(&lo);
        highest.copy_from_slice(&hi);
        Ok(())
    })
}

/// Writes the scene as a shader.
///
/// `target` is one of `wgsl`, `glsl`, `glsl-es`, `hlsl`, `msl`, `spirv`, `shadertoy`. `part` is one
/// of `field`, `march`, `render`. Names in the shader begin with `prefix`, and the first buffer has
/// the index `binding` in `group`. The defaults for null are `wgsl`, `field` and `sdf_`.
///
/// Returns null if the shader cannot be written. Free the shader with `sdfc_shader_free`.
///
/// # Safety
///
/// `scene` is null or a valid scene. The strings are null or end in a null byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_shader_write(
    scene: *const Scene,
    target: *const c_char,
    part: *const c_char,
    prefix: *const c_char,
    group: u32,
    binding: u32,
) -> *mut Shader {
    let mut made = std::ptr::null_mut();
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, [target, part, prefix]) = unsafe {
            let or = |given: *const c_char, default| {
                if given.is_null() { Ok(default) } else { text(given) }
            };
            (handle(scene)?, [or(target, "wgsl")?, or(part, "field")?, or(prefix, "sdf_")?])
        };
        let (target, emit) = (target_of(target)?, emit_of(part)?);
        let stage = if target.has_stage(sdfc::Stage::Compute) {
            sdfc::Stage::Compute
        } else {
            sdfc::Stage::Fragment
        };
        let prefix = prefix.to_owned();
        let options = ShaderOptions::new()
            .target(target)
            .emit(emit)
            .stage(stage)
            .prefix(prefix)
            .group(group)
            .binding(binding);
        let written = scene.scene.write_shader(&options).map_err(Failure::scene)?;
        let described = scene.scene.reflect(&options, &written);
        let described = c_string(serde_json::to_string(&described).map_err(Failure::internal)?)?;
        let mut code = written.code.into_bytes();
        code.push(0);
        let shader = Shader { code, reflection: written.reflection, described };
        made = Box::into_raw(Box::new(shader));
        Ok(())
    });
    made
}

/// Returns the source of the shader, or its words in SPIR-V, with a null byte behind. If `length`
/// is not null, the number of bytes without that null byte is stored there. Returns null for null.
///
/// # Safety
///
/// `shader` is null or a valid shader, and is not freed while the code is used. `length` is null or
/// valid for a write.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_shader_code(
    shader: *const Shader,
    length: *mut usize,
) -> *const c_char {
    let mut code = std::ptr::null();
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let shader = unsafe { handle(shader)? };
        if !length.is_null() {
            // SAFETY: the pointer is not null, and the caller guarantees that it may be written.
            unsafe { *length = shader.code.len() - 1 };
        }
        code = shader.code.as_ptr().cast();
        Ok(())
    });
    code
}

/// Returns the reflection of the shader as JSON, as `sdfc compile --reflect` writes it: its
/// functions, its inputs, and the certificate of its field. Returns null for null.
///
/// # Safety
///
/// `shader` is null or a valid shader, and is not freed while the string is used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_shader_reflection(shader: *const Shader) -> *const c_char {
    let mut described = std::ptr::null();
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        described = unsafe { handle(shader)? }.described.as_ptr();
        Ok(())
    });
    described
}

/// Computes the bytes of the shader's uniform buffer for the current values of the scene's params.
///
/// Stores the number of bytes in `length`: 0 if the shader has no uniform buffer. If `bytes` is not
/// null, writes the bytes there; `capacity` must be large enough.
///
/// # Safety
///
/// `shader` was written from `scene`; both are null or valid. `bytes` is null or has room for
/// `capacity` bytes. `length` is null or valid for a write.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_shader_uniform(
    shader: *const Shader,
    scene: *const Scene,
    bytes: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (shader, scene, length) =
            unsafe { (handle(shader)?, handle(scene)?, handle_mut(length)?) };
        let found = uniform_bytes(&shader.reflection, &scene.frame);
        *length = found.len();
        if bytes.is_null() {
            return Ok(());
        }
        // SAFETY: the pointer is not null, and the caller guarantees the room.
        fill(unsafe { slice_mut(bytes, capacity)? }, &found)
    })
}

/// Frees a shader. Does nothing for null.
///
/// # Safety
///
/// The shader was returned by `sdfc_shader_write` and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_shader_free(shader: *mut Shader) {
    if !shader.is_null() {
        // SAFETY: the pointer came from a `Box`, and the caller does not use it again.
        drop(unsafe { Box::from_raw(shader) });
    }
}

fn target_of(name: &str) -> Result<Target, Failure> {
    let found = Target::ALL.into_iter().find(|target| target.name() == name);
    found.ok_or_else(|| Failure::argument(format!("unknown target `{name}`")))
}

fn emit_of(name: &str) -> Result<Emit, Failure> {
    let found =
        [Emit::Field, Emit::March, Emit::Render].into_iter().find(|emit| emit.name() == name);
    found.ok_or_else(|| {
        Failure::argument(format!("unknown part `{name}`; the parts are field, march, render"))
    })
}

/// Converts JSON to a C string. JSON escapes null bytes, so it has none.
fn c_string(text: String) -> Result<CString, Failure> {
    CString::new(text).map_err(Failure::internal)
}
