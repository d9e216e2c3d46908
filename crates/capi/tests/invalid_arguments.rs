//! Null pointers, text that is not UTF-8, and unknown names are errors.
#![allow(
    missing_docs,
    clippy::unwrap_used,
    clippy::undocumented_unsafe_blocks,
    reason = "a test fails by panicking"
)]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
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
fn null_pointers_are_errors_everywhere() {
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
        let (name, none) = (c"a".as_ptr(), null_mut());
        assert!(
            sdfc_compile_with_values(name, null(), 3, null(), None, none, null_mut()).is_null()
        );
        assert!(sdfc_scene_copy(null()).is_null());
        assert!(sdfc_scene_describe(null()).is_null());
        assert!(sdfc_mesh_make(null(), null(), None, none).is_null());
        assert!(sdfc_mesh_vertices(null(), null_mut()).is_null());
        assert!(sdfc_mesh_describe(null()).is_null());
        assert!(sdfc_mesh_write(null(), c"stl".as_ptr()).is_null());
        assert!(sdfc_measure(null(), null(), None, none).is_null());
        assert!(sdfc_contour_make(null(), null(), None, none).is_null());
        assert!(sdfc_contour_describe(null()).is_null());
        assert!(sdfc_contour_write(null(), c"svg".as_ptr()).is_null());
        assert!(sdfc_render(null(), null(), None, none).is_null());
        assert!(sdfc_picture_rgba(null()).is_null());
        assert!(sdfc_picture_depths(null()).is_null());
        assert!(sdfc_picture_describe(null()).is_null());
        assert!(sdfc_picture_png(null()).is_null());
        assert_eq!(sdfc_picture_size(null(), null_mut(), null_mut()), Status::Null);
        assert_eq!(sdfc_error_status(), Status::Null);
        assert!(sdfc_bytes_data(null(), null_mut()).is_null());
        sdfc_bytes_free(null_mut());
        sdfc_mesh_free(null_mut());
        sdfc_contour_free(null_mut());
        sdfc_picture_free(null_mut());
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
fn invalid_utf8_and_unknown_names_are_errors() {
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
fn diagnostics_are_json_and_imports_are_errors() {
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

/// A context for the callback: the files by the last part of their path, and the requested paths.
#[derive(Default)]
struct Files {
    asked: Vec<String>,
    held: Vec<(&'static str, &'static [u8])>,
}

unsafe extern "C" fn read(context: *mut c_void, path: *const c_char, file: *mut File) -> c_int {
    let (files, path) = unsafe { (&mut *context.cast::<Files>(), CStr::from_ptr(path)) };
    files.asked.push(path.to_str().unwrap().to_owned());
    let Some((_, bytes)) = files.held.iter().find(|(name, _)| path.to_str() == Ok(name)) else {
        return 1;
    };
    // The contents may come in several parts.
    let (one, other) = bytes.split_at(bytes.len() / 2);
    for part in [one, other] {
        unsafe {
            assert_eq!(sdfc_file_give(file, part.as_ptr().cast(), part.len()), Status::Ok);
            assert_eq!(sdfc_file_give(null_mut(), part.as_ptr().cast(), 1), Status::Null);
            assert_eq!(sdfc_file_give(file, null(), 1), Status::Null);
        }
    }
    0
}

/// Returns the distance at the origin, or the diagnostics.
fn distance_with(source: &str, files: &mut Files) -> Result<f64, String> {
    let (text, length) = (source.as_ptr().cast(), source.len());
    let context = std::ptr::from_mut(files).cast();
    unsafe {
        let name = c"scenes/a.sdf".as_ptr();
        let scene = sdfc_compile_with_files(name, text, length, Some(read), context, null_mut());
        if scene.is_null() {
            return Err(error());
        }
        let (point, mut distance) = ([0.0; 3], 0.0);
        assert_eq!(sdfc_distance(scene, point.as_ptr(), 1, &mut distance), Status::Ok);
        sdfc_scene_free(scene);
        Ok(distance)
    }
}

#[test]
fn a_scene_imports_only_what_the_callback_provides() {
    let held: Vec<(_, &[u8])> =
        vec![("parts/ball.sdf", b"solid ball() = length(p) - 0.25"), ("bad.sdf", b"\xff\xfe")];
    let mut files = Files { held, ..Files::default() };
    let given = distance_with("import ball from \"parts/ball.sdf\"\nball()", &mut files);
    assert_eq!(given, Ok(-0.25));
    let refused = |source: &str, files: &mut Files| distance_with(source, files).unwrap_err();
    let error = refused("import ball from \"none.sdf\"\nball()", &mut files);
    assert!(error.contains("the program has no such file") && error.contains("a.sdf:1"), "{error}");
    assert!(refused("import a from \"bad.sdf\"\na()", &mut files).contains("not UTF-8"));
    for path in ["/etc/passwd", "../ball.sdf", "parts/../../ball.sdf", "C:\\\\ball.sdf"] {
        refused(&format!("import ball from \"{path}\"\nball()"), &mut files);
    }
    assert_eq!(files.asked, ["parts/ball.sdf", "none.sdf", "bad.sdf"]);

    // Without a callback there are no files.
    let source = c"import ball from \"parts/ball.sdf\"\nball()";
    let (text, length) = (source.as_ptr(), source.to_bytes().len());
    let name = CString::new("a.sdf").unwrap();
    unsafe {
        let none = null_mut();
        assert!(
            sdfc_compile_with_files(name.as_ptr(), text, length, None, none, null_mut()).is_null()
        );
    }
    assert!(crate::error().contains("without access to files"), "{}", crate::error());
}

#[test]
fn uniform_bytes_match_the_reflection() {
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

#[test]
fn a_wrong_clause_is_an_error() {
    assert!(compile(b"solid egg() exact = length(p*[1,0.7,1])-1\negg()").is_null());
    assert!(error().contains("E0502"), "{}", error());
}

#[test]
fn diagnostics_are_null_if_nothing_was_compiled() {
    let (source, length) = (c"sphere(1)".as_ptr(), 9);
    let sources = [
        (null(), source, null()),
        (NOT_UTF8.as_ptr(), source, null()),
        (c"a".as_ptr(), NOT_UTF8.as_ptr(), null()),
        (c"a".as_ptr(), source, c"[1]".as_ptr()),
    ];
    for (name, source, values) in sources {
        let length = if source == NOT_UTF8.as_ptr() { 2 } else { length };
        let mut found = std::ptr::dangling_mut::<c_char>();
        let none = null_mut();
        let scene = unsafe {
            sdfc_compile_with_values(name, source, length, values, None, none, &mut found)
        };
        assert!(scene.is_null() && found.is_null(), "{}", error());
    }
}

#[test]
fn times_are_finite_and_frames_are_integers() {
    let scene = compile(b"sphere(1).translate(x: time)");
    for (time, frame) in [(f64::NAN, 0.0), (f64::INFINITY, 0.0), (0.0, f64::NAN), (0.0, 0.5)] {
        assert_eq!(unsafe { sdfc_set_time(scene, time, frame) }, Status::Argument);
        assert_eq!(error(), "`time` must be finite, and `frame` an integer");
    }
    assert_eq!(unsafe { sdfc_set_time(scene, -1.5, -3.0) }, Status::Ok);
    unsafe { sdfc_scene_free(scene) };
}

#[test]
fn groups_and_bindings_have_a_limit() {
    let scene = compile(b"sphere(1)");
    let write = |group, binding| unsafe {
        let shader = sdfc_shader_write(scene, null(), null(), null(), group, binding);
        sdfc_shader_free(shader);
        !shader.is_null()
    };
    assert!(write(65_535, 65_535));
    for (group, binding) in [(65_536, 0), (0, 65_536), (0, u32::MAX)] {
        assert!(!write(group, binding));
        assert_eq!(sdfc_error_status(), Status::Argument);
        assert!(error().contains("65535"), "{}", error());
    }
    unsafe { sdfc_scene_free(scene) };
}

#[test]
fn a_camera_says_what_it_expects() {
    let scene = compile(b"sphere(1)");
    let render = |camera: &str| {
        let options = format!("{{\"size\": [4, 4], \"backend\": \"cpu\", \"camera\": {camera}}}");
        let options = CString::new(options).unwrap();
        unsafe {
            let picture = sdfc_render(scene, options.as_ptr(), None, null_mut());
            sdfc_picture_free(picture);
            if picture.is_null() { Err((sdfc_error_status(), error())) } else { Ok(()) }
        }
    };
    let refused = [
        (r#"{"eye": [0, 0, 5], "fov": 7}"#, "radians"),
        (r#"{"eye": [0, 0, 5], "fov": 40}"#, "radians"),
        (r#"{"eye": [0, 0, 5], "fov": 0}"#, "radians"),
        (r#"{"eye": [0, 0, 5], "height": 0}"#, "height is 0; it must be above 0"),
        (r#"{"eye": [0, 0, 1e-320]}"#, "one point"),
    ];
    for (camera, said) in refused {
        let (status, message) = render(camera).unwrap_err();
        assert!(status == Status::Argument && message.contains(said), "{camera}: {message}");
    }
    for camera in [
        r#"{"eye": [0, 0, 5]}"#,
        r#"{"eye": [0, 0, 5], "fov": 3.141592}"#,
        r#"{"eye": [0, 0, 5], "height": 3e6}"#,
    ] {
        assert_eq!(render(camera), Ok(()), "{camera}");
    }
    unsafe { sdfc_scene_free(scene) };
}

#[test]
fn results_may_lie_where_the_points_were() {
    let scene = compile(b"sphere(1)");
    // Room for a gradient and a distance for each of the two points.
    let mut memory = [3.0, 0.0, 0.0, 0.0, 2.0, 0.0, 9.0, 9.0];
    let first = memory.as_mut_ptr();
    unsafe {
        assert_eq!(sdfc_gradient(scene, first, 2, first), Status::Ok);
        assert_eq!(memory, [1.0, 0.0, 0.0, 2.0, 0.0, 1.0, 0.0, 1.0]);
        let mut memory = [3.0, 0.0, 0.0, 0.0, 2.0, 0.0];
        let first = memory.as_mut_ptr();
        assert_eq!(sdfc_distance(scene, first, 2, first), Status::Ok);
        assert_eq!(memory[..2], [2.0, 1.0]);
        let corner = memory.as_mut_ptr();
        assert_eq!(sdfc_bounds(scene, corner, corner), Status::Ok);
        assert_eq!(memory[..3], [1.0; 3]);
        sdfc_scene_free(scene);
    }
}
