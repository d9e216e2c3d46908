//! Meshes, contours, measurements and pictures from C are those of the library, options are
//! checked, and a progress callback stops the work.
#![allow(
    missing_docs,
    clippy::unwrap_used,
    clippy::undocumented_unsafe_blocks,
    reason = "a test fails by panicking"
)]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ops::ControlFlow;
use std::ptr::{null, null_mut};

use sdfc::{Backend, Compiler, MeshFormat, MeshOptions, MeshSize, PictureOptions};
use sdfc_capi::*;
use serde_json::Value;

const SOURCE: &str = "param r = 0.5 in 0.1..1\n(sphere(r) - sphere(0.5 * r)).color(#f00)";
/// The value that the scenes of all tests have.
const RADIUS: f64 = 0.4;

fn scene() -> *mut Scene {
    unsafe {
        let text = SOURCE.as_ptr().cast();
        let scene = sdfc_compile(c"a.sdf".as_ptr(), text, SOURCE.len(), null_mut());
        assert_eq!(sdfc_set_number(scene, c"r".as_ptr(), RADIUS), Status::Ok);
        scene
    }
}

fn error() -> String {
    unsafe { CStr::from_ptr(sdfc_error()) }.to_str().unwrap().to_owned()
}

fn json(text: *const c_char) -> Value {
    assert!(!text.is_null(), "{}", error());
    serde_json::from_str(unsafe { CStr::from_ptr(text) }.to_str().unwrap()).unwrap()
}

/// Returns the rows of an array, of `width` numbers each.
fn rows<T: Copy>(count: usize, width: usize, first: *const T) -> Vec<T> {
    assert!(!first.is_null(), "{}", error());
    unsafe { std::slice::from_raw_parts(first, count * width) }.to_vec()
}

fn file(bytes: *mut Bytes) -> Vec<u8> {
    let mut length = 0;
    let first = unsafe { sdfc_bytes_data(bytes, &mut length) };
    let found = rows(length, 1, first);
    unsafe { sdfc_bytes_free(bytes) };
    found
}

/// Counts the calls, and stops the work at the last one that the context allows.
unsafe extern "C" fn count_down(context: *mut c_void, done: u64, total: u64) -> c_int {
    assert!(done <= total);
    let left = unsafe { &mut *context.cast::<u32>() };
    *left = left.saturating_sub(1);
    c_int::from(*left == 0)
}

#[test]
fn a_mesh_is_that_of_the_library() {
    let scene = scene();
    unsafe {
        let mesh = sdfc_mesh_make(scene, c"{ \"error\": 0.01 }".as_ptr(), None, null_mut());
        let mut counts = [0; 4];
        let [vertices, normals] =
            [sdfc_mesh_vertices(mesh, &mut counts[0]), sdfc_mesh_normals(mesh, &mut counts[1])];
        let colors = rows(counts[0], 3, sdfc_mesh_colors(mesh, &mut counts[2]));
        let triangles = sdfc_mesh_triangles(mesh, &mut counts[3]);

        let library = Compiler::new().compile("a.sdf", SOURCE).unwrap();
        let mut frame = library.defaults();
        library.set(&mut frame, "r", RADIUS).unwrap();
        let options = MeshOptions::new().error(MeshSize::Length(0.01)).frame(frame);
        let same = library.mesh(&options, &mut |_| ControlFlow::Continue(())).unwrap();
        assert_eq!(
            counts,
            [same.vertices.len(), same.normals.len(), same.colors.len(), same.triangles.len()]
        );
        assert!(counts[3] > 100);
        assert_eq!(rows(counts[0], 3, vertices), same.vertices.as_flattened());
        assert_eq!(rows(counts[1], 3, normals), same.normals.as_flattened());
        assert_eq!(colors, same.colors.as_flattened());
        assert_eq!(rows(counts[3], 3, triangles), same.triangles.as_flattened());

        let described = json(sdfc_mesh_describe(mesh));
        assert_eq!(described["certificate"]["is_proven"], true);
        assert_eq!(described["open_edges"], 0);
        assert_eq!(described["volume"], same.volume());
        let written = file(sdfc_mesh_write(mesh, c"ply".as_ptr()));
        assert_eq!(written, MeshFormat::Ply.encode(&same).unwrap());
        assert!(sdfc_mesh_write(mesh, c"docx".as_ptr()).is_null());
        assert!(error().contains(".stl, .obj, .ply, .glb or .3mf"), "{}", error());
        sdfc_mesh_free(mesh);
        sdfc_scene_free(scene);
    }
}

