//! The compiler and the fields of its scenes for C: see `sdfc.h` beside this crate, which is made from it.
//!
//! Nothing here opens files: a scene that imports others has them from a function of the program that calls, or is refused. Every function takes null and text that is not
//! UTF-8 without harm, and says so: a pointer that it gives is then null, a status is not [`Status::Ok`], and
//! [`sdfc_error`] says why. The compiler does not panic, which lints and tests with arbitrary input hold; should it all the
//! same, that ends at this boundary as [`Status::Internal`], for nothing may unwind into C.

mod boundary;
mod files;

use std::ffi::{CString, c_char, c_void};

use sdfc::codegen::Reflection;
use sdfc::{Emit, FrameValues, ShaderOptions, Target, uniform_bytes};

use boundary::{Failure, fill, guarded, handle, handle_mut, slice, slice_mut, text};
use files::Host;
pub use files::{File, Read, sdfc_file_give};

/// How a call ended.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// As asked.
    Ok = 0,
    /// A pointer is null that may not be.
    Null = 1,
    /// A text is not UTF-8.
    NotUtf8 = 2,
    /// There is no such target, part, param or value, or no room.
    Argument = 3,
    /// The scene has errors, draws nothing, or cannot be written so.
    Scene = 4,
    /// A fault of sdfc.
    Internal = 5,
}

/// A compiled scene, and values of its params.
///
/// Any number of threads may call functions that take it as `const`, while none calls another.
#[derive(Debug)]
pub struct Scene {
    scene: sdfc::Scene,
    frame: FrameValues,
}

/// A scene written as a shader.
#[derive(Debug)]
pub struct Shader {
    /// With a null behind it.
    code: Vec<u8>,
    reflection: Reflection,
    described: CString,
}

/// The version of sdfc, such as `0.1.0`. Not to be freed.
#[unsafe(no_mangle)]
pub extern "C" fn sdfc_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// Why the last call of this thread failed, as text for people; empty if it did not. Valid until the thread's next call.
#[unsafe(no_mangle)]
pub extern "C" fn sdfc_error() -> *const c_char {
    boundary::last_error()
}

/// Compiles a scene: `length` bytes of source, UTF-8; `name` is what messages call it. Where `diagnostics` is not null, a
/// JSON array of all findings is stored there, as `sdfc check --json` writes it, to be freed with `sdfc_string_free`.
///
/// Null where the source has errors, or imports a file; else to be freed with `sdfc_scene_free`.
///
/// # Safety
///
/// `name` ends in a null byte; `source` has that many bytes; `diagnostics` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_compile(
    name: *const c_char,
    source: *const c_char,
    length: usize,
    diagnostics: *mut *mut c_char,
) -> *mut Scene {
    let (read, context) = (None, std::ptr::null_mut());
    // SAFETY: as this function's; nothing is called.
    unsafe { sdfc_compile_with_files(name, source, length, read, context, diagnostics) }
}

/// As `sdfc_compile`, for a scene that imports files: `read` gives them. It is called while this runs, by this thread, with
/// `context`. Null for it is none.
///
/// # Safety
///
/// As `sdfc_compile`; `read` may be called with `context`, and neither throws nor jumps out of it.
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
        // SAFETY: as this function's.
        let (name, source) = unsafe { (text(name)?, slice(source.cast::<u8>(), length)?) };
        let source = std::str::from_utf8(source).map_err(|_| Failure::not_utf8("source"))?;
        // SAFETY: as this function's.
        let host = unsafe { Host::new(read, context) };
        let compiled = sdfc::compile_with_imports(name, source, &host);
        if !diagnostics.is_null() {
            let rows =
                c_string(serde_json::to_string(&compiled.rows()).map_err(Failure::internal)?)?;
            // SAFETY: it is not null and may be written.
            unsafe { *diagnostics = rows.into_raw() };
        }
        let scene = compiled.into_scene().map_err(Failure::scene)?;
        let frame = scene.defaults();
        made = Box::into_raw(Box::new(Scene { scene, frame }));
        Ok(())
    });
    made
}

