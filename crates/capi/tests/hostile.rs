//! Null, text that is not UTF-8, and what there is none of.
#![allow(
    missing_docs,
    clippy::unwrap_used,
    clippy::undocumented_unsafe_blocks,
    reason = "a test fails by panicking"
)]

use std::ffi::{CStr, c_char};
use std::ptr::{null, null_mut};

use sdfc_capi::*;

const NOT_UTF8: &CStr = c"\xff\xfe";

fn compile(source: &[u8]) -> *mut Scene {
    unsafe { sdfc_compile(c"a.sdf".as_ptr(), source.as_ptr().cast(), source.len(), null_mut()) }
}

fn error() -> String {
    unsafe { CStr::from_ptr(sdfc_error()) }.to_str().unwrap().to_owned()
}

#[test]
fn null_is_refused_everywhere() {
    unsafe {
        assert!(sdfc_compile(null(), null(), 0, null_mut()).is_null());
        assert!(error().contains("null"));
        assert!(sdfc_compile(c"a".as_ptr(), null(), 3, null_mut()).is_null());
        sdfc_scene_free(null_mut());
        sdfc_shader_free(null_mut());
        sdfc_string_free(null_mut());
        assert_eq!(sdfc_set(null_mut(), c"r".as_ptr(), c"1".as_ptr()), Status::Null);
        assert_eq!(sdfc_set_number(null_mut(), c"r".as_ptr(), 1.0), Status::Null);
        assert_eq!(sdfc_set_time(null_mut(), 0.0, 0.0), Status::Null);
        assert_eq!(sdfc_distance(null(), null(), 0, null_mut()), Status::Null);
        assert_eq!(sdfc_gradient(null(), null(), 0, null_mut()), Status::Null);
        assert_eq!(sdfc_bounds(null(), null_mut(), null_mut()), Status::Null);
        assert!(sdfc_shader_write(null(), null(), null(), null(), 0, 0).is_null());
        assert!(sdfc_shader_code(null(), null_mut()).is_null());
        assert!(sdfc_shader_reflection(null()).is_null());
        let none = sdfc_shader_uniform(null(), null(), null_mut(), 0, null_mut());
        assert_eq!(none, Status::Null);

        let scene = compile(b"param r = 1 in 0..2\nsphere(r)");
        assert!(!scene.is_null(), "{}", error());
        assert_eq!(sdfc_set(scene, null(), c"1".as_ptr()), Status::Null);
        assert_eq!(sdfc_set(scene, c"r".as_ptr(), null()), Status::Null);
        assert_eq!(sdfc_distance(scene, null(), 1, null_mut()), Status::Null);
        assert_eq!(sdfc_distance(scene, null(), 0, null_mut()), Status::Ok);
        assert_eq!(sdfc_distance(scene, null(), usize::MAX, null_mut()), Status::Argument);
        assert_eq!(sdfc_bounds(scene, null_mut(), null_mut()), Status::Null);
        sdfc_scene_free(scene);
    }
}

#[test]
fn what_is_not_utf8_or_not_there_is_refused() {
    assert!(compile(b"\xff\xfe").is_null());
    assert!(error().contains("UTF-8"));
    unsafe {
        assert!(sdfc_compile(NOT_UTF8.as_ptr(), null(), 0, null_mut()).is_null());
        let scene = compile(b"param r = 1 in 0..2\nsphere(r)");
        assert_eq!(error(), "");
        assert_eq!(sdfc_set(scene, NOT_UTF8.as_ptr(), c"1".as_ptr()), Status::NotUtf8);
        assert_eq!(sdfc_set(scene, c"q".as_ptr(), c"1".as_ptr()), Status::Argument);
        assert_eq!(error(), "the scene has no param `q`; it has r");
        assert_eq!(sdfc_set_number(scene, c"r".as_ptr(), f64::NAN), Status::Argument);
        assert_eq!(sdfc_set_number(scene, c"r".as_ptr(), 3.0), Status::Argument);
        let write = |target: *const c_char, part: *const c_char, prefix: *const c_char| {
            let shader = sdfc_shader_write(scene, target, part, prefix, 0, 0);
            let made = !shader.is_null();
            sdfc_shader_free(shader);
            made
        };
        assert!(write(null(), null(), null()));
        assert!(write(c"spirv".as_ptr(), c"render".as_ptr(), c"".as_ptr()));
        assert!(write(c"shadertoy".as_ptr(), c"render".as_ptr(), null()));
        assert!(!write(c"cobol".as_ptr(), null(), null()));
        assert!(!write(null(), c"all".as_ptr(), null()));
        assert!(!write(null(), null(), c"2 words".as_ptr()));
        assert!(!write(NOT_UTF8.as_ptr(), null(), null()));
        sdfc_scene_free(scene);
    }
}

#[test]
fn errors_come_as_json_and_files_are_not_read() {
    let mut found = null_mut();
    let source = "import a from \"/etc/passwd\"\nspere(1)";
    let scene = unsafe {
        let source = (source.as_ptr().cast(), source.len());
        sdfc_compile(c"a.sdf".as_ptr(), source.0, source.1, &mut found)
    };
    assert!(scene.is_null());
    let rows = unsafe { CStr::from_ptr(found) }.to_str().unwrap();
    let rows: serde_json::Value = serde_json::from_str(rows).unwrap();
    assert_eq!(rows[0]["severity"], "error");
    assert!(rows.as_array().unwrap().iter().any(|row| row["code"] == "E0201" && row["line"] == 2));
    unsafe { sdfc_string_free(found) };
}

#[test]
fn a_shader_says_what_its_buffer_holds() {
    let scene = compile(b"param r = 1 in 0..2\nsphere(r)");
    unsafe {
        assert_eq!(sdfc_set_number(scene, c"r".as_ptr(), 0.5), Status::Ok);
        let shader = sdfc_shader_write(scene, null(), null(), c"ball_".as_ptr(), 1, 2);
        let mut length = 0;
        let code = sdfc_shader_code(shader, &mut length);
        let code = CStr::from_ptr(code).to_str().unwrap();
        assert_eq!(code.len(), length);
        assert!(code.contains("fn ball_distance(") && code.contains("@group(1) @binding(2)"));
        let reflection = CStr::from_ptr(sdfc_shader_reflection(shader)).to_str().unwrap();
        let reflection: serde_json::Value = serde_json::from_str(reflection).unwrap();
        assert_eq!(reflection["uniform"]["size"], 16);
        let mut bytes = [0; 16];
        let uniform = |bytes: *mut u8, room, length: &mut usize| {
            sdfc_shader_uniform(shader, scene, bytes, room, length)
        };
        assert_eq!(uniform(null_mut(), 0, &mut length), Status::Ok);
        assert_eq!(length, 16);
        assert_eq!(uniform(bytes.as_mut_ptr(), 15, &mut length), Status::Argument);
        assert_eq!(uniform(bytes.as_mut_ptr(), 16, &mut length), Status::Ok);
        assert_eq!(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]), 0.5);
        sdfc_shader_free(shader);
        sdfc_scene_free(scene);
    }
}