#[test]
fn descriptions_list_solids_that_have_no_limit() {
    let source = "sphere(1)\nplane(y: -2)\n";
    unsafe {
        let text = source.as_ptr().cast();
        let scene = sdfc_compile(c"a.sdf".as_ptr(), text, source.len(), null_mut());
        let options = c"{ \"error_relative\": 0.1 }".as_ptr();
        let mesh = sdfc_mesh_make(scene, options, None, null_mut());
        let contour = sdfc_contour_make(scene, options, None, null_mut());
        let floor = serde_json::json!(["`plane(y: -2)` (line 2)"]);
        assert_eq!(json(sdfc_mesh_describe(mesh))["left_out"], floor);
        assert_eq!(json(sdfc_contour_describe(contour))["left_out"], floor);
        sdfc_contour_free(contour);
        sdfc_mesh_free(mesh);
        sdfc_scene_free(scene);
    }
}

#[test]
fn a_contour_and_measurements_are_those_of_the_library() {
    let scene = scene();
    unsafe {
        let options = c"{ \"offset\": 0.05, \"error\": 0.001 }".as_ptr();
        let contour = sdfc_contour_make(scene, options, None, null_mut());
        let described = json(sdfc_contour_describe(contour));
        assert_eq!(described["paths"].as_array().unwrap().len(), 2);
        assert_eq!(described["origin"], serde_json::json!([0.0, 0.0, 0.05]));
        let area = described["area"].as_f64().unwrap();
        let exact = std::f64::consts::PI * (RADIUS * RADIUS - (RADIUS / 2.0).powi(2));
        assert!((area - exact).abs() < 0.01, "{area} {exact}");
        let written =
            String::from_utf8(file(sdfc_contour_write(contour, c"svg".as_ptr()))).unwrap();
        assert!(written.contains("<svg"));
        sdfc_contour_free(contour);
        let far = c"{ \"normal\": [1, 0, 0], \"offset\": 3 }".as_ptr();
        assert!(sdfc_contour_make(scene, far, None, null_mut()).is_null());
        assert_eq!(sdfc_error_status(), Status::Argument);
        assert!(error().contains("meets no inside"), "{}", error());
        let flat = c"{ \"normal\": [0, 0, 0] }".as_ptr();
        assert!(sdfc_contour_make(scene, flat, None, null_mut()).is_null());
        assert!(error().contains("no plane has the normal [0.0, 0.0, 0.0]"), "{}", error());

        let options = c"{ \"error_relative\": 0.01 }".as_ptr();
        let text = sdfc_measure(scene, options, None, null_mut());
        let volume = json(text)["volume"].clone();
        sdfc_string_free(text);
        let exact = 4.0 / 3.0 * std::f64::consts::PI * (RADIUS.powi(3) - (RADIUS / 2.0).powi(3));
        let [low, high] = [0, 1].map(|end| volume[end].as_f64().unwrap());
        assert!(low <= exact && exact <= high && high < 1.02 * low, "{low} {exact} {high}");
        sdfc_scene_free(scene);
    }
}

#[test]
fn a_picture_is_that_of_the_library() {
    let scene = scene();
    unsafe {
        let options = c"{ \"size\": [32, 20], \"backend\": \"cpu\" }".as_ptr();
        let picture = sdfc_render(scene, options, None, null_mut());
        let [mut width, mut height] = [0; 2];
        assert_eq!(sdfc_picture_size(picture, &mut width, &mut height), Status::Ok);
        assert_eq!([width, height], [32, 20]);

        let library = Compiler::new().compile("a.sdf", SOURCE).unwrap();
        let mut frame = library.defaults();
        library.set(&mut frame, "r", RADIUS).unwrap();
        let options = PictureOptions::new().size([32, 20]).backend(Backend::Cpu).frame(frame);
        let same = library.render(&options, &mut sdfc::no_progress).unwrap().image;
        let rgba = rows(32 * 20, 4, sdfc_picture_rgba(picture));
        let rgb: Vec<u8> =
            rgba.as_chunks::<4>().0.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
        assert_eq!(rgb, same.to_srgb8());
        assert!(rgba.iter().skip(3).step_by(4).all(|alpha| *alpha == 255));
        let depths = rows(32 * 20, 1, sdfc_picture_depths(picture));
        assert_eq!(
            depths.iter().filter(|depth| depth.is_finite()).count() as u64,
            same.counts().hit
        );
        assert_eq!(file(sdfc_picture_png(picture)), same.to_png().unwrap());
        let described = json(sdfc_picture_describe(picture));
        assert_eq!(described["unproven"], Value::Null);
        assert_eq!(described["stats"]["pixels"]["hit"], same.counts().hit);
        sdfc_picture_free(picture);

        // A camera that looks away sees nothing.
        let options = c"{ \"size\": [8, 8], \"backend\": \"cpu\",
            \"camera\": { \"eye\": [0, 0, 3], \"target\": [0, 0, 5] } }";
        let picture = sdfc_render(scene, options.as_ptr(), None, null_mut());
        assert_eq!(json(sdfc_picture_describe(picture))["stats"]["pixels"]["hit"], 0);
        sdfc_picture_free(picture);
        sdfc_scene_free(scene);
    }
}

