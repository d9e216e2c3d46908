//! Scenes written as shaders.

use std::ffi::{CString, c_char};

use sdfc::{Emit, Reflection, ShaderOptions, Target, uniform_bytes};

use crate::boundary::{Failure, boxed, free, guarded, handle, json, pointer_into, store, text};
use crate::scene::Scene;
use crate::status::Status;

/// A scene written as a shader.
#[derive(Debug)]
pub struct Shader {
    /// The code with a null byte behind it.
    code: Vec<u8>,
    reflection: Reflection,
    described: CString,
}

/// Writes the scene as a shader.
///
/// `target` is one of `wgsl`, `glsl`, `glsl-es`, `hlsl`, `msl`, `spirv`, `shadertoy`. `part` is one
/// of `field`, `march`, `render`. Names in the shader begin with `prefix`, and the first buffer has
/// the index `binding` in `group`; both are at most 65535. The defaults for null are `wgsl`,
/// `field` and `sdf_`.
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
    boxed(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (scene, [target, part, prefix]) = unsafe {
            let or = |given: *const c_char, default| {
                if given.is_null() { Ok(default) } else { text(given) }
            };
            (handle(scene)?, [or(target, "wgsl")?, or(part, "field")?, or(prefix, "sdf_")?])
        };
        let target: Target = target.parse().map_err(Failure::argument)?;
        let emit: Emit = part.parse().map_err(Failure::argument)?;
        let options = ShaderOptions::new()
            .target(target)
            .emit(emit)
            .stage(target.default_stage())
            .prefix(prefix)
            .group(group)
            .binding(binding);
        let written = scene.scene.write_shader(&options)?;
        let described = json(&scene.scene.reflect(&options, &written))?;
        let mut code = written.code.into_bytes();
        code.push(0);
        let shader = Shader { code, reflection: written.reflection, described };
        Ok(shader)
    })
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
            unsafe { store(length, &[shader.code.len() - 1])? };
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
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { pointer_into(shader, |shader| shader.described.as_ptr()) }
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
        let (shader, scene) = unsafe { (handle(shader)?, handle(scene)?) };
        let found = uniform_bytes(&shader.reflection, &scene.frame);
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        unsafe { store(length, &[found.len()])? };
        if bytes.is_null() {
            return Ok(());
        }
        if found.len() > capacity {
            let length = found.len();
            return Err(Failure::argument(format!("the buffer is too small for {length} bytes")));
        }
        // SAFETY: the pointer is not null, and there is room for the bytes.
        unsafe { store(bytes, &found) }
    })
}

/// Frees a shader. Does nothing for null.
///
/// # Safety
///
/// The shader was returned by `sdfc_shader_write` and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_shader_free(shader: *mut Shader) {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { free(shader) }
}