/// Frees what `sdfc_compile` gave; null is nothing.
///
/// # Safety
///
/// It came from there and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_scene_free(scene: *mut Scene) {
    if !scene.is_null() {
        // SAFETY: it was a box, and nobody has it any more.
        drop(unsafe { Box::from_raw(scene) });
    }
}

/// Frees a text that was given to be freed; null is nothing.
///
/// # Safety
///
/// It came from a function that says so and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_string_free(string: *mut c_char) {
    if !string.is_null() {
        // SAFETY: it was a `CString`, and nobody has it any more.
        drop(unsafe { CString::from_raw(string) });
    }
}

/// Sets a param by its name. The value is written as in a scene: `0.5`, `90deg`, `true`, `#d94f30`; a choice by its name.
///
/// # Safety
///
/// The scene is one of `sdfc_compile`; both texts end in a null byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_set(
    scene: *mut Scene,
    param: *const c_char,
    value: *const c_char,
) -> Status {
    guarded(|| {
        // SAFETY: as this function's.
        let (scene, param, value) = unsafe { (handle_mut(scene)?, text(param)?, text(value)?) };
        scene.scene.set_param(&mut scene.frame, param, value).map_err(Failure::argument)
    })
}

/// Sets a param that is a number, a whole number or an angle in radians.
///
/// # Safety
///
/// The scene is one of `sdfc_compile`; the name ends in a null byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_set_number(
    scene: *mut Scene,
    param: *const c_char,
    value: f64,
) -> Status {
    guarded(|| {
        // SAFETY: as this function's.
        let (scene, param) = unsafe { (handle_mut(scene)?, text(param)?) };
        scene.scene.set(&mut scene.frame, param, value).map_err(Failure::argument)
    })
}

/// Sets what `time`, in seconds, and `frame`, a whole number, are in the scene.
///
/// # Safety
///
/// The scene is one of `sdfc_compile`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_set_time(scene: *mut Scene, time: f64, frame: f64) -> Status {
    guarded(|| {
        // SAFETY: as this function's.
        let scene = unsafe { handle_mut(scene)? };
        (scene.frame.time, scene.frame.frame) = (time, frame);
        Ok(())
    })
}

/// Signed distances at `count` points, each x, y, z one after the other. Never more than the true distance where the
/// scene is certified.
///
/// # Safety
///
/// The scene is one of `sdfc_compile`; `points` has 3 numbers for each point, `distances` room for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_distance(
    scene: *const Scene,
    points: *const f64,
    count: usize,
    distances: *mut f64,
) -> Status {
    guarded(|| {
        // SAFETY: as this function's.
        let (scene, points, to) =
            unsafe { (handle(scene)?, slice(points.cast(), count)?, slice_mut(distances, count)?) };
        let mut field = scene.scene.field(&scene.frame).map_err(Failure::scene)?;
        to.copy_from_slice(&field.distances(points));
        Ok(())
    })
}