#[test]
fn unknown_options_and_values_are_errors() {
    let scene = scene();
    let render = |options: &str| {
        let options = CString::new(options).unwrap();
        let picture = unsafe { sdfc_render(scene, options.as_ptr(), None, null_mut()) };
        assert!(picture.is_null());
        assert_eq!(sdfc_error_status(), Status::Argument);
        error()
    };
    assert!(render("{").contains("options: "));
    assert!(render("{ \"sise\": [3, 4] }").contains("unknown field `sise`"));
    assert!(
        render("{ \"backend\": \"abacus\" }")
            .contains("unknown backend `abacus`; the backends are auto, gpu, cpu")
    );
    assert!(render("{ \"backend\": \"cpu\", \"size\": [0, 4] }").contains("0x4"));
    assert!(render("{ \"method\": \"magic\" }").contains("magic"));
    assert!(render("{ \"camera\": { \"eye\": [0, 0, 3], \"fov\": 4 } }").contains("fov"));
    assert!(render("{ \"camera\": { \"eye\": [0, 0, 0] } }").contains("one point"));
    assert!(render("{ \"backend\": \"cpu\", \"samples\": 0 }").contains("1 to 1024"));
    let outside = "{ \"backend\": \"cpu\", \"region\": [0, 0, 999, 1] }";
    assert!(render(outside).contains("not within the picture"));
    let both = "{ \"camera\": { \"eye\": [0, 0, 3], \"fov\": 1, \"height\": 1 } }";
    assert!(render(both).contains("one of them"));
    unsafe {
        let both = c"{ \"error\": 1, \"error_relative\": 1 }".as_ptr();
        assert!(sdfc_mesh_make(scene, both, None, null_mut()).is_null());
        assert!(error().contains("one of them"), "{}", error());
        assert!(sdfc_mesh_make(scene, c"{ \"error\": -1 }".as_ptr(), None, null_mut()).is_null());
        assert_eq!(sdfc_error_status(), Status::Argument);
        sdfc_scene_free(scene);
    }
}

#[test]
fn a_progress_callback_stops_the_work() {
    let scene = scene();
    let mut left = 2;
    let context = (&raw mut left).cast();
    unsafe {
        assert!(sdfc_mesh_make(scene, null(), Some(count_down), context).is_null());
        assert_eq!((sdfc_error_status(), left), (Status::Stopped, 0));
        left = 1;
        let options = c"{ \"size\": [300, 200], \"backend\": \"cpu\" }".as_ptr();
        let context = (&raw mut left).cast();
        assert!(sdfc_render(scene, options, Some(count_down), context).is_null());
        assert_eq!((sdfc_error_status(), left), (Status::Stopped, 0));
        sdfc_scene_free(scene);
    }
}

#[test]
fn values_of_fixed_params_are_part_of_the_compilation() {
    let source = "param n: int = 2 in 1..9\nunion([for i in 0..n: sphere(1).translate(x: 4 * i)])";
    let compile = |values: &str| unsafe {
        let values = CString::new(values).unwrap();
        let (name, text) = (c"a.sdf".as_ptr(), source.as_ptr().cast());
        let (values, none) = (values.as_ptr(), null_mut());
        sdfc_compile_with_values(name, text, source.len(), values, None, none, null_mut())
    };
    let scene = compile("{ \"n\": \"3\" }");
    let (point, mut distance) = ([8.0, 0.0, 0.0], 0.0);
    unsafe {
        assert_eq!(sdfc_distance(scene, point.as_ptr(), 1, &mut distance), Status::Ok);
        assert_eq!(distance, -1.0);
        let described = sdfc_scene_describe(scene);
        let param = &json(described)["params"][0];
        assert_eq!(param["value"], serde_json::json!([3.0]));
        assert_eq!((&param["type"], &param["fixed"]), (&"int".into(), &true.into()));
        sdfc_string_free(described);
        sdfc_scene_free(scene);
    }
    assert!(compile("{ \"n\": \"10\" }").is_null());
    assert_eq!(sdfc_error_status(), Status::Argument);
    assert_eq!(error(), "the param `n` takes 1..9; 10 is outside");
}

#[test]
fn a_copy_has_values_of_its_own() {
    let scene = scene();
    let distance = |scene: *const Scene| {
        let (point, mut distance) = ([2.0, 0.0, 0.0], 0.0);
        assert_eq!(unsafe { sdfc_distance(scene, point.as_ptr(), 1, &mut distance) }, Status::Ok);
        distance
    };
    unsafe {
        let copy = sdfc_scene_copy(scene);
        assert_eq!(sdfc_set_number(copy, c"r".as_ptr(), 1.0), Status::Ok);
        assert_eq!([distance(scene), distance(copy)], [2.0 - RADIUS, 1.0]);
        sdfc_scene_free(scene);
        assert_eq!(distance(copy), 1.0);
        sdfc_scene_free(copy);
    }
}
