//! Scenes, and values of their params.

use std::collections::BTreeMap;
use std::ffi::{c_char, c_void};
use std::sync::Arc;

use sdfc::{CompileWithError, Compiler, FrameValues, Param, ParamKind};

use crate::boundary::{
    Failure, boxed, free, guarded, handle, handle_mut, json, slice, store, string, text,
};
use crate::files::{CallbackResolver, Read};
use crate::options::options;
use crate::status::Status;

/// A compiled scene, and values of its params.
///
/// Functions that take the scene as `const` may run in any number of threads at once, but not while
/// another function changes the scene.
#[derive(Debug)]
pub struct Scene {
    pub(crate) scene: Arc<sdfc::Scene>,
    pub(crate) frame: FrameValues,
}

/// Compiles a scene from `length` bytes of UTF-8 source. Messages use `name` as its file name.
///
/// If `diagnostics` is not null, a JSON array of all diagnostics is stored there, as `sdfc check
/// --json` writes it, or null if the call fails before it compiles. Free it with `sdfc_string_free`.
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
    let values = std::ptr::null();
    // SAFETY: guaranteed by the caller; without values nothing is read.
    unsafe { sdfc_compile_with_values(name, source, length, values, read, context, diagnostics) }
}

/// Compiles a scene like `sdfc_compile_with_files`, with values for some of its params. These are
/// the only way to set params that decide what the scene consists of, such as a number of copies.
///
/// `values` is a JSON object with strings, by the names of params: `{ "n": "8" }`. Values are
/// written as for `sdfc_set`. They are also the values of params in the compiled scene. Null is the
/// same as `{}`.
///
/// # Safety
///
/// The conditions of `sdfc_compile_with_files` hold. `values` is null or ends in a null byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_compile_with_values(
    name: *const c_char,
    source: *const c_char,
    length: usize,
    values: *const c_char,
    read: Read,
    context: *mut c_void,
    diagnostics: *mut *mut c_char,
) -> *mut Scene {
    boxed(|| {
        if !diagnostics.is_null() {
            // SAFETY: the pointer is not null, and the caller guarantees that it may be written.
            unsafe { store(diagnostics, &[std::ptr::null_mut()])? };
        }
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (name, source) = unsafe { (text(name)?, slice(source.cast::<u8>(), length)?) };
        let source = std::str::from_utf8(source).map_err(|_| Failure::not_utf8("source"))?;
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let (files, values) = unsafe {
            let values = options::<BTreeMap<String, String>>(values)?;
            (CallbackResolver::new(read, context), values)
        };
        let values: Vec<_> = values.iter().map(|(name, value)| (&**name, &**value)).collect();
        // As the command line: a scene that states a wrong clause has errors.
        let compiler = Compiler::new().verify(true).resolver(&files);
        let compiled = compiler.compile_with(name, source, &values);
        if !diagnostics.is_null() {
            let rows = match &compiled {
                Ok(scene) => scene.diagnostics().rows(),
                Err(CompileWithError::Scene(errors)) => errors.rows(),
                Err(_) => Vec::new(),
            };
            let rows = json(&rows)?;
            // SAFETY: the pointer is not null, and the caller guarantees that it may be written.
            unsafe { store(diagnostics, &[rows.into_raw()])? };
        }
        let scene = compiled.map_err(|error| match error {
            CompileWithError::Param(error) => Failure::argument(error),
            error @ (CompileWithError::Scene(_) | _) => Failure::scene(error),
        })?;
        let (frame, scene) = (scene.defaults(), Arc::new(scene));
        Ok(Scene { scene, frame })
    })
}

/// Returns a copy of a scene, with values of its own for params, time and frame. Both share what is
/// compiled, so the copy is cheap. Returns null for null. Free it with `sdfc_scene_free`.
///
/// # Safety
///
/// `scene` is null or a valid scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_scene_copy(scene: *const Scene) -> *mut Scene {
    boxed(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let Scene { scene, frame } = unsafe { handle(scene)? };
        let (scene, frame) = (Arc::clone(scene), frame.clone());
        Ok(Scene { scene, frame })
    })
}

/// Returns what is known about a scene as JSON:
///
/// - `params`: for each param its `name`, `type` (`number`, `int`, `angle`, `bool`, `color` or
///   `choice`), `value` and `default` as lists of numbers (angles in radians, colours linear,
///   choices as an index), `min` and `max` (null without a range), `choices`, `summary`, and
///   `fixed`, which is true if only `sdfc_compile_with_values` sets it;
/// - `certified`: true if distances never exceed the true distances;
/// - `planar`: true if the scene draws regions.
///
/// Returns null for null. Free the string with `sdfc_string_free`.
///
/// # Safety
///
/// `scene` is null or a valid scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_scene_describe(scene: *const Scene) -> *mut c_char {
    string(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let Scene { scene, frame } = unsafe { handle(scene)? };
        let params = scene.params().iter().zip(&frame.params);
        let described = serde_json::json!({
            "params": params.map(|(param, value)| described(param, value)).collect::<Vec<_>>(),
            "certified": scene.is_certified(),
            "planar": scene.is_planar(),
        });
        json(&described)
    })
}

fn described(param: &Param, value: &[f64; 4]) -> serde_json::Value {
    let (kind, lanes) = match param.kind {
        ParamKind::Number => ("number", 1),
        ParamKind::Int => ("int", 1),
        ParamKind::Angle => ("angle", 1),
        ParamKind::Bool => ("bool", 1),
        ParamKind::Color => ("color", 4),
        ParamKind::Choice => ("choice", 1),
    };
    serde_json::json!({
        "name": param.name,
        "type": kind,
        "value": value[..lanes],
        "default": param.default[..lanes],
        "min": param.range.map(|[min, _]| min),
        "max": param.range.map(|[_, max]| max),
        "choices": param.choices,
        "summary": param.summary,
        "fixed": param.fixed.is_some(),
    })
}

/// Frees a scene. Does nothing for null.
///
/// # Safety
///
/// The scene was returned by a function whose documentation says so, and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_scene_free(scene: *mut Scene) {
    // SAFETY: guaranteed by the caller, see the safety section of this function.
    unsafe { free(scene) }
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

/// Sets the values of `time`, in seconds, and `frame`, an integer, in the scene. A time that is not
/// finite, or a frame that is no integer, is an error.
///
/// # Safety
///
/// `scene` is null or a valid scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdfc_set_time(scene: *mut Scene, time: f64, frame: f64) -> Status {
    guarded(|| {
        // SAFETY: guaranteed by the caller, see the safety section of this function.
        let scene = unsafe { handle_mut(scene)? };
        if !(time.is_finite() && frame.is_finite() && frame.fract() == 0.0) {
            return Err(Failure::argument("`time` must be finite, and `frame` an integer"));
        }
        (scene.frame.time, scene.frame.frame) = (time, frame);
        Ok(())
    })
}