/// The derivative of the distance at `count` points, and the distance: x, y, z, distance for each.
///
/// # Safety
///
/// The scene is one of `sdfc_compile`; `points` has 3 numbers for each point, `gradients` room for 4.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_gradient(
    scene: *const Scene,
    points: *const f64,
    count: usize,
    gradients: *mut f64,
) -> Status {
    guarded(|| {
        // SAFETY: as this function's.
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

/// Lowest and highest corner of a box that holds the surface, three numbers each; infinite where there is no end.
///
/// # Safety
///
/// The scene is one of `sdfc_compile`; both have room for 3 numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_bounds(
    scene: *const Scene,
    lowest: *mut f64,
    highest: *mut f64,
) -> Status {
    guarded(|| {
        // SAFETY: as this function's.
        let (scene, lowest, highest) =
            unsafe { (handle(scene)?, slice_mut(lowest, 3)?, slice_mut(highest, 3)?) };
        let bounds = scene.scene.bounds_at(&scene.frame);
        let [lo, hi] = bounds.ok_or_else(|| Failure::scene(sdfc::Error::NothingDrawn))?;
        lowest.copy_from_slice(&lo);
        highest.copy_from_slice(&hi);
        Ok(())
    })
}

/// Writes the scene as a shader. `target` is one of `wgsl`, `glsl`, `glsl-es`, `hlsl`, `msl`, `spirv`, `shadertoy`; `part` one of
/// `field`, `march`, `render`; names begin with `prefix`, and the first buffer is at `group` and `binding`. Null for a text
/// is `wgsl`, `field` and `sdf_`.
///
/// Null where that cannot be; else to be freed with `sdfc_shader_free`.
///
/// # Safety
///
/// The scene is one of `sdfc_compile`; texts end in a null byte.
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
        // SAFETY: as this function's.
        let (scene, [target, part, prefix]) = unsafe {
            let or =
                |given: *const c_char, other| if given.is_null() { Ok(other) } else { text(given) };
            (handle(scene)?, [or(target, "wgsl")?, or(part, "field")?, or(prefix, "sdf_")?])
        };
        let (target, emit) = (target_of(target)?, emit_of(part)?);
        let stage = if target.has_stage(sdfc::Stage::Compute) {
            sdfc::Stage::Compute
        } else {
            sdfc::Stage::Fragment
        };
        let prefix = prefix.to_owned();
        let options =
            ShaderOptions { target, emit, stage, prefix, group, binding, ..Default::default() };
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

/// The shader's text or words, `length` bytes if that is not null; behind them there is a null byte. Null for null.
///
/// # Safety
///
/// The shader is one of `sdfc_shader_write`, and is not freed while the code is used; `length` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_shader_code(
    shader: *const Shader,
    length: *mut usize,
) -> *const c_char {
    let mut code = std::ptr::null();
    guarded(|| {
        // SAFETY: as this function's.
        let shader = unsafe { handle(shader)? };
        if !length.is_null() {
            // SAFETY: it is not null and may be written.
            unsafe { *length = shader.code.len() - 1 };
        }
        code = shader.code.as_ptr().cast();
        Ok(())
    });
    code
}

/// What the shader offers and reads, and what is certified of its field, as JSON: that of `sdfc compile --reflect`. Null
/// for null.
///
/// # Safety
///
/// The shader is one of `sdfc_shader_write`, and is not freed while the text is used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_shader_reflection(shader: *const Shader) -> *const c_char {
    let mut described = std::ptr::null();
    guarded(|| {
        // SAFETY: as this function's.
        described = unsafe { handle(shader)? }.described.as_ptr();
        Ok(())
    });
    described
}

/// The bytes of the shader's uniform buffer for the values that the scene has. Stores how many they are, 0 where the shader has
/// no such buffer, in `length`, and the bytes themselves where `bytes` is not null and `capacity` is as much.
///
/// # Safety
///
/// The shader was written of this scene; `bytes` has room for `capacity`; `length` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_shader_uniform(
    shader: *const Shader,
    scene: *const Scene,
    bytes: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Status {
    guarded(|| {
        // SAFETY: as this function's.
        let (shader, scene, length) =
            unsafe { (handle(shader)?, handle(scene)?, handle_mut(length)?) };
        let found = uniform_bytes(&shader.reflection, &scene.frame);
        *length = found.len();
        if bytes.is_null() {
            return Ok(());
        }
        // SAFETY: it is not null and has that room.
        fill(unsafe { slice_mut(bytes, capacity)? }, &found)
    })
}

/// Frees what `sdfc_shader_write` gave; null is nothing.
///
/// # Safety
///
/// It came from there and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_shader_free(shader: *mut Shader) {
    if !shader.is_null() {
        // SAFETY: it was a box, and nobody has it any more.
        drop(unsafe { Box::from_raw(shader) });
    }
}

fn target_of(name: &str) -> Result<Target, Failure> {
    let found = Target::ALL.into_iter().find(|target| target.name() == name);
    found.ok_or_else(|| Failure::argument(format!("there is no target `{name}`")))
}

fn emit_of(name: &str) -> Result<Emit, Failure> {
    let found =
        [Emit::Field, Emit::March, Emit::Render].into_iter().find(|emit| emit.name() == name);
    found.ok_or_else(|| {
        Failure::argument(format!("there is no part `{name}`: field, march, render"))
    })
}

/// JSON has no null byte, which it would escape.
fn c_string(text: String) -> Result<CString, Failure> {
    CString::new(text).map_err(Failure::internal)
}
